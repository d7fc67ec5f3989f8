// SPDX-License-Identifier: MIT
// Where rings lie farther apart than texels, what falls between them: the mean of the texels around.
#include "depth_of_field_rings.glsl"

void shade(Pixel pixel, out vec4 result[2]) {
    DepthOfFieldRings rings = depth_of_field_rings(pixel);
    float side = 0.5 * clamp(rings.spacing - 1.0, 0.0, 1.0);
    result[0] = load(depth_of_field_behind, pixel.texel);
    result[1] = load(depth_of_field_near, pixel.texel);
    if (side == 0.0) return;
    result[0] = result[1] = vec4(0.0);
    float whole = 1.0 / ((1.0 + 2.0 * side) * (1.0 + 2.0 * side));
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float weight = whole * (x == 0 ? 1.0 : side) * (y == 0 ? 1.0 : side);
            result[0] += load_clamped(depth_of_field_behind, pixel.texel + ivec2(x, y)) * weight;
            result[1] += load_clamped(depth_of_field_near, pixel.texel + ivec2(x, y)) * weight;
        }
}
