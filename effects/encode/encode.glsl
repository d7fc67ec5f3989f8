// SPDX-License-Identifier: MIT
// display_linear or scene_linear -> encoded. NaN counts as 0.

#include "shared/sanitize.glsl"
#include "shared/srgb.glsl"

// SMPTE ST 2084:2014, with light 1.0 for 10000 cd/m2. log2 of its ratio is taken by the series of 2 atanh(z), with z the
// ratio's (r - 1) / (r + 1): |z| < 0.09, so three terms reach single precision, which log2 itself does not on all devices,
// and the exponent 78.84 would multiply its error.
vec3 encode_pq_curve(vec3 light) {
    vec3 y = pow(light, vec3(2610.0 / 16384.0));
    // c1 = 107/128, c2 = 2413/128, c3 = 2392/128
    vec3 z = (y - 1.0) * (21.0 / 128.0) / (235.0 / 128.0 + y * (4805.0 / 128.0));
    vec3 zz = z * z;
    vec3 log2_ratio = z * (2.0 / 0.69314718056) * (1.0 + zz * (1.0 / 3.0 + zz * (1.0 / 5.0)));
    return exp2((2523.0 / 32.0) * log2_ratio);
}

vec4 encode(vec4 color, Pixel pixel, Encode parameters) {
    uint transfer = parameters.transfer;
    if (transfer == Encode_transfer_srgb) {
        color.rgb = srgb_encode(color.rgb);
    } else if (transfer == Encode_transfer_gamma22) {
        color.rgb = pow(srgb_range(color.rgb), vec3(1.0 / 2.2));
    } else if (transfer == Encode_transfer_pq) {
        // ITU-R BT.2087: Rec. 709 primaries in Rec. 2020.
        const mat3 to_rec2020 = mat3(0.627403896, 0.069097289, 0.016391439, 0.329283038, 0.919540395, 0.088013308,
                                     0.043313066, 0.011362316, 0.895595253);
        vec3 nits = to_rec2020 * sanitize(color).rgb * parameters.white_nits;
        color.rgb = encode_pq_curve(clamp(nits, 0.0, parameters.peak_nits) / 10000.0);
    } else if (transfer == Encode_transfer_scrgb) {
        vec3 nits = sanitize(color).rgb * parameters.white_nits;
        color.rgb = clamp(nits, -parameters.peak_nits, parameters.peak_nits) / 80.0;
    }
    return color;
}
