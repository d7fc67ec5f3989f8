// SPDX-License-Identifier: MIT

vec4 shade(Pixel pixel) {
    return sample_linear(arena_bloom_small, pixel.uv);
}
