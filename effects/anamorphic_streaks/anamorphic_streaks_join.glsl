// SPDX-License-Identifier: MIT
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
