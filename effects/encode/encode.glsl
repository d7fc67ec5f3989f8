// SPDX-License-Identifier: MIT
// display_linear or scene_linear -> encoded. NaN counts as 0.

#include "shared/color_state.glsl"
#include "shared/sanitize.glsl"
#include "shared/srgb.glsl"

vec4 encode(vec4 color, Pixel pixel, Encode parameters) {
    uint transfer = parameters.transfer;
    if (transfer == Encode_transfer_srgb) {
        color.rgb = srgb_encode(color.rgb);
    } else if (transfer == Encode_transfer_gamma22) {
        color.rgb = pow(srgb_range(color.rgb), vec3(1.0 / 2.2));
    } else if (transfer == Encode_transfer_pq) {
        vec3 nits = color_state_rec2020 * sanitize(color).rgb * parameters.white_nits;
        color.rgb = pq_encode(clamp(nits, 0.0, parameters.peak_nits) / 10000.0);
    } else if (transfer == Encode_transfer_scrgb) {
        vec3 nits = sanitize(color).rgb * parameters.white_nits;
        color.rgb = clamp(nits, -parameters.peak_nits, parameters.peak_nits) / 80.0;
    } else if (transfer == Encode_transfer_hlg) {
        vec3 nits = color_state_rec2020 * sanitize(color).rgb * parameters.white_nits;
        color.rgb = hlg_encode(nits / parameters.peak_nits, hlg_ootf(parameters.peak_nits));
    } else if (transfer == Encode_transfer_p3) {
        color.rgb = srgb_encode(color_state_p3 * sanitize(color).rgb);
    }
    return color;
}
