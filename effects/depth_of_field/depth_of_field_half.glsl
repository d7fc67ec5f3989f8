// SPDX-License-Identifier: MIT
// Half size: colour and circle of a surface under every two by two pixels. Of their circles it is the second smallest;
// where that is of the near field, in every other texel of a chessboard the third, so that edges neither grow nor shrink.
#include "shared/sanitize.glsl"
#include "depth_of_field_circle.glsl"

vec4 shade(Pixel pixel) {
    ivec2 a = pixel.texel * 2, d = min(a + 1, size(depth_of_field_picture) - 1);
    ivec2 b = ivec2(d.x, a.y), c = ivec2(a.x, d.y);
    vec4 circles = vec4(depth_of_field_circle(load(depth_of_field_depth, a).r),
                        depth_of_field_circle(load(depth_of_field_depth, b).r),
                        depth_of_field_circle(load(depth_of_field_depth, c).r),
                        depth_of_field_circle(load(depth_of_field_depth, d).r));
    float low = max(min(circles.x, circles.y), min(circles.z, circles.w));
    float high = min(max(circles.x, circles.y), max(circles.z, circles.w));
    float own = min(low, high);
    if (own < 0.0 && ((pixel.texel.x + pixel.texel.y) & 1) == 1) own = max(low, high);
    // Of one surface are circles that differ by less than about a pixel, or a quarter.
    vec4 weight = clamp(1.5 + 0.25 * abs(own * custom[2].x) - abs(circles - own) * custom[2].x, 0.0, 1.0);
    vec4 sum = load(depth_of_field_picture, a) * weight.x + load(depth_of_field_picture, b) * weight.y;
    sum += load(depth_of_field_picture, c) * weight.z + load(depth_of_field_picture, d) * weight.w;
    return vec4(sanitize(sum / dot(weight, vec4(1.0))).rgb, depth_of_field_to_blur(own));
}
