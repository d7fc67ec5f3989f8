// SPDX-License-Identifier: MIT
// The host's velocity to the library's: custom[0] = (scale, offset), two numbers each.
vec4 shade(Pixel pixel) { return vec4(load(shared_velocity, pixel.texel).rg * custom[0].xy + custom[0].zw, 0.0, 1.0); }
