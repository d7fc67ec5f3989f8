// SPDX-License-Identifier: MIT
// From the cleaned taps of the scene to what glows of them. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.

// Brian Karis, "Tone mapping" (2013): average by 1 / (1 + luminance). As in Jorge Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare" (2014), a box is the unit; unlike there, the sum is divided by the sum of weights.
vec4 bloom_box(vec3 sum, float weight) {
    vec3 mean = 0.25 * sum;
    float luminance = dot(mean, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mean, 1.0) * (weight / (1.0 + custom[1].x * luminance));
}

vec3 bloom_average(BloomTaps taps) {
    vec3 upper_left = taps.left.top + taps.left.middle, lower_left = taps.left.middle + taps.left.bottom;
    vec3 upper = taps.centre.top + taps.centre.middle, lower = taps.centre.middle + taps.centre.bottom;
    vec3 upper_right = taps.right.top + taps.right.middle, lower_right = taps.right.middle + taps.right.bottom;
    vec4 total = bloom_box(taps.inner, 0.5) + bloom_box(upper_left + upper, 0.125) + bloom_box(upper + upper_right, 0.125) +
                 bloom_box(lower_left + lower, 0.125) + bloom_box(lower + lower_right, 0.125);
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
