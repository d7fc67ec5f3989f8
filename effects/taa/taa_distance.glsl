// SPDX-License-Identifier: MIT
// Inverse planar distance, 0 of the sky: what the next frame asks for what was in front. custom[0] = (x, y, z, w) with
// distance = (d x + y) / (d z + w), custom[1].x the sky's depth.
vec4 shade(Pixel pixel) {
    float depth = load(taa_depth, pixel.texel).r;
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    return vec4(depth != custom[1].x && inverse > 0.0 ? min(inverse, 65504.0) : 0.0, 0.0, 0.0, 1.0);
}
