// SPDX-License-Identifier: MIT
// Any domain. The falloff is elliptical: distance is measured in uv, 1 at the corner.

vec4 vignette(vec4 color, Pixel pixel, Vignette parameters) {
    vec2 offset = pixel.uv - 0.5;
    float squared = 2.0 * dot(offset, offset);
    // d^s = (d^2)^(s/2), so no square root is taken.
    // Some drivers make something of 0 to a small power.
    float falloff = squared > 0.0 ? pow(squared, 0.5 * parameters.smoothness) : 0.0;
    return vec4(color.rgb * clamp(1.0 - falloff * parameters.intensity, 0.0, 1.0), color.a);
}
