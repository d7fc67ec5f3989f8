// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear. Everything that does not depend on the pixel comes from the CPU: see the layout there.
#include "shared/sanitize.glsl"

vec3 color_grade_rows(vec3 color, int first) {
    return vec3(dot(color_grade_custom(first).rgb, color), dot(color_grade_custom(first + 1).rgb, color),
                dot(color_grade_custom(first + 2).rgb, color));
}

float color_grade_luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

vec3 color_grade_zones(vec3 light) {
    vec4 shadows = color_grade_custom(3), midtones = color_grade_custom(4), highlights = color_grade_custom(5);
    float luminance = color_grade_luminance(light);
    vec2 t = clamp(luminance * vec2(midtones.a, color_grade_custom(6).a) - vec2(shadows.a, highlights.a), 0.0, 1.0);
    t = t * t * (3.0 - 2.0 * t);
    return light * mix(mix(shadows.rgb, midtones.rgb, t.x), highlights.rgb, t.y);
}

// How many stops the curves move light of so many stops.
vec3 color_grade_curves(vec3 stops, int segments) {
    vec3 moved = color_grade_custom(13).rgb;
    for (int i = 0; i < segments; ++i) {
        int at = 14 + 4 * i;
        vec4 start = color_grade_custom(at), scale = color_grade_custom(at + 1), square = color_grade_custom(at + 2);
        vec3 t = clamp((stops - start.rgb) * scale.rgb, 0.0, 1.0);
        moved += t * (vec3(start.a, scale.a, square.a) + t * (square.rgb + t * color_grade_custom(at + 3).rgb));
    }
    return moved;
}

vec4 color_grade(vec4 color, Pixel pixel, ColorGrade parameters) {
    vec3 light = color_grade_zones(color_grade_rows(sanitize(color).rgb, 0));
    vec4 gain = color_grade_custom(7);
    light = clamp(light * gain.rgb + color_grade_custom(6).rgb, -65536.0, 65536.0);
    if (gain.a != 0.0) {
        vec4 slope = color_grade_custom(8), offset = color_grade_custom(9);
        vec3 stops = log2(max(abs(light), 5.9604645e-8));
        vec3 graded = stops * slope.rgb + offset.rgb;
        graded += color_grade_curves(graded, int(slope.a));
        light *= exp2(min(graded, 16.0) - stops);
    }
    light = color_grade_rows(light, 10);
    float most = max(max(light.r, light.g), light.b);
    float least = min(min(light.r, light.g), light.b);
    float colorful = most > 0.0 ? min((most - least) / most, 1.0) : 0.0;
    float scale = color_grade_custom(0).a + color_grade_custom(1).a * (1.0 - colorful);
    return vec4(mix(vec3(color_grade_luminance(light)), light, scale), color.a);
}
