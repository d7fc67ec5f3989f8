// SPDX-License-Identifier: MIT
// Occlusion of one pixel by the chosen method. Method and number of samples are literals in all but the first frames, and
// with them the points of the kernel, or the directions. Of custom:
//     [0], [1]  view position of a texel: xy = (texel * [0].xy + [0].zw) * planar + texel * [1].xy + [1].zw
//     [2], [3]  texel of a view position: (xy * [2].xy + z * [2].zw + [3].xy) / (z * [3].z + [3].w) + [4].xy
//     [4].zw    just below the number of texels
//     [5]       (radius, 1 / radius, bias, intensity)
//     [6]       (distance where fading begins, 1 / its length, thickness, bits of the tile's offset: x + 4 y)

struct SsaoPoint {
    ivec2 texel;
    float planar;
    vec3 position, normal;
    bool is_near, is_surface;  // no sky; and no sprite
};

vec2 ssao_place(vec2 texel, float planar) {
    return (texel * custom[0].xy + custom[0].zw) * planar + (texel * custom[1].xy + custom[1].zw);
}

// The distance at a place, in texels; 0 outside the picture, negative where nothing occludes. A place within one texel before it is on its border.
float ssao_load(vec2 place) {
    if (loads_outside_are_zero) return load(ssao_distance, ivec2(place)).r;
    vec2 inside = clamp(place, vec2(-0.99), custom[4].zw);
    return place == inside ? load(ssao_distance, ivec2(inside)).r : 0.0;
}

#include "ssao_hemisphere.glsl"
#include "ssao_horizon.glsl"
#include "ssao_packed.glsl"

SsaoPoint ssao_point(Pixel pixel) {
    SsaoPoint point;
    point.texel = pixel.texel;
    float distance = load(ssao_distance, pixel.texel).r, planar = abs(distance);
    // What is no number compares as neither.
    point.is_near = planar > 1e-6 && planar < 1e9;
    point.is_surface = point.is_near && distance > 0.0;
    point.planar = point.is_near ? planar : 1.0;
    point.position = vec3(ssao_place(vec2(pixel.texel), point.planar), -point.planar);
    point.normal = load(ssao_normals, pixel.texel).xyz;
    return point;
}

vec4 ssao_result(SsaoPoint point, float visibility) {
    float seen = clamp(1.0 - (1.0 - visibility) * custom[5].w, 0.0, 1.0);
    float fade = clamp((point.planar - custom[6].x) * custom[6].y, 0.0, 1.0);
    seen = mix(seen, 1.0, fade * fade * (3.0 - 2.0 * fade));
    float near = point.is_near ? 1.0 / point.planar : 1e-10;
    return vec4(ssao_with(near, point.is_surface ? seen * 1023.0 : 1023.0), 0.0, 0.0, 0.0);
}

vec4 shade(Pixel pixel) {
    SsaoPoint point = ssao_point(pixel);
    Ssao parameters = ssao_parameters();
    int samples = clamp(parameters.samples, 1, 64);
    float visibility;
    if (parameters.method == Ssao_method_hemisphere)
        visibility = ssao_hemisphere(point, samples);
    else
        visibility = ssao_horizons(point, samples);
    return ssao_result(point, visibility);
}
