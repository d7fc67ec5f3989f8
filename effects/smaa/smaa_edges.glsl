// SPDX-License-Identifier: MIT
// Encoded or display_linear. Which pixels differ from the one to the left (red) and the one above (green).
#include "smaa_detect.glsl"

vec4 shade(Pixel pixel) { return smaa_detected(pixel.texel, vec2(smaa_parameters().threshold)); }
