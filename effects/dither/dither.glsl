// SPDX-License-Identifier: MIT
// encoded -> encoded. The side image dither_tile holds triangular noise, another offset of one tile in each channel;
// dither_custom(0).x, an integer of 6 bits across and 6 down, shifts it.

const int dither_tile_size = 64;

// Noise of one step of rounding, and a second one beside it that is as wide at most as there is room to the end of the
// range: the mean of what is rounded stays (Lipshitz, Wannamaker and Vanderkooy, "Quantization and Dither", 1992). Their sum
// is a trapezoid, half as high as wide, whose quantile this is, of the rank that triangular noise in (-1, 1) has.
vec3 dither_trapezoid(vec3 noise, vec3 second) {
    vec3 rest = 1.0 - abs(noise);
    vec3 slope = 0.5 + second - sqrt(2.0 * second) * rest, plateau = 0.5 - 0.5 * rest * rest;
    return sign(noise) * mix(slope, plateau, greaterThanEqual(rest * rest, 2.0 * second));
}

vec4 dither(vec4 color, Pixel pixel, Dither parameters) {
    int offset = floatBitsToInt(dither_custom(0).x);
    vec3 noise = load(dither_tile, (pixel.texel + ivec2(offset, offset >> 6)) & (dither_tile_size - 1)).rgb;
    // Near black and white the noise narrows; outside there is none.
    vec3 room = min(color.rgb, 1.0 - color.rgb);
    vec3 widest = vec3(0.5 * parameters.intensity);
    if (parameters.ends == Dither_ends_unrounded)
        return vec4(color.rgb + noise * max(min(widest, room), vec3(0.0)), color.a);
    // More than a code to either side narrows to one first.
    vec3 code = min(widest, max(room, vec3(1.0 / 255.0)));
    vec3 added = code * dither_trapezoid(noise, clamp(room / max(code, vec3(1e-6)), 0.0, 0.5));
    // What is rounded to the ends anyway is brought to them.
    return vec4(mix(clamp(color.rgb + added, 0.0, 1.0), color.rgb, lessThan(room, vec3(0.0))), color.a);
}
