// SPDX-License-Identifier: MIT
// The largest circle of the near field among the texels under one of a smaller picture.
vec4 shade(Pixel pixel) {
    ivec2 from = size(depth_of_field_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    float smallest = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) smallest = min(smallest, load(depth_of_field_from, ivec2(x, y)).a);
    return vec4(-smallest);
}
