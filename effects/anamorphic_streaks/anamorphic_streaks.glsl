// SPDX-License-Identifier: MIT
#part line
// A step of the streaks, to the right and to the left: four texels each, custom[1].x apart, with the weights custom[0]. What lies
// outside is black: a light on the edge is not one that goes on beyond it.

void shade(Pixel pixel, out vec4 result[2]) {
    int x = pixel.texel.x, y = pixel.texel.y, apart = int(custom[1].x), last = size(anamorphic_streaks_right).x - 1;
    vec3 right = vec3(0.0), left = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        int before = x - i * apart, behind = x + i * apart;
        right += load_clamped(anamorphic_streaks_right, ivec2(before, y)).rgb * (before >= 0 ? custom[0][i] : 0.0);
        left += load_clamped(anamorphic_streaks_left, ivec2(behind, y)).rgb * (behind <= last ? custom[0][i] : 0.0);
    }
    result[0] = vec4(right, 1.0);
    result[1] = vec4(left, 1.0);
}

#part join
// The last step, and both sides together: each of them has the light itself. custom[1] = (texels apart, what a side and what the
// light count).

vec4 shade(Pixel pixel) {
    int x = pixel.texel.x, y = pixel.texel.y, apart = int(custom[1].x), last = size(anamorphic_streaks_right).x - 1;
    vec3 sides = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        int before = x - i * apart, behind = x + i * apart;
        sides += load_clamped(anamorphic_streaks_right, ivec2(before, y)).rgb * (before >= 0 ? custom[0][i] : 0.0);
        sides += load_clamped(anamorphic_streaks_left, ivec2(behind, y)).rgb * (behind <= last ? custom[0][i] : 0.0);
    }
    vec3 light = load(anamorphic_streaks_light, pixel.texel).rgb;
    return vec4(max(sides * custom[1].y - light * custom[1].z, 0.0), 1.0);
}

#part end
// scene_linear -> scene_linear.

vec4 anamorphic_streaks(vec4 color, Pixel pixel, AnamorphicStreaks parameters) {
    vec3 streak = sample_linear(anamorphic_streaks_drawn, pixel.uv).rgb;
    return vec4(color.rgb + parameters.intensity * parameters.tint * streak, color.a);
}
