// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.

vec4 anamorphic_streaks(vec4 color, Pixel pixel, AnamorphicStreaks parameters) {
    vec3 streak = sample_linear(anamorphic_streaks_drawn, pixel.uv).rgb;
    return vec4(color.rgb + parameters.intensity * parameters.tint * streak, color.a);
}
