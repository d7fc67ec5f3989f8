// SPDX-License-Identifier: MIT
// x^k for x from 0 to 1 and k above 0.

float vignette_power(float x, float k) {
    return pow(x, k);
}
