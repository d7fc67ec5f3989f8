// Shadows: how much of a light's light arrives. Directional lights go by their number among the shadow maps, lamps
// (point and spot lights) by their tiles, which are of one image. Four gathers a map cover the 4x4 texels of a cubic B-spline.
#include "frame.glsl"

/// How many shadow maps there are, 0: not known. The others then cost nothing, which branches alone do not achieve on
/// every driver.
layout(constant_id = 8) const uint shadow_lights = 0u;
/// Whether penumbras widen with the distance of what casts them.
layout(constant_id = 9) const bool shadows_are_soft = false;
/// Whether point and spot lights have tiles.
layout(constant_id = 12) const bool lamps_cast_shadows = false;
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

// Half of the sun's angular diameter of 0.53 degrees, as a tangent: what a penumbra grows to either side by distance; as
// render/shadow/cascades.hpp has it.
const float sun_tangent = 0.004625;
const float max_reach = 8.0;                        // texels that a penumbra reaches to either side
const float min_reach = 0.75, soft_reach = 1.5;  // the 4x4 texels alone; the disc alone
// Of a lamp, whose bulb has this radius, metres: a penumbra reaches so many texels, which its tile's border has room for.
const float bulb_radius = 0.05, max_lamp_reach = 6.0;
// In a corner of a room the other wall lies before a lamp's receiver, but not as steeply as this many texels a texel beside
// it: it casts nothing into the corner. The same is lost of what stands on a floor, next to where it stands.
const float lamp_cone = 4.0;
// Its tile's depth is the first less the second over the distance, as render/shadow/lamps.cpp has it.
const float lamp_depth_end = 1.0 / (1.0 - 0.005);
// What hides the steps of texels, to either side, and how it grows a texel of distance.
const float steps_reach = 2.5, steps_growth = 0.015;
// Vogel, "A better way to construct the sunflower head", 1979: even over a disc for any number of taps. The same ones
// everywhere and always: no noise, which only accumulation over frames would hide.
const uint disc_taps = 24u;
const vec2 disc[disc_taps] = vec2[](
    vec2(0.1443, 0.0000), vec2(-0.1843, 0.1689), vec2(0.0282, -0.3215), vec2(0.2324, 0.3031), vec2(-0.4264, -0.0754),
    vec2(0.4039, -0.2569), vec2(-0.1351, 0.5026), vec2(-0.2577, -0.4961), vec2(0.5590, 0.2041),
    vec2(-0.5816, 0.2401), vec2(0.2803, -0.5991), vec2(0.2072, 0.6605), vec2(-0.6244, -0.3619),
    vec2(0.7325, -0.1610), vec2(-0.4470, 0.6359), vec2(-0.1033, -0.7970), vec2(0.6340, 0.5343),
    vec2(-0.8532, 0.0353), vec2(0.6223, -0.6193), vec2(-0.0416, 0.9004), vec2(-0.5922, -0.7096),
    vec2(0.9380, 0.1262), vec2(-0.7948, 0.5530), vec2(0.2172, -0.9654));

vec4 gather_shadow(uint light, vec3 place) {
    if (shadow_map_count > 1u && light == 1u) return textureGather(shadow_maps[1], place);
    if (shadow_map_count > 2u && light == 2u) return textureGather(shadow_maps[2], place);
    if (shadow_map_count > 3u && light == 3u) return textureGather(shadow_maps[3], place);
    return textureGather(shadow_maps[0], place);
}

