// SPDX-License-Identifier: MIT
// Full size: the picture, in numbers that may be spread.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) { return sanitize(load(motion_blur_picture, pixel.texel)); }
