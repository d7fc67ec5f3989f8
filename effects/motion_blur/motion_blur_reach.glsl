// SPDX-License-Identifier: MIT
// What the smear knows of a pixel: the inverse of its distance, and how far its colour reaches to either side while the
// shutter is open, as x, y and length. custom[0] = (texels of the smeared picture that a pixel of velocity reaches, the
// farthest, pixels a texel, depth of the sky), custom[1] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y).
// custom[0].z is negative where motion_blur_depth is the image of half_depth(): of the texels here, and with a sign.
float motion_blur_inverse(float depth) {
    depth = custom[0].z < 0.0 ? abs(depth) : depth;
    float inverse = (depth * custom[1].z + custom[1].w) / (depth * custom[1].x + custom[1].y);
    // What is no number compares as not nearer than the sky.
    return depth != custom[0].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
}

// The pixel whose motion the texel has, and where its depth is.
ivec2 motion_blur_first(Pixel pixel) { return pixel.texel * int(abs(custom[0].z)); }
ivec2 motion_blur_place(Pixel pixel) { return custom[0].z < 0.0 ? pixel.texel : motion_blur_first(pixel); }

vec4 motion_blur_reach(vec2 velocity, float inverse) {
    vec2 reach = sanitize(vec4(velocity, 0.0, 0.0)).xy * custom[0].x;
    float along = length(reach);
    float scale = min(1.0, custom[0].y / max(along, 1e-6));
    return vec4(inverse, reach * scale, along * scale);
}