float tap_shadow(uint light, vec3 place) {
    if (shadow_map_count > 1u && light == 1u) return textureLod(shadow_maps[1], place, 0.0).r;
    if (shadow_map_count > 2u && light == 2u) return textureLod(shadow_maps[2], place, 0.0).r;
    if (shadow_map_count > 3u && light == 3u) return textureLod(shadow_maps[3], place, 0.0).r;
    return textureLod(shadow_maps[0], place, 0.0).r;
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

/// A point as its cascade or its tile has it.
struct Receiver {
    bool is_in_tile;
    uint light, cascade;
    vec2 place;   // texels
    float depth;  // 0 .. 1
    vec2 slope;   // of depth, a texel, along the surface
    float texel;  // world
    float range;  // world, of depth 0 .. 1
    float cone;   // of depth: what casts lies before it by as much a texel beside it; lamp_cone, nothing in a cascade
};

/// By how many texels a receiver is moved; `sine` of the angle between its normal and the map's axis.
vec3 texels_off(vec3 normal, float sine, vec3 toward_light) {
    return normal * (normal_offset * sine) + toward_light * light_offset;
}

Receiver receive(uint light, uint cascade, vec3 world_position, vec3 normal) {
    const mat4 world_to_cascade = shadows.world_to_map[4u * light + cascade];
    const float texel = shadows.cascade_texels[light][cascade];
    const float resolution = shadows.shadow_settings.y;
    const vec3 depth_row = vec3(world_to_cascade[0].z, world_to_cascade[1].z, world_to_cascade[2].z);
    const float range = inversesqrt(dot(depth_row, depth_row));
    const float half_extent = 0.5 * texel * resolution;
    const vec3 turned = mat3(world_to_cascade) * normal * vec3(half_extent, half_extent, -range);
    const float sine = sqrt(max(1.0 - turned.z * turned.z, 0.0));
    const vec3 offset = texels_off(normal, sine, depth_row * -range);
    const vec3 position = (world_to_cascade * vec4(world_position + offset * texel, 1)).xyz;
    return Receiver(false, light, cascade, (position.xy * 0.5 + 0.5) * resolution, min(position.z, 1.0),
                    turned.xy * (texel / (range * max(turned.z, 0.05))), texel, range, 0.0);
}

/// As a lamp's tile has it. Texels grow along the tile's axis, and a plane is one in the tile's depth too, so that what
/// moves a receiver off its own surface is as much as for a cascade whose texels are those at its place.
Receiver receive_in_tile(uint tile, vec3 world_position, vec3 normal, vec3 toward_lamp) {
    const mat4 world_to_tile = shadows.world_to_map[16u + tile];
    const vec3 across = vec3(world_to_tile[0].x, world_to_tile[1].x, world_to_tile[2].x);
    const vec3 axis = vec3(world_to_tile[0].w, world_to_tile[1].w, world_to_tile[2].w);
    const float side = shadows.tile_settings.x;
    const float along = dot(axis, world_position) + world_to_tile[3].w;
    const float texel = 2.0 * along * inversesqrt(dot(across, across)) / side;
    const float cosine = dot(normal, axis);
    const vec3 depth_row = vec3(world_to_tile[0].z, world_to_tile[1].z, world_to_tile[2].z);
    const vec3 down = vec3(world_to_tile[0].y, world_to_tile[1].y, world_to_tile[2].y);
    // Depth is a constant and a share of this over the distance along the axis.
    const float hyperbola = world_to_tile[3].z - dot(depth_row, axis) * world_to_tile[3].w;
    const float rise = hyperbola * texel * dot(axis, toward_lamp) / (along * along);
    const float steepness = rise / max(dot(normal, toward_lamp), 0.05);
    const vec3 offset = texels_off(normal, sqrt(max(1.0 - cosine * cosine, 0.0)), toward_lamp);
    const vec4 clip = world_to_tile * vec4(world_position + offset * texel, 1);
    const uint tiles_a_row = uint(shadows.tile_settings.y);
    // No further than the filter needs to stay within the tile.
    const vec2 place = clamp((clip.xy / clip.w * 0.5 + 0.5) * side, max_lamp_reach + 2.0, side - max_lamp_reach - 2.0);
    return Receiver(true, 0u, 0u, place + vec2(tile % tiles_a_row, tile / tiles_a_row) * side,
                    min(clip.z / clip.w, 1.0),
                    vec2(dot(normal, across), dot(normal, down)) * (steepness * inversesqrt(dot(across, across))), texel, 0.0,
                    lamp_cone * rise);
}

/// Depths of the four texels that meet at `meeting`, whole texels.
vec4 depths_around(Receiver receiver, vec2 meeting) {
    if (receiver.is_in_tile) return textureGather(shadow_maps[4], vec3(meeting * shadows.tile_settings.zw, 0.0));
    return gather_shadow(receiver.light, vec3(meeting * shadows.shadow_settings.z, float(receiver.cascade)));
}

/// Which of a gather's texels a depth is before, weighed by `u` and `v`. `meeting` is where the texels meet.
float weighed_light(Receiver receiver, vec4 depths, float depth, vec2 meeting, vec2 u, vec2 v) {
    const vec2 first = meeting - 0.5 - receiver.place, last = first + 1.0;
    const vec4 away = sqrt(vec4(first.x, last.x, last.x, first.x) * vec4(first.x, last.x, last.x, first.x) +
                           vec4(last.y, last.y, first.y, first.y) * vec4(last.y, last.y, first.y, first.y));
    const vec4 lit = vec4(greaterThanEqual(depths, depth - receiver.cone * away));
    return dot(lit.wz, u) * v.x + dot(lit.xy, u) * v.y;
}

/// Percentage-closer filtering (Reeves et al., "Rendering Antialiased Shadows with Depth Maps", 1987) of 4x4 texels by a
/// cubic B-spline, which is smooth where a box shows the texels' steps. All are compared with one depth: following the
/// receiver's plane toward the light would lead through a thin ceiling.
float filter_texels(Receiver receiver) {
    const vec2 corner = floor(receiver.place - 0.5);
    const vec2 f = receiver.place - 0.5 - corner;
    const vec4 across = spline_weights(f.x), down = spline_weights(f.y);
    float sum = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const vec2 side = vec2(i & 1u, i >> 1u);
        const vec2 u = side.x > 0.0 ? across.zw : across.xy, v = side.y > 0.0 ? down.zw : down.xy;
        const vec2 meeting = corner + side * 2.0;
        sum += weighed_light(receiver, depths_around(receiver, meeting), receiver.depth, meeting, u, v);
    }
    return clamp((sum - dark_share) * (1.0 / (lit_share - dark_share)), 0.0, 1.0);
}

