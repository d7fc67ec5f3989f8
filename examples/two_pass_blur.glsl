// SPDX-License-Identifier: MIT
// @effect two_pass_blur: Blurs along the rows, then along the columns.
// @accepts scene_linear display_linear
// @param float radius = 6 in [0.5, 32] px: Standard deviation of the Gaussian.
// @image rows: 1 rgba16f
// @image columns: 1 rgba16f
// @result columns

#include "shared/sanitize.glsl"

// Beyond three standard deviations lies 0.3 % of a Gaussian.
int two_pass_blur_reach(float radius) { return int(ceil(3.0 * radius)); }

float two_pass_blur_weight(int distance, float radius) {
    float x = float(distance) / radius;
    return exp(-0.5 * x * x);
}

// @pass across: picture -> rows
vec4 two_pass_blur_across(Pixel pixel, TwoPassBlur parameters) {
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    int reach = two_pass_blur_reach(parameters.radius);
    for (int i = -reach; i <= reach; ++i) {
        float weight = two_pass_blur_weight(i, parameters.radius);
        sum += weight * sanitize(load_clamped(picture, pixel.texel + ivec2(i, 0)));
        weights += weight;
    }
    return sum / weights;
}

// @pass down: rows -> columns
vec4 two_pass_blur_down(Pixel pixel, TwoPassBlur parameters) {
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    int reach = two_pass_blur_reach(parameters.radius);
    for (int i = -reach; i <= reach; ++i) {
        float weight = two_pass_blur_weight(i, parameters.radius);
        sum += weight * load_clamped(rows, pixel.texel + ivec2(0, i));
        weights += weight;
    }
    return sum / weights;
}
