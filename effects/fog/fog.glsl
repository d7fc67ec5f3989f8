// SPDX-License-Identifier: MIT
// Any domain. fog_depth: the host's. The CPU brings fog_custom, see fog.cpp: 0 and 1.x are the constants of
// planar_distance().
#include "shared/camera.glsl"
#include "shared/planar_distance.glsl"

vec4 fog(vec4 color, Pixel pixel, Fog parameters) {
    vec4 range = fog_custom(1), curve = fog_custom(2);
    float planar = planar_distance(load(fog_depth, pixel.texel).r, fog_custom(0), range.x);
    vec3 ray = view_position(pixel.uv, planar);
    float true_length = length(ray);
    float x = clamp(true_length - range.y, 0.0, range.z);
    float amount = x * (curve.x + curve.y * x) + curve.z * (1.0 - exp2(curve.w * x));
    bool is_sky = planar >= sky_distance;
    if (parameters.height_enabled != 0u) {
        vec4 height = fog_custom(3);
        float rise = dot(frame_view_to_world_y.xyz, ray) * (is_sky ? height.z / true_length : 1.0);
        amount *= exp2(height.x * max(rise + height.y, 0.0));
    }
    if (is_sky && parameters.sky == 0u) amount = 0.0;
    return vec4(mix(color.rgb, parameters.color, clamp(amount, 0.0, 1.0)), color.a);
}
