// SPDX-License-Identifier: MIT
// Any domain. fog_depth: the host's. The CPU brings fog_custom, see fog.cpp.
#include "shared/camera.glsl"
#include "shared/planar_distance.glsl"

// 1 - exp(-depth), to full precision for thin fog, too.
float fog_coverage(float depth) {
    return depth < 0.05 ? depth * (1.0 - depth * (0.5 - depth / 6.0)) : 1.0 - exp(-depth);
}

// The mean of exp(-falloff max(h, 0)) along a way from one height above the origin to another.
float fog_mean_density(float from, float to, float falloff) {
    float low = min(from, to), high = max(from, to);
    float above = low >= 0.0 ? 1.0 : max(high, 0.0) / max(high - low, 1e-20);
    float depth = falloff * (high - low) * above;
    float thinned = depth > 1e-6 ? fog_coverage(depth) / depth : 1.0;
    return 1.0 - above + above * exp(-falloff * max(low, 0.0)) * thinned;
}

vec4 fog(vec4 color, Pixel pixel, Fog parameters) {
    vec4 range = fog_custom(1), more = fog_custom(2);
    float planar = planar_distance(load(fog_depth, pixel.texel).r, fog_custom(0), range.x);
    bool is_sky = planar >= sky_distance;
    vec3 start = view_ray_start(pixel.uv), ray = view_position(pixel.uv, planar) - start;
    float true_length = length(ray);
    float depth = clamp(true_length * range.y + range.z, 0.0, range.w);
    float thinned = 1.0;
    if (parameters.height_enabled != 0u) {
        float from = dot(frame_view_to_world_y.xyz, start) + more.z, rise = dot(frame_view_to_world_y.xyz, ray);
        if (parameters.height_form == Fog_height_form_integral) {
            rise /= true_length;
            depth *= fog_mean_density(from + rise * parameters.start, from + rise * min(true_length, parameters.end),
                                      parameters.height_falloff);
        } else {
            rise *= is_sky ? parameters.end / true_length : 1.0;
            thinned = exp(-parameters.height_falloff * max(rise + from, 0.0));
        }
    }
    float amount = fog_coverage(depth) * more.x * thinned;
    if (is_sky && parameters.sky == 0u) {
        float share = clamp(1.0 - dot(frame_view_to_world_y.xyz, ray) / true_length * more.w, 0.0, 1.0);
        amount *= parameters.horizon > 0.0 ? share * share * (3.0 - 2.0 * share) : 0.0;
    }
    return vec4(mix(color.rgb, parameters.color, clamp(amount, 0.0, 1.0)), color.a);
}
