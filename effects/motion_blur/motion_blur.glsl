// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. Lays what is smeared over the sharp picture.
vec4 motion_blur(vec4 color, Pixel pixel, MotionBlur parameters) {
    vec4 over = sample_linear(motion_blur_smeared, pixel.uv);
    return vec4(color.rgb * (1.0 - over.a) + over.rgb, color.a);
}
