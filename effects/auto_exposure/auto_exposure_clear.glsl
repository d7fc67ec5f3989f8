// SPDX-License-Identifier: MIT

void run() { auto_exposure_counts[gl_GlobalInvocationID.x] = 0u; }
