// SPDX-License-Identifier: MIT
// About a quarter of each side: the mean of what lies under a texel.
#include "shared/area.glsl"

vec4 shade(Pixel pixel) {
    vec2 extent = vec2(size(quarter_source)), ratio = extent / vec2(pixel.size);
    vec2 begin = vec2(pixel.texel) * ratio, end = begin + ratio;
    ivec2 taps = ivec2(area_taps(begin.x, end.x), area_taps(begin.y, end.y));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < taps.y; ++j) {
        AreaTap y = area_tap(begin.y, end.y, j);
        for (int i = 0; i < taps.x; ++i) {
            AreaTap x = area_tap(begin.x, end.x, i);
            sum += sample_linear(quarter_source, vec2(x.place, y.place) / extent).rgb * (x.weight * y.weight);
        }
    }
    return vec4(sum / (ratio.x * ratio.y), 1.0);
}
