// SPDX-License-Identifier: MIT
// The light above the threshold custom[0].x, in the small picture: the mean of bilinear taps, two pixels apart.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    float threshold = custom[0].x;
    // Whole numbers in floats: they are exact up to 2^24.
    vec2 taps = max(floor(vec2(size(bright_source)) / vec2(2 * pixel.size)), 1.0), apart = 1.0 / (taps * vec2(pixel.size));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < int(taps.y); ++j)
        for (int i = 0; i < int(taps.x); ++i) {
            vec2 place = vec2(pixel.texel) * taps + vec2(i, j) + 0.5;
            vec3 light = sanitize_light(sample_linear(bright_source, place * apart).rgb);
            float brightness = max(light.r, max(light.g, light.b));
            sum += light * (max(brightness - threshold, 0.0) / max(brightness, 1e-6));
        }
    return vec4(sum / (taps.x * taps.y), 1.0);
}
