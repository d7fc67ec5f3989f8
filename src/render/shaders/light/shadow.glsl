// Shadows of directional lights: how much of light `light`'s light arrives, by its number among the shadow maps. Four
// gathers a cascade cover the 4x4 texels of a cubic B-spline.
#include "frame.glsl"

/// How many shadow maps there are, 0: not known. The others then cost nothing, which branches alone do not achieve on
/// every driver.
layout(constant_id = 8) const uint shadow_lights = 0u;
const uint shadow_map_count = shadow_lights == 0u ? 4u : shadow_lights;

const float cascade_blend = 0.1;  // as render/shadow/cascades.hpp has it
const float shadow_fade = 0.25;   // last part of the shadow distance
// A receiver is moved along its normal by this many texels where light grazes it, and toward the light by some always:
// lengths in the world, whatever the range of depth. The rest of a slope is left to what follows, and to the rasteriser's
// quarter of a texel. Moving along the normal leads away from the walls that meet a floor, so that they stay closed.
const float normal_offset = 0.82;
const float light_offset = 0.25;
// Of the kernel's weight: less is dark, more is lit. A wall of one texel covers two thirds of it at the least, where it
// meets another one; beyond the upper share lie the corners of the kernel, which a sloped plane may darken itself.
const float dark_share = 0.32, lit_share = 0.82;

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

/// Weights of the four texels of a cubic B-spline, `f` behind the second.
vec4 spline_weights(float f) {
    const float g = 1.0 - f;
    return vec4(g * g * g, (3.0 * f - 6.0) * f * f + 4.0, (3.0 * g - 6.0) * g * g + 4.0, f * f * f) * (1.0 / 6.0);
}

/// Percentage-closer filtering (Reeves et al., "Rendering Antialiased Shadows with Depth Maps", 1987) of 4x4 texels by a
/// cubic B-spline, which is smooth where a box shows the texels' steps. All are compared with one depth: following the
/// receiver's plane toward the light would lead through a thin ceiling.
float filter_cascade(uint light, uint cascade, vec3 world_position, vec3 normal) {
    const mat4 world_to_cascade = shadows.world_to_cascade[4u * light + cascade];
    const float texel = shadows.cascade_texels[light][cascade];
    const float resolution = shadows.shadow_settings.y;
    const vec3 depth_row = vec3(world_to_cascade[0].z, world_to_cascade[1].z, world_to_cascade[2].z);
    const float range = inversesqrt(dot(depth_row, depth_row));
    const vec3 toward_light = -depth_row * range;
    const float cosine = dot(normal, toward_light);
    const float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    const vec3 offset = normal * (normal_offset * sine) + toward_light * light_offset;

    const vec3 position = (world_to_cascade * vec4(world_position + offset * texel, 1)).xyz;
    const float depth = min(position.z, 1.0);
    const vec2 place = (position.xy * 0.5 + 0.5) * resolution;
    const vec2 corner = floor(place - 0.5);
    const vec4 across = spline_weights(place.x - 0.5 - corner.x), down = spline_weights(place.y - 0.5 - corner.y);
    float sum = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const vec2 side = vec2(i & 1u, i >> 1u);
        const vec2 meeting = corner + side * 2.0;  // of the four texels of a gather
        const vec4 lit = gather_shadow(light, vec3(meeting * shadows.shadow_settings.z, float(cascade)), depth);
        const vec2 u = side.x > 0.0 ? across.zw : across.xy, v = side.y > 0.0 ? down.zw : down.xy;
        sum += dot(lit.wz, u) * v.x + dot(lit.xy, u) * v.y;
    }
    return clamp((sum - dark_share) * (1.0 / (lit_share - dark_share)), 0.0, 1.0);
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

/// One tap, for points in the air; nearer to the light by a quarter of a texel, which what is lit is kept off its own
/// shadow by.
float shadow_visibility_point(uint light, vec3 world_position, float view_distance) {
    light = shadow_map_count > 1u ? light : 0u;
    const uint cascade = cascade_of(light, view_distance);
    const mat4 world_to_cascade = shadows.world_to_cascade[4u * light + cascade];
    vec3 position = (world_to_cascade * vec4(world_position, 1)).xyz;
    const vec3 depth_row = vec3(world_to_cascade[0].z, world_to_cascade[1].z, world_to_cascade[2].z);
    position.z -= light_offset * shadows.cascade_texels[light][cascade] * sqrt(dot(depth_row, depth_row));
    const float lit = tap_shadow(light, vec4(position.xy * 0.5 + 0.5, float(cascade), min(position.z, 1.0)));
    return 1.0 - shadow_presence(view_distance) * (1.0 - lit);
}
