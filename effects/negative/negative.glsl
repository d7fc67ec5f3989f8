// SPDX-License-Identifier: MIT
// Any domain.

vec4 negative(vec4 color, Pixel pixel, Negative parameters) {
    // mix(c, 1 - c, amount) without the difference of two large terms.
    return vec4(color.rgb * (1.0 - 2.0 * parameters.amount) + parameters.amount, color.a);
}
