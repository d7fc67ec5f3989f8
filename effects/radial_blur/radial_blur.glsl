// SPDX-License-Identifier: MIT
// Any domain. Eight taps along the line through the centre; distances in uv.
#include "shared/sanitize.glsl"

vec4 radial_blur(Pixel pixel, RadialBlur parameters) {
    vec4 own = sanitize(load_clamped(picture, pixel.texel));
    vec2 from_centre = pixel.uv - parameters.center;
    float distance = length(from_centre);
    // Strength times direction: the step grows with the distance, so nothing is divided by it.
    vec2 step_uv = from_centre * (parameters.radial_blur * 0.04);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 8; ++i) sum += sample_linear(picture, pixel.uv + step_uv * (float(i) - 3.5)).rgb;
    if (!is_finite(sum)) {
        sum = vec3(0.0);
        for (int i = 0; i < 8; ++i) sum += sanitize(sample_linear(picture, pixel.uv + step_uv * (float(i) - 3.5))).rgb;
    }
    float amount = clamp(smoothstep(0.1, 0.7, distance) * parameters.radial_blur, 0.0, 1.0);
    return vec4(mix(own.rgb, sum * 0.125, amount), own.a);
}
