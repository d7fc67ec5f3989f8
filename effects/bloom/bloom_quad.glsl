// SPDX-License-Identifier: MIT
// Six texels each way under a pixel are eight under the 2x2 of its quad: each pixel loads one quarter of those, 4x4, and
// the quad's pixels tell each other the rest. Counted from the quad's border to its middle, so that all four do the same.

ivec2 bloom_first(Pixel pixel) {
    return pixel.texel * 2 - 2 + 5 * (pixel.texel & 1);
}

ivec2 bloom_inward(Pixel pixel) {
    return 1 - 2 * (pixel.texel & 1);
}

// What all four have for this pixel: itself, the one beside it, the one below, and the one across.
vec3 bloom_sum(vec3 own, vec3 for_beside, vec3 for_below, vec3 for_across) {
    return own + from_beside(for_beside) + from_below(for_below + from_beside(for_across));
}
