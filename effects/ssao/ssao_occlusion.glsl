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

// Ground-truth visibility: along slices through the view vector (Jorge Jimenez, Xian-Chun Wu, Angelo Pesce and Adrian
// Jarabo, "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016; equation 7 is theirs), with occluders of a
// thickness, whose shares of the cosine-weighted arc are bits of a mask (Olivier Therrien, Yannick Levesque and Guillaume
// Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", 2023).

// ssao.hpp
const int ssao_sectors = 31;

// A slice through the view vector. Where both its sides differ, the first is the one ahead.
struct SsaoSlice {
    vec2 texels;          // a metre across the view, at the point's distance
    float first, stride;  // of the steps: metres across the view
    vec2 skew;            // metres toward the eye for one across, at one distance
    float facing;         // cosine and sines of the normal's angle to the view vector
    vec2 sideways;
    float bias;  // in the slice, where the normal is as long as there
};

// The share of the arc from the surface's plane to the view vector that lies below the direction of this cosine, in
// sectors: x x (a + (1 - a) x), x being the cosine's own share, is equation 7 within 0.02,
// and 0.05 where the normal leans over by more than 75 degrees.
vec2 ssao_sector(vec2 cosine, vec2 scale, vec2 bend) {
    vec2 x = clamp(cosine * scale + (1.0 - scale), 0.0, 1.0);
    return x * x * ((float(ssao_sectors) - bend) * x + bend) + 0.5;
}

// How many sectors are occluded on both sides. `eye` is the ray to the point: its length, that of a metre of planar
// distance; `width` that of a texel, linear in the planar distance and 1 at the point's.
vec2 ssao_occluded(SsaoPoint point, SsaoSlice slice, vec2 width, vec2 eye, int steps) {
    float radius = custom[5].x, per_radius = custom[5].y, thickness = custom[6].z;
    vec2 scale = 1.0 / max(1.0 + slice.sideways, 1e-4), bend = float(ssao_sectors) / (1.0 - 0.6 * slice.sideways);
    // Of the samples before: how far inside the sphere they lie, and toward the eye. What leaves the sphere by more than
    // this share of that is another surface: the fewer the steps, the more of one lies between two.
    float leave = min(4.0 / float(steps), 1.0), least = 1.0 / (1.0 + leave);
    vec2 room = vec2(radius), height = vec2(0.0);
    const uvec2 one = uvec2(1u);
    uvec2 mask = uvec2(0u);
    [[unroll]] for (int i = 0; i < steps; ++i) {
        float along = slice.first + float(i) * slice.stride;
        vec2 middle = vec2(point.texel) + 0.5, away = slice.texels * along;
        vec2 found = vec2(ssao_load(middle + away), ssao_load(middle - away));
        vec2 across = along * (found * width.x + width.y), nearer = eye.x - found * eye.y;
        vec2 toward = across * slice.skew + nearer;
        vec2 across_squared = across * across, squared = fma(toward, toward, across_squared);
        vec2 inverse = inversesqrt(squared), inside = radius - squared * inverse;
        // The surface between two samples counts as far as it lies in the sphere.
        vec2 part = room / (room - min(inside, 0.0));
        vec2 top = i == 0 ? toward : height + part * (toward - height);
        vec2 cosine = top * (i == 0 ? inverse : max(inverse, per_radius));
        vec2 bottom = top - thickness, back = bottom * inversesqrt(fma(bottom, bottom, across_squared));
        uvec2 bits = (one << uvec2(ssao_sector(cosine, scale, bend))) - (one << uvec2(ssao_sector(back, scale, bend)));
        vec2 over = across * (slice.sideways + slice.skew * slice.facing) + nearer * slice.facing;
        vec2 stays = i == 0 ? inside : part;
        vec3 low = vec3(i == 0 ? -leave * radius : least, slice.bias, 0.0);
        bvec3 ahead = greaterThan(vec3(stays.x, over.x, found.x), low);
        bvec3 behind = greaterThan(vec3(stays.y, over.y, found.y), low);
        mask |= uvec2(all(ahead) ? bits.x : 0u, all(behind) ? bits.y : 0u);
        room = max(inside, 1e-6);
        height = toward;
    }
    return vec2(bitCount(mask));
}

