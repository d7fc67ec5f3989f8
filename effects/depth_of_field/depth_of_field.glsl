// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. Lays what is blurred over the sharp picture, and the near field over both. A pixel that is
// sharp, and that nothing covers, keeps its bits.
#include "shared/sanitize.glsl"
#include "depth_of_field_blur.glsl"

// In pixels, negative before what is sharp: as in depth_of_field_circle.glsl.
float depth_of_field_radius(ivec2 texel) {
    vec4 distances = depth_of_field_custom(0), radii = depth_of_field_custom(1);
    float depth = load_clamped(depth_of_field_depth, texel).r;
    float inverse = (depth * distances.z + distances.w) / (depth * distances.x + distances.y);
    inverse = depth != radii.w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    return clamp(radii.x - radii.y * inverse, -radii.z, radii.z) * depth_of_field_custom(2).x;
}

// Colour and weight of a pixel that lies `away`: as far as its circle, in pixels, covers this one. What lies farther away
// counts with this pixel's own, as in the gathering; what is near lies over it later.
vec4 depth_of_field_tap(ivec2 texel, ivec2 away, float radius, float narrower, bool cleans) {
    vec4 distances = depth_of_field_custom(0), radii = depth_of_field_custom(1) * depth_of_field_custom(2).x;
    vec2 circle = radii.x * distances.xy - radii.y * distances.zw;
    vec4 color = load_clamped(depth_of_field_picture, texel + away);
    float depth = load_clamped(depth_of_field_depth, texel + away).r;
    float around = min((depth * circle.x + circle.y) / (depth * distances.x + distances.y), radius);
    float distance = sqrt(float(away.x * away.x) * (narrower * narrower) + float(away.y * away.y));
    return vec4(cleans ? sanitize(color).rgb : color.rgb, 1.0) * clamp(around - (distance - 0.5), 0.0, 1.0);
}

// A circle of a few pixels: the mean of 3 x 3 or 5 x 5, which have its variance.
vec3 depth_of_field_small(ivec2 texel, float radius, float narrower) {
    radius = radius < 1.5 ? 0.5 + (radius - 0.5) * (radius - 0.5) : radius;
    vec4 sum = vec4(0.0);
    [[unroll]] for (int i = 0; i < 9; ++i)
        sum += depth_of_field_tap(texel, ivec2(i % 3, i / 3) - 1, radius, narrower, false);
    [[dont_flatten]] if (radius > 1.5)
        [[unroll]] for (int i = 0; i < 25; ++i)
            if (i % 5 % 4 == 0 || i / 5 % 4 == 0)
                sum += depth_of_field_tap(texel, ivec2(i % 5, i / 5) - 2, radius, narrower, false);
    [[dont_flatten]] if (!is_finite(sum.rgb)) {
        sum = vec4(0.0);
        [[dont_unroll]] for (int i = 0; i < 25; ++i)
            sum += depth_of_field_tap(texel, ivec2(i % 5, i / 5) - 2, radius, narrower, true);
    }
    return sum.rgb / sum.a;
}

vec4 depth_of_field(vec4 color, Pixel pixel, DepthOfField parameters) {
    vec4 blur = depth_of_field_custom(2);
    vec2 place = (vec2(pixel.texel) + 0.5) / blur.x;
    vec4 near = sample_linear(depth_of_field_near, place / vec2(size(depth_of_field_near)));
    vec4 behind = sample_linear(depth_of_field_behind, place / vec2(size(depth_of_field_behind)));
    float radius = depth_of_field_radius(pixel.texel), left = depth_of_field_left(-radius / blur.x, blur.y, blur.x);
    float blurred = radius < 0.0 ? depth_of_field_weight(left, blur.zw) : depth_of_field_large(radius);
    if (behind.a == 0.0) blurred = 0.0;
    bool is_small = radius > 0.5 && blurred < 1.0;
    if (blurred == 0.0 && near.a == 0.0 && !is_small) return color;
    vec3 seen = is_small ? depth_of_field_small(pixel.texel, radius, parameters.anamorphic_ratio) : sanitize(color).rgb;
    seen = seen * (1.0 - blurred) + behind.rgb * (blurred / max(behind.a, 1e-6));
    return vec4(seen * (1.0 - near.a) + near.rgb, color.a);
}
