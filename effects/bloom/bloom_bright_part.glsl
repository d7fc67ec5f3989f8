// SPDX-License-Identifier: MIT
// What the prefilter makes of its taps.

// Brian Karis, "Tone mapping" (2013): average by 1 / (1 + luminance). As in Jorge Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare" (2014), a box is the unit; unlike there, the sum is divided by the sum of weights.
vec4 bloom_box(vec3 sum, float weight) {
    vec3 mean = 0.25 * sum;
    float luminance = dot(mean, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mean, 1.0) * (weight / (1.0 + custom[1].x * luminance));
}

vec3 bloom_average(BloomTaps taps) {
    vec4 total = bloom_box(taps.middle, 0.5) + bloom_box(taps.top_left + taps.top + taps.left + taps.centre, 0.125) +
                 bloom_box(taps.top_right + taps.top + taps.right + taps.centre, 0.125) +
                 bloom_box(taps.bottom_left + taps.bottom + taps.left + taps.centre, 0.125) +
                 bloom_box(taps.bottom_right + taps.bottom + taps.right + taps.centre, 0.125);
    return total.rgb / total.a;
}

vec4 bloom_bright_part(vec3 color) {
    float threshold = custom[0].x;
    float knee = custom[0].y;
    float brightness = max(color.r, max(color.g, color.b));
    float soft = clamp(brightness - threshold + knee, 0.0, 2.0 * knee);
    soft = soft * soft / (4.0 * knee + 1e-5);
    float weight = max(soft, brightness - threshold) / max(brightness, 1e-5);
    return vec4(min(color * weight, custom[0].z) * custom[0].w, 1.0);
}
