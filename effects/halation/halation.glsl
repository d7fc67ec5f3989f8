// SPDX-License-Identifier: MIT
// scene_linear -> scene_linear.
#include "shared/sanitize.glsl"

vec4 halation(vec4 color, Pixel pixel, Halation parameters) {
    vec3 glow = mix(sample_linear(halation_near, pixel.uv).rgb, sample_linear(halation_far, pixel.uv).rgb,
                    parameters.spread);
    if (parameters.conserves_energy != 0u) {
        vec3 light = sanitize_light(color.rgb);
        float brightness = max(light.r, max(light.g, light.b));
        glow -= light * (max(brightness - parameters.threshold, 0.0) / max(brightness, 1e-6));
    }
    return vec4(color.rgb + parameters.intensity * parameters.tint * glow, color.a);
}
