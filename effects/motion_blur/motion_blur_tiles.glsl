// SPDX-License-Identifier: MIT
// The longest motion among the texels under one of a smaller picture.
vec4 shade(Pixel pixel) {
    ivec2 from = size(motion_blur_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    vec4 longest = vec4(0.0);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec4 motion = load(motion_blur_from, ivec2(x, y));
            longest = motion.w > longest.w ? motion : longest;
        }
    return longest;
}
