// SPDX-License-Identifier: MIT
// The light above the threshold custom[0].x, in the small picture: the mean of what lies under a texel.
#include "shared/area.glsl"
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    float threshold = custom[0].x;
    vec2 extent = vec2(size(bright_source)), ratio = extent / vec2(pixel.size);
    vec2 begin = vec2(pixel.texel) * ratio, end = begin + ratio;
    ivec2 taps = ivec2(area_taps(begin.x, end.x), area_taps(begin.y, end.y));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < taps.y; ++j) {
        AreaTap y = area_tap(begin.y, end.y, j);
        for (int i = 0; i < taps.x; ++i) {
            AreaTap x = area_tap(begin.x, end.x, i);
            vec3 light = sanitize_light(sample_linear(bright_source, vec2(x.place, y.place) / extent).rgb);
            float brightness = max(light.r, max(light.g, light.b));
            sum += light * (max(brightness - threshold, 0.0) / max(brightness, 1e-6) * (x.weight * y.weight));
        }
    }
    return vec4(sum / (ratio.x * ratio.y), 1.0);
}
