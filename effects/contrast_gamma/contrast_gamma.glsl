// SPDX-License-Identifier: MIT
// The picture is encoded. The power of a negative number is not defined, and NaN counts as 0.

vec4 contrast_gamma(vec4 color, Pixel pixel, ContrastGamma parameters) {
    vec3 positive = max(color.rgb * parameters.contrast, 0.0);
    return vec4(parameters.gamma == 1.0 ? positive : pow(positive, vec3(parameters.gamma)), color.a);
}