/// How far the penumbra of what lies at a depth reaches to either side here, texels.
float penumbra_of(Receiver receiver, float blocker) {
    // The blocker's distance is to the receiver's as the other way round what is left of the depth's end.
    if (receiver.is_in_tile)
        return ((lamp_depth_end - blocker) / (lamp_depth_end - receiver.depth) - 1.0) * bulb_radius / receiver.texel;
    return (receiver.depth - blocker) * receiver.range * sun_tangent / receiver.texel;
}

/// Of a grid of 4x4, its corners first.
vec2 search_place(uint i) { return vec2(((i & 1u) * 3u) ^ (i >> 2u & 1u), ((i >> 1u & 1u) * 3u) ^ (i >> 3u)); }

/// Fernando, "Percentage-Closer Soft Shadows", 2005: the mean depth of what blocks the light says how wide the penumbra
/// is. Where it is wider than the filter of 4x4 texels, a disc of bilinear taps takes that one's place.
float soften(Receiver receiver, float visibility) {
    const float most = receiver.is_in_tile ? max_lamp_reach : max_reach;
    // Nothing that casts lies before depth 0.
    const float reach = min(penumbra_of(receiver, 0.0), most);
    vec2 blocked = vec2(0.0);  // how many, and the sum of their distances
    float nearest = 1.0;
    // Loops in place of branches, as below. The four corners come first: where they and the texels in the middle are dark
    // all over, what lies between is taken to be so, too.
    uint looked = 0u;
    for (uint end = reach > min_reach ? 16u : 0u; looked < end;) {
        const vec2 offset = (search_place(looked) - 1.5) * (reach * (2.0 / 3.0));
        const float plane = receiver.depth + min(dot(receiver.slope, offset), 0.0) - dot(abs(receiver.slope), vec2(1)) -
                            receiver.cone * length(offset);
        const vec4 depths = depths_around(receiver, floor(receiver.place + offset + 0.5));
        const vec4 blocks = vec4(lessThan(depths, vec4(plane)));
        const vec4 distances = receiver.depth - depths;
        blocked += vec2(dot(blocks, vec4(1)), dot(blocks, distances));
        const vec4 near = mix(vec4(1), distances, blocks);
        nearest = min(nearest, min(min(near.x, near.y), min(near.z, near.w)));
        ++looked;
        end = looked == 4u && visibility <= 0.0 && blocked.x > 15.5 ? 4u : end;
    }
    const float distance = blocked.y / max(blocked.x, 1.0);
    const float penumbra = min(penumbra_of(receiver, receiver.depth - distance), most);
    // What blocks from afar shows the map's steps where a penumbra is narrower, and in a tile everything that is seen
    // obliquely; as above, a share of what is wider than the light's does not light.
    const float steps = receiver.is_in_tile ? sign(blocked.x) * steps_reach : distance * receiver.range / receiver.texel * steps_growth;
    const float radius = max(penumbra, min(steps, steps_reach));
    const float narrow = 1.0 - penumbra / max(radius, 1e-6);
    const float dark = dark_share * narrow;
    // Walls that meet darken each other by a part of the disc.
    const float bright = receiver.is_in_tile ? mix(1.0, lit_share, narrow) : 1.0;
    const bool is_dark = blocked.x > 4.0 * float(looked) - 0.5 && visibility <= 0.0;
    const uint taps = radius > min_reach && !is_dark ? disc_taps : 0u;
    float sum = 0.0;
    for (uint i = 0u; i < taps; ++i) {
        const vec2 offset = disc[i] * radius;
        // Along the receiver's plane, but not as far as to what blocks.
        const float rise = clamp(dot(receiver.slope, offset), -0.5 * nearest, 0.0);
        const vec2 place = receiver.place + offset - 0.5;
        const vec2 f = fract(place);
        const vec2 meeting = floor(place) + 1.0;
        sum += weighed_light(receiver, depths_around(receiver, meeting), receiver.depth + rise, meeting,
                             vec2(1.0 - f.x, f.x), vec2(1.0 - f.y, f.y));
    }
    const float share = taps > 0u ? smoothstep(min_reach, soft_reach, radius) : 0.0;
    const float lit = clamp((sum * (1.0 / float(disc_taps)) - dark) / (bright - dark), 0.0, 1.0);
    return mix(visibility, lit, share);
}

