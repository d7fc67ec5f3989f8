// SPDX-License-Identifier: MIT
// Of a picture that is multiplied by its alpha the colours alone, and back. Light without alpha, such as a flame's, stays
// as it is, and so do opaque pixels, to the bit.
#ifndef SHARED_ALPHA
#define SHARED_ALPHA
float alpha_of(vec4 color) { return color.a > 0.0 && color.a < 1.0 ? color.a : 1.0; }
vec4 alpha_divided(vec4 color) { return vec4(color.rgb / alpha_of(color), color.a); }
vec4 alpha_multiplied(vec4 color) { return vec4(color.rgb * alpha_of(color), color.a); }
#endif
