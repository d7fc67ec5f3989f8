// SPDX-License-Identifier: MIT
// Brings the visibility to the picture: half-size pixels hold that of four pixels.

vec4 ssao(vec4 color, Pixel pixel, Ssao parameters) {
    float visibility;
    if (parameters.resolution == Ssao_resolution_half) {
        // The last of an odd number of pixels takes its neighbour's.
        ivec2 base = min(pixel.texel >> 1, size(ssao_half) - 1);
        bvec2 is_second = greaterThan(pixel.texel, base << 1);
        vec4 four = load(ssao_half, base);
        vec2 pair = is_second.x ? four.zy : four.wx;
        visibility = is_second.y ? pair.y : pair.x;
    } else {
        visibility = float(floatBitsToInt(load_clamped(ssao_full, pixel.texel).r) & 1023) / 1023.0;
    }
    float luma = clamp(dot(color.rgb, vec3(0.299, 0.587, 0.114)), 0.0, 1.0);
    visibility = parameters.merge == Ssao_merge_luminance ? mix(visibility, 1.0, luma * 0.5) : visibility;
    return vec4(color.rgb * visibility, color.a);
}
