// Shadows of directional lights: how much of light `light`'s light arrives, by its number among the shadow maps. Four
// gathers a cascade cover the 4x4 texels that a 3x3 filter of bilinear taps reaches; every group of 2x2 is compared
// with the receiver's own plane there, so that sloped ground does not shade itself and edges stay where they are.
#include "frame.glsl"

/// How many shadow maps there are, 0: not known. The others then cost nothing, which branches alone do not achieve on
/// every driver.
layout(constant_id = 8) const uint shadow_lights = 0u;
const uint shadow_map_count = shadow_lights == 0u ? 4u : shadow_lights;

const float cascade_blend = 0.1;  // as render/shadow/cascades.hpp has it
const float shadow_fade = 0.25;   // last part of the shadow distance
// The rasteriser's bias of two texels of slope leaves a part of the receiver's slope to this filter. It takes no more,
// and nothing of steep ones: normals that are interpolated over coarse meshes say too much where it matters most.
const float slope_part = 0.75;
const float least_cosine = 0.2;  // of the light to a surface
// Toward the light the plane is followed further: texels of a group lie up to half a texel beyond where they meet, and
// beyond the edge of a face they are its neighbour's, which the rasteriser has not moved by the receiver's slope. More
// would lose what thin casters shade where they stand.
const float light_side = 1.5;
const float plane_margin = 0.5;  // texels that a receiver is moved toward the light

vec4 gather_shadow(uint light, vec3 place, float depth) {
    if (shadow_map_count > 1u && light == 1u) return textureGather(shadow_maps[1], place, depth);
    if (shadow_map_count > 2u && light == 2u) return textureGather(shadow_maps[2], place, depth);
    if (shadow_map_count > 3u && light == 3u) return textureGather(shadow_maps[3], place, depth);
    return textureGather(shadow_maps[0], place, depth);
}

float tap_shadow(uint light, vec4 place) {
    if (shadow_map_count > 1u && light == 1u) return texture(shadow_maps[1], place);
    if (shadow_map_count > 2u && light == 2u) return texture(shadow_maps[2], place);
    if (shadow_map_count > 3u && light == 3u) return texture(shadow_maps[3], place);
    return texture(shadow_maps[0], place);
}

/// The first cascade that reaches as far as this distance along the view axis.
uint cascade_of(uint light, float view_distance) {
    const uint last = uint(shadows.shadow_settings.x) - 1u;
    const vec4 beyond = vec4(greaterThan(vec4(view_distance), shadows.cascade_splits[light]));
    const vec4 counted = vec4(lessThan(uvec4(0, 1, 2, 3), uvec4(last)));
    return uint(dot(beyond, counted));
}

/// How far the cascade's last part, in which it turns into the next, is entered: 0 .. 1.
float cascade_blending(uint light, uint cascade, float view_distance) {
    if (cascade + 1u >= uint(shadows.shadow_settings.x)) return 0.0;
    const float end = shadows.cascade_splits[light][cascade];
    const float begin = cascade == 0u ? frame.planes.x : shadows.cascade_splits[light][cascade - 1u];
    const float band = (end - begin) * cascade_blend;
    // In steps, for the shares of both to add up to 1 exactly.
    return floor(clamp((view_distance - end + band) / band, 0.0, 1.0) * 256.0) * (1.0 / 256.0);
}

/// Shadows end softly, in light.
float shadow_presence(float view_distance) {
    const float end = shadows.shadow_settings.w;
    return clamp((end - view_distance) / (end * shadow_fade), 0.0, 1.0);
}

/// Change of depth from texel to texel along a surface, in sizes of a texel: x right, y down.
vec2 receiver_slope(mat4 world_to_cascade, vec3 normal, float half_extent, float range) {
    const vec3 turned = mat3(world_to_cascade) * normal * vec3(half_extent, half_extent, -range);
    // A surface that faces away is behind its own front.
    return turned.z > 0.0 ? turned.xy * (slope_part / max(turned.z, least_cosine)) : vec2(0);
}

/// 3x3 bilinear taps one texel apart (after Reeves et al., "Rendering Antialiased Shadows with Depth Maps", 1987), with
/// their weights added up a texel: 1 - f, 1, 1, f in both directions.
float filter_cascade(uint light, uint cascade, vec3 world_position, vec3 normal) {
    const mat4 world_to_cascade = shadows.world_to_cascade[4u * light + cascade];
    const float texel = shadows.cascade_texels[light][cascade];
    const float resolution = shadows.shadow_settings.y;
    const vec3 depth_row = vec3(world_to_cascade[0].z, world_to_cascade[1].z, world_to_cascade[2].z);
    const float range = inversesqrt(dot(depth_row, depth_row));
    const vec2 slope = receiver_slope(world_to_cascade, normal, 0.5 * texel * resolution, range);
    const float depth_a_texel = texel / range;

    const vec3 position = (world_to_cascade * vec4(world_position, 1)).xyz;
    const vec2 place = (position.xy * 0.5 + 0.5) * resolution;
    const vec2 corner = floor(place - 0.5);
    // Steps of 1/256 make the weights exact, so that a place among lit texels is lit to the last bit.
    const vec2 f = floor((place - 0.5 - corner) * 256.0) * (1.0 / 256.0);
    float sum = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const vec2 side = vec2(i & 1u, i >> 1u);
        const vec2 meeting = corner + side * 2.0;  // of the four texels of a gather
        const float along = dot(slope, meeting - place);
        const float rise = (along < 0.0 ? light_side * along : along) - plane_margin;
        const float plane = position.z + rise * depth_a_texel;
        const vec3 coordinates = vec3(meeting * shadows.shadow_settings.z, float(cascade));
        const vec4 lit = gather_shadow(light, coordinates, min(plane, 1.0));
        const vec2 first = mix(1.0 - f, vec2(1), side);
        const vec2 second = mix(vec2(1), f, side);
        sum += (lit.w * first.x + lit.z * second.x) * first.y + (lit.x * first.x + lit.y * second.x) * second.y;
    }
    return sum * (1.0 / 9.0);
}

/// Filtered, for surfaces: 0 in shadow .. 1 lit. `light` counts shadow maps and is the same for all invocations of a
/// draw; `world_normal` is the geometry's, normalised; `view_distance` is along the view axis.
float shadow_visibility(uint light, vec3 world_position, vec3 world_normal, float view_distance) {
    light = shadow_map_count > 1u ? light : 0u;
    uint cascade = cascade_of(light, view_distance);
    const float blending = cascade_blending(light, cascade, view_distance);
    const uint end = cascade + (blending > 0.0 ? 2u : 1u);
    float share = 1.0 - blending;
    float visibility = 0.0;
    // A loop, not a branch: software drivers execute both sides of branches, but leave a loop that nobody goes on with.
    do {
        visibility += share * filter_cascade(light, cascade, world_position, world_normal);
        share = blending;
        ++cascade;
    } while (cascade < end);
    return 1.0 - shadow_presence(view_distance) * (1.0 - visibility);
}

/// One tap, for points in the air.
float shadow_visibility_point(uint light, vec3 world_position, float view_distance) {
    light = shadow_map_count > 1u ? light : 0u;
    const uint cascade = cascade_of(light, view_distance);
    const vec3 position = (shadows.world_to_cascade[4u * light + cascade] * vec4(world_position, 1)).xyz;
    const float lit = tap_shadow(light, vec4(position.xy * 0.5 + 0.5, float(cascade), min(position.z, 1.0)));
    return 1.0 - shadow_presence(view_distance) * (1.0 - lit);
}
