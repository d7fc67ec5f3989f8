// SPDX-License-Identifier: MIT
// What the smear knows of a pixel: the inverse of its distance, and how far its colour reaches to either side while the
// shutter is open, as x, y and length. custom[0] = (texels of the smeared picture that a pixel of velocity reaches, the
// farthest, pixels a texel, depth of the sky), custom[1]: the distance of planar_distance(). custom[0].z is negative where
// motion_blur_depth is the image of half_depth(), of the texels here and with a sign.
#include "shared/planar_distance.glsl"

// The pixel whose motion the texel has, and where its depth is.
ivec2 motion_blur_first(Pixel pixel) { return pixel.texel * int(abs(custom[0].z)); }
ivec2 motion_blur_place(Pixel pixel) { return custom[0].z < 0.0 ? pixel.texel : motion_blur_first(pixel); }

float motion_blur_planar(float depth) {
    return planar_distance(custom[0].z < 0.0 ? abs(depth) : depth, custom[1], custom[0].w);
}

// The sky is infinitely far.
vec4 motion_blur_inverse(vec4 planar) { return mix(1.0 / max(planar, 1e-4), vec4(0.0), greaterThanEqual(planar, vec4(1e10))); }

vec4 motion_blur_reach(vec2 velocity, float inverse) {
    vec2 reach = sanitize(vec4(velocity, 0.0, 0.0)).xy * custom[0].x;
    float along = length(reach);
    float scale = min(1.0, custom[0].y / max(along, 1e-6));
    return vec4(inverse, reach * scale, along * scale);
}
