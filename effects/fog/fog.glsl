// SPDX-License-Identifier: MIT
// Any domain. fog_depth: the host's. The CPU brings fog_custom, see fog.cpp.
#include "shared/camera.glsl"
#include "shared/planar_distance.glsl"

// 1 - exp(-depth), to full precision for thin fog, too.
float fog_coverage(float depth) {
    return depth < 0.05 ? depth * (1.0 - depth * (0.5 - depth / 6.0)) : 1.0 - exp(-depth);
}

vec4 fog(vec4 color, Pixel pixel, Fog parameters) {
    vec4 range = fog_custom(1), more = fog_custom(2);
    float planar = planar_distance(load(fog_depth, pixel.texel).r, fog_custom(0), range.x);
    bool is_sky = planar >= sky_distance;
    vec3 ray = view_position(pixel.uv, planar);
    float true_length = length(ray);
    float amount = fog_coverage(clamp(true_length * range.y + range.z, 0.0, range.w)) * more.x;
    if (parameters.height_enabled != 0u) {
        float rise = dot(frame_view_to_world_y.xyz, ray) * (is_sky ? parameters.end / true_length : 1.0);
        amount *= exp(more.y * max(rise + more.z, 0.0));
    }
    if (is_sky && parameters.sky == 0u) {
        float share = clamp(1.0 - dot(frame_view_to_world_y.xyz, ray) / true_length * more.w, 0.0, 1.0);
        amount *= parameters.horizon > 0.0 ? share * share * (3.0 - 2.0 * share) : 0.0;
    }
    return vec4(mix(color.rgb, parameters.color, clamp(amount, 0.0, 1.0)), color.a);
}
