// SPDX-License-Identifier: MIT
// The planar distance of the first pixel of every two by two: a mean would lie on no surface.
vec4 shade(Pixel pixel) { return vec4(load(shared_linear_depth, pixel.texel * 2).r); }