float filter_cascade(uint light, uint cascade, vec3 world_position, vec3 normal) {
    const Receiver receiver = receive(light, cascade, world_position, normal);
    const float visibility = filter_texels(receiver);
    return shadows_are_soft ? soften(receiver, visibility) : visibility;
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
    const mat4 world_to_cascade = shadows.world_to_map[4u * light + cascade];
    vec3 position = (world_to_cascade * vec4(world_position, 1)).xyz;
    const vec3 depth_row = vec3(world_to_cascade[0].z, world_to_cascade[1].z, world_to_cascade[2].z);
    position.z -= light_offset * shadows.cascade_texels[light][cascade] * sqrt(dot(depth_row, depth_row));
    const float lit = tap_shadow(light, vec3(position.xy * 0.5 + 0.5, float(cascade))) >= min(position.z, 1.0) ? 1.0 : 0.0;
    return 1.0 - shadow_presence(view_distance) * (1.0 - lit);
}

/// Which face of a cube around a lamp a direction from it leads through, as render/shadow/lamps.cpp numbers them.
uint face_of(vec3 from_lamp) {
    const vec3 size = abs(from_lamp);
    const uint axis = size.x >= size.y && size.x >= size.z ? 0u : size.y >= size.z ? 1u : 2u;
    return 2u * axis + (from_lamp[axis] < 0.0 ? 1u : 0u);
}

/// Filtered, for surfaces, by the first of a lamp's tiles and their number, 1 or 6. `toward_lamp`: normalised.
float lamp_visibility(uint first_tile, uint tiles, vec3 world_position, vec3 world_normal, vec3 toward_lamp) {
    const uint tile = first_tile + (tiles > 1u ? face_of(-toward_lamp) : 0u);
    const Receiver receiver = receive_in_tile(tile, world_position, world_normal, toward_lamp);
    const float visibility = filter_texels(receiver);
    return shadows_are_soft ? soften(receiver, visibility) : visibility;
}
