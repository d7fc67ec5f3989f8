// SPDX-License-Identifier: MIT
// Brings the visibility to the picture: half-size pixels hold that of four pixels.

vec4 ssao(vec4 color, Pixel pixel, Ssao parameters) {
    // The last of an odd number of pixels takes its neighbour's.
    ivec2 base = min(pixel.texel / 2, size(ssao_half) - 1);
    ivec2 part = pixel.texel - base * 2;
    vec4 four = load(ssao_half, base);
    vec2 pair = part.x == 0 ? four.wx : four.zy;
    float half_size = part.y == 0 ? pair.x : pair.y;
    uint packed = floatBitsToUint(load_clamped(ssao_full, pixel.texel).r);
    float full_size = float(packed & 1023u) / 1023.0;
    float visibility = parameters.resolution == Ssao_resolution_half ? half_size : full_size;
    float luma = clamp(dot(color.rgb, vec3(0.299, 0.587, 0.114)), 0.0, 1.0);
    visibility = parameters.merge == Ssao_merge_luminance ? mix(visibility, 1.0, luma * 0.5) : visibility;
    return vec4(color.rgb * visibility, color.a);
}
