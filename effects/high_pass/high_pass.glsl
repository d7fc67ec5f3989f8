// SPDX-License-Identifier: MIT
// Any domain.

vec4 high_pass(vec4 color, Pixel pixel, HighPass parameters) {
    // ITU-R BT.709.
    float luminance = dot(color.rgb, vec3(0.2126, 0.7152, 0.0722));
    // The knee's bottom is excluded, so a knee of 0 is a step. NaN compares false and is black.
    float t = clamp((luminance - parameters.threshold) / max(parameters.knee, 1e-30) + 1.0, 0.0, 1.0);
    float kept = luminance >= parameters.threshold ? 1.0 : parameters.knee > 0.0 ? t * t * (3.0 - 2.0 * t) : 0.0;
    return vec4(kept > 0.0 ? color.rgb * kept : vec3(0.0), color.a);
}
