// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. Lays what is blurred over the sharp picture, and the near field over both. A pixel that is
// sharp, and that nothing covers, keeps its bits.
#include "shared/sanitize.glsl"
#include "depth_of_field_blur.glsl"

vec4 depth_of_field(vec4 color, Pixel pixel, DepthOfField parameters) {
    vec4 distances = depth_of_field_custom(0), radii = depth_of_field_custom(1), blur = depth_of_field_custom(2);
    vec2 place = (vec2(pixel.texel) + 0.5) / blur.x;
    vec4 near = sample_linear(depth_of_field_near, place / vec2(size(depth_of_field_near)));
    vec4 behind = sample_linear(depth_of_field_behind, place / vec2(size(depth_of_field_behind)));
    // As in depth_of_field_circle.glsl.
    float depth = load(depth_of_field_depth, pixel.texel).r;
    float inverse = (depth * distances.z + distances.w) / (depth * distances.x + distances.y);
    inverse = depth != radii.w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    float left = depth_of_field_left(min(abs(radii.x - radii.y * inverse), radii.z), blur.y, blur.x);
    float blurred = behind.a > 0.0 ? depth_of_field_weight(left, blur.zw) : 0.0;
    if (blurred == 0.0 && near.a == 0.0) return color;
    vec3 seen = sanitize(color).rgb * (1.0 - blurred) + behind.rgb * (blurred / max(behind.a, 1e-6));
    return vec4(seen * (1.0 - near.a) + near.rgb, color.a);
}
