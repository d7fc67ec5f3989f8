// SPDX-License-Identifier: MIT
// Occlusion of one pixel by the method that is chosen. The other one's loops run once: that costs less than a branch
// around their reads; and a loop that asks before its body costs one round more, on drivers that run lanes in step. Of
// custom:
//     [0], [1]  view position of a texel: xy = (texel * [0].xy + [0].zw) * planar + texel * [1].xy + [1].zw
//     [2], [3]  texel of a view position: (xy * [2].xy + z * [2].zw + [3].xy) / (z * [3].z + [3].w) + [4].xy
//     [4].zw    just below the number of texels
//     [5]       (samples of the hemisphere, 1 / radius, bias, intensity)
//     [6]       (distance where fading begins, 1 / its length, radius, 1 / length over which occluders fade)
//     [7]       (directions, steps in each)
//     [8 ...]   points of the kernel times the radius; or 16 first directions, then the turns from one to the next

struct SsaoPoint {
    ivec2 texel;
    float planar;
    vec3 position, normal;
    bool is_surface;
};

vec2 ssao_place(vec2 texel, float planar) {
    return (texel * custom[0].xy + custom[0].zw) * planar + (texel * custom[1].xy + custom[1].zw);
}

#include "ssao_hemisphere.glsl"
#include "ssao_horizon.glsl"

SsaoPoint ssao_point(Pixel pixel) {
    SsaoPoint point;
    point.texel = pixel.texel;
    float planar = load(ssao_distance, pixel.texel).r;
    // What is no number compares as neither.
    point.is_surface = planar > 1e-6 && planar < 1e9;
    point.planar = point.is_surface ? planar : 1.0;
    point.position = vec3(ssao_place(vec2(pixel.texel), point.planar), -point.planar);
    point.normal = load(ssao_normals, pixel.texel).xyz;
    return point;
}

// Planar distance with its last ten bits replaced by the visibility: the blur then reads one number a pixel.
vec4 ssao_packed(SsaoPoint point, float visibility) {
    float seen = clamp(1.0 - (1.0 - visibility) * custom[5].w, 0.0, 1.0);
    float fade = clamp((point.planar - custom[6].x) * custom[6].y, 0.0, 1.0);
    seen = mix(seen, 1.0, fade * fade * (3.0 - 2.0 * fade));
    uint bits = point.is_surface ? uint(seen * 1023.0 + 0.5) : 1023u;
    uint distance = floatBitsToUint(point.is_surface ? point.planar : 1e10) & ~1023u;
    return vec4(uintBitsToFloat(distance | bits), 0.0, 0.0, 0.0);
}

vec4 shade(Pixel pixel) {
    SsaoPoint point = ssao_point(pixel);
    vec4 noise = load(ssao_noise, pixel.texel & 3);
    float by_points = ssao_hemisphere(point, noise.xy), by_horizons = ssao_horizons(point, noise.zw);
    return ssao_packed(point, custom[5].x > 0.0 ? by_points : by_horizons);
}
