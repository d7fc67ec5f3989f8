// SPDX-License-Identifier: MIT
// Any domain. fog_distance: planar distance.
#include "shared/camera.glsl"

// 1 - exp(-depth), to full precision for thin fog, too.
float fog_coverage(float depth) {
    return depth < 0.05 ? depth * (1.0 - depth * (0.5 - depth / 6.0)) : 1.0 - exp(-depth);
}

vec4 fog(vec4 color, Pixel pixel, Fog parameters) {
    float planar = load(fog_distance, pixel.texel).r;
    bool is_sky = planar >= sky_distance;
    vec3 ray = view_position(pixel.uv, is_sky ? 1.0 : planar);
    float true_length = length(ray), distance = is_sky ? parameters.end : true_length;
    // Full at `end`.
    float span = max(parameters.end - parameters.start, 1e-6);
    float x = clamp(distance - parameters.start, 0.0, span);
    float amount = fog_coverage(parameters.density * x) / max(fog_coverage(parameters.density * span), 1e-30);
    if (parameters.height_enabled != 0u) {
        float rise = dot(frame_view_to_world_y.xyz, ray) * (is_sky ? parameters.end / true_length : 1.0);
        float above = max(camera_position().y + rise - parameters.height_origin, 0.0);
        amount *= exp(-parameters.height_falloff * above);
    }
    if (is_sky && parameters.sky == 0u) amount = 0.0;
    return vec4(mix(color.rgb, parameters.color, clamp(amount, 0.0, 1.0)), color.a);
}
