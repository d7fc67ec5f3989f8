// SPDX-License-Identifier: MIT
// A tent of three texels each way, (1 2 1) / 4, by four bilinear taps: ghosts have no edges of texels.

vec4 shade(Pixel pixel) {
    vec2 reach = 0.5 / vec2(size(lens_flare_light));
    return 0.25 * (sample_linear(lens_flare_light, pixel.uv - reach) +
                   sample_linear(lens_flare_light, pixel.uv + vec2(reach.x, -reach.y)) +
                   sample_linear(lens_flare_light, pixel.uv + vec2(-reach.x, reach.y)) +
                   sample_linear(lens_flare_light, pixel.uv + reach));
}
