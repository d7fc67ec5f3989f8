// SPDX-License-Identifier: MIT
// Device depth to planar distance. custom[0] = (a, b, c, d) with distance = (depth * a + b) / (depth * c + d), custom[1].x
// the depth of the sky. What is no number is sky, too: it compares as neither, so the comparison must not be turned round.
vec4 shade(Pixel pixel) {
    float depth = load(shared_depth, pixel.texel).r;
    float planar = (depth * custom[0].x + custom[0].y) / (depth * custom[0].z + custom[0].w);
    return vec4(depth != custom[1].x && planar < 1e9 ? max(planar, 0.0) : 1e10);
}
