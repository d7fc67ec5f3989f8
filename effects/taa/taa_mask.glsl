// SPDX-License-Identifier: MIT
// How little the past tells of a pixel of the frame, and of those around it: what the host says, and how much what is shown
// changed as transparent things were drawn, which have neither depth nor motion. custom[0].x: for so much of a change; 0 where
// nobody knows the colour before.
#include "taa_tone.glsl"

float taa_mask_at(ivec2 texel, float unit) {
    vec3 behind = taa_toned(sanitize_light(load(taa_transparency, texel).rgb), unit);
    vec3 change = abs(taa_toned(sanitize_light(load(taa_color, texel).rgb), unit) - behind);
    float seen = custom[0].x * max(change.r, max(change.g, change.b));
    return clamp(max(seen, load(taa_reactive, texel).r), 0.0, 1.0);
}

vec4 shade(Pixel pixel) {
    float unit = exp2(taa_stops_of(load(taa_exposure, ivec2(0)).r));
    ivec2 limit = size(taa_color) - 1;
    float own = 0.0, around = 0.0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            float here = taa_mask_at(clamp(pixel.texel + ivec2(i, j), ivec2(0), limit), unit);
            if (i == 0 && j == 0) own = here;
            around = max(around, here);
        }
    return vec4(own, around, 0.0, 1.0);
}
