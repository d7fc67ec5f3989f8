// SPDX-License-Identifier: MIT
// Any domain. fog_distance: planar distance.
#include "shared/camera.glsl"

vec4 fog(vec4 color, Pixel pixel, Fog parameters) {
    float planar = load(fog_distance, pixel.texel).r;
    bool is_sky = planar >= sky_distance;
    vec3 ray = world_direction(view_position(pixel.uv, is_sky ? 1.0 : planar));
    float planar_to_true = length(ray);
    if (is_sky) ray *= parameters.end / planar_to_true;
    float distance = is_sky ? parameters.end : planar_to_true;
    // Full at `end`: 1 - exp(-density x) over its value there, which tends to x over the whole length for thin fog.
    float span = max(parameters.end - parameters.start, 1e-6);
    float x = clamp(distance - parameters.start, 0.0, span);
    float whole = 1.0 - exp(-parameters.density * span);
    float amount = whole > 1e-4 ? (1.0 - exp(-parameters.density * x)) / whole : x / span;
    if (parameters.height_enabled != 0u) {
        float above = max(camera_position().y + ray.y - parameters.height_origin, 0.0);
        amount *= exp(-parameters.height_falloff * above);
    }
    if (is_sky && parameters.sky == 0u) amount = 0.0;
    return vec4(mix(color.rgb, parameters.color, clamp(amount, 0.0, 1.0)), color.a);
}
