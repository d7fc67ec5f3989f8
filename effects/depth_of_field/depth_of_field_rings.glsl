// SPDX-License-Identifier: MIT
// What is gathered about a texel: the radius, in texels, and the distance between rings.
struct DepthOfFieldRings {
    float circle;   // the texel's own
    float near;     // the largest of the near field around
    float radius;   // of the farthest ring
    int count;
    float rings_a_texel;
    float spacing;  // of rings, in texels
};

DepthOfFieldRings depth_of_field_rings(Pixel pixel) {
    float circle = load(depth_of_field_color, pixel.texel).a;
    ivec2 tile = pixel.texel * size(depth_of_field_near_tiles) / pixel.size;
    float near = load(depth_of_field_near_tiles, tile).r, radius = max(near, circle);
    int count = clamp(int(ceil(radius)), 2, depth_of_field_parameters().rings);
    // Rings of whole weight, and the last of half of it, spread as a disc of this radius does.
    float square = float(count * count), spread = sqrt((1.0 + 4.0 * square) / (4.0 * square * (square + 1.0)));
    radius = max(radius, 1e-3);
    return DepthOfFieldRings(circle, near, radius, count, float(count) / radius, radius * spread);
}
