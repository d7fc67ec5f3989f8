// SPDX-License-Identifier: MIT
// A picture of half the size, floored: the tent over four texels each way, centred on the output's own. Along one axis,
// where the centre lies at fraction f between b and c of the texels a b c d, their weights are
//     (1-f, 2-f, 1+f, f) / 4,
// (1 3 3 1) / 8 of an even side; at any fraction all texels of the picture count alike. NaN counts as 0, infinity as 65504.
#include "shared/sanitize.glsl"
#include "shared/halve_sum.glsl"

vec4 shade(Pixel pixel) {
    vec2 position = pixel.uv * vec2(size(halve_input)) - 0.5;
    vec2 b = floor(position);
    vec2 f = position - b;
    vec3 sum = halve_sum(b, f, true);
    [[dont_flatten]] if (!is_finite(sum)) sum = halve_sum(b, f, false);
    return vec4(clamp(sum, -65504.0, 65504.0), 1.0);
}
