// SPDX-License-Identifier: MIT
// Any domain.

vec4 grayscale(vec4 color, Pixel pixel, Grayscale parameters) {
    // ITU-R BT.709.
    float luminance = dot(color.rgb, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mix(color.rgb, vec3(luminance), parameters.amount), color.a);
}
