// SPDX-License-Identifier: MIT
// The image of displacements, repeated, with linear interpolation across the seam.

// `texel` lies in the image or one beside it. Not by %, which SPIR-V leaves open for numbers below 0.
vec2 perturb_texel(ivec2 texel) {
    ivec2 extent = size(perturb_distortion);
    texel += extent * (ivec2(lessThan(texel, ivec2(0))) - ivec2(greaterThanEqual(texel, extent)));
    return load(perturb_distortion, texel).rg;
}

vec2 perturb_image(vec2 uv) {
    vec2 place = fract(uv) * vec2(size(perturb_distortion)) - 0.5;
    ivec2 first = ivec2(floor(place));
    vec2 within = place - floor(place);
    vec2 top = mix(perturb_texel(first), perturb_texel(first + ivec2(1, 0)), within.x);
    vec2 bottom = mix(perturb_texel(first + ivec2(0, 1)), perturb_texel(first + 1), within.x);
    return mix(top, bottom, within.y);
}
