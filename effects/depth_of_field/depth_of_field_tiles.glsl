// SPDX-License-Identifier: MIT
// The same among small tiles.
vec4 shade(Pixel pixel) {
    ivec2 from = size(depth_of_field_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    float largest = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) largest = max(largest, load(depth_of_field_from, ivec2(x, y)).r);
    return vec4(largest);
}
