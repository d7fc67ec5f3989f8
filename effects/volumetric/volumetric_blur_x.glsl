// SPDX-License-Identifier: MIT
#include "volumetric_blur.glsl"

vec4 shade(Pixel pixel) { return volumetric_blur(pixel, ivec2(1, 0)); }