// Over what the open surface would see by the same directions: few of them do not add up to one.
float ssao_horizons(SsaoPoint point, int samples) {
    // ssao_slices() in ssao.cpp.
    int slices = clamp(int(sqrt(float(samples) * 0.25) + 0.5), 1, 4), steps = max(samples / (2 * slices), 1);
    int offset = floatBitsToInt(custom[6].w);
    ivec2 tile = (point.texel + ivec2(offset & 3, offset >> 2)) & 3;
    vec2 angle = load(ssao_turns, tile + ivec2(0, 4 * slices)).xy;
    float share = float((tile.y - tile.x) & 3) * 0.25 + 0.125;
    vec2 ray = vec2(point.texel) * custom[0].xy + custom[0].zw;
    float squared = dot(ray, ray) + 1.0, inverse = inversesqrt(squared);
    vec2 eye = vec2(point.planar, 1.0) * (squared * inverse);
    vec3 view = vec3(-ray, 1.0) * inverse;
    // Two directions across the view vector (Tom Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
    float a = 1.0 / (1.0 + view.z), b = -view.x * view.y * a;
    vec3 right = vec3(1.0 - view.x * view.x * a, b, -view.x);
    vec3 up = vec3(b, 1.0 - view.y * view.y * a, -view.y);
    // How wide a texel is at another distance: linear in it, and 1 here.
    float per_w = 1.0 / (custom[3].w - custom[3].z * point.planar);
    vec2 width = vec2(-custom[3].z, custom[3].w) * per_w;
    vec2 flat_motion = custom[2].xy * per_w;
    vec2 deep_motion = (custom[2].zw - (vec2(point.texel) + 0.5 - custom[4].xy) * custom[3].z) * per_w;
    float facing = max(dot(point.normal, view), 0.0), occluded = 0.0, open = 0.0;
    // From one slice to the next, by half a turn over 1, 2, 3 or 4.
    vec2 turn = slices == 2 ? vec2(0.0, 1.0) : slices == 3 ? vec2(0.5, 0.866025404) : vec2(0.707106781);
    [[unroll]] for (int i = 0; i < slices; ++i) {
        vec3 across = right * angle.x + up * angle.y;
        angle = vec2(angle.x * turn.x - angle.y * turn.y, angle.x * turn.y + angle.y * turn.x);
        SsaoSlice slice;
        slice.texels = flat_motion * across.xy + deep_motion * across.z;
        float texel = 1.0 / max(max(abs(slice.texels.x), abs(slice.texels.y)), 1e-10);
        // From the next texel to the radius.
        slice.stride = max(custom[5].x - texel, 0.0) * (1.0 / float(steps));
        slice.first = texel + slice.stride * share;
        slice.skew = across.z * (squared * inverse) * vec2(-1.0, 1.0);
        float sideways = dot(point.normal, across);
        float in_slice = max(facing * facing + sideways * sideways, 1e-12), per_length = inversesqrt(in_slice);
        slice.facing = facing * per_length;
        slice.sideways = sideways * per_length * vec2(1.0, -1.0);
        // What is lower than a texel is wide is not seen by texels.
        slice.bias = max(custom[5].z, texel) * per_length;
        // Equation 7 from the plane to the view vector on both sides: cos n + (n +- pi / 2) sin n, within 0.01.
        vec2 sine = slice.sideways * slice.sideways;
        vec2 full = (1.0 + sine * (0.5 + 0.0707963 * sine) + slice.sideways * 1.57079633) * (in_slice * per_length);
        occluded += dot(full, ssao_occluded(point, slice, width, eye, steps));
        open += full.x + full.y;
    }
    return 1.0 - occluded / max(open * float(ssao_sectors), 1e-6);
}
#include "ssao.glsl"

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
