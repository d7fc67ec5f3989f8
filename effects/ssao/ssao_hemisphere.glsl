// SPDX-License-Identifier: MIT
// Visibility by points in the half ball over the surface, each behind the depth buffer or not. After John Chapman, "SSAO
// Tutorial", 2013; unlike there, what lies in the surface's own plane does not occlude it.

// Of [0, 1): ssao_kernel() in ssao.cpp, bit for bit.
float ssao_random(inout uint state) {
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return float(state & 0xFFFFFFu) / 16777216.0;
}

vec3 ssao_kernel(inout uint state, float share) {
    float x = ssao_random(state) * 2.0 - 1.0, y = ssao_random(state) * 2.0 - 1.0, z = ssao_random(state);
    float reach = ssao_random(state) * (0.1 + 0.9 * share * share);
    return vec3(x, y, z) * (reach / max(length(vec3(x, y, z)), 1e-6));
}

float ssao_hemisphere(SsaoPoint point, int samples) {
    vec2 turn = load(ssao_turns, point.texel & 3).xy;
    vec3 normal = point.normal;
    // The turned direction, brought into the tangent plane.
    vec3 tangent = vec3(turn, 0.0) - normal * dot(normal.xy, turn);
    float squared = dot(tangent, tangent);
    tangent = squared > 1e-8 ? tangent * inversesqrt(squared) : vec3(0.0, 0.0, 1.0);
    vec3 bitangent = cross(normal, tangent);
    float radius = custom[5].x, per_radius = custom[5].y, bias = custom[5].z;
    // Texel, before its division, and distance, less the bias, are linear in the point of the kernel.
    vec3 start = vec3(custom[2].xy * point.position.xy - custom[2].zw * point.planar + custom[3].xy, point.planar - bias);
    float w = custom[3].w - custom[3].z * bias;
    vec3 along_x = radius * vec3(custom[2].xy * tangent.xy + custom[2].zw * tangent.z, -tangent.z);
    vec3 along_y = radius * vec3(custom[2].xy * bitangent.xy + custom[2].zw * bitangent.z, -bitangent.z);
    vec3 along_z = radius * vec3(custom[2].xy * normal.xy + custom[2].zw * normal.z, -normal.z);
    // Height of a texel's point over the surface's plane, from the texel and its distance.
    vec2 per_metre = normal.xy * custom[0].xy, flat_per_texel = normal.xy * custom[1].xy;
    float at_metre = dot(normal.xy, custom[0].zw) - normal.z;
    float at_zero = dot(normal.xy, custom[1].zw) - dot(normal, point.position);
    float occlusion = 0.0;
    uint state = 0xDEADBEEFu;
    [[unroll]] for (int i = 0; i < samples; ++i) {
        vec3 kernel = ssao_kernel(state, float(i) / float(samples));
        vec3 clip = start + along_x * kernel.x + along_y * kernel.y + along_z * kernel.z;
        vec2 place = clip.xy * (1.0 / (w - custom[3].z * clip.z)) + custom[4].xy;
        float found = ssao_load(place);
        vec2 whole = vec2(ivec2(place));
        float height = found * (dot(whole, per_metre) + at_metre) + (dot(whole, flat_per_texel) + at_zero);
        float near = clamp(2.0 - abs(point.planar - found) * per_radius, 0.0, 1.0);
        // Outside the picture nothing occludes.
        bvec3 occludes = lessThan(vec3(0.0, found, bias), vec3(min(min(place.x, place.y), found), clip.z, height));
        occlusion += all(occludes) ? near * near * (3.0 - 2.0 * near) : 0.0;
    }
    return 1.0 - occlusion / float(samples);
}
