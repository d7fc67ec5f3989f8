// SPDX-License-Identifier: MIT
// From pixels to places. View space: the camera looks along -z, y up. `planar` is the distance along the view axis.
#ifndef shared_camera
#define shared_camera

const float sky_distance = 1e9;

vec3 view_position(vec2 uv, float planar) {
    vec2 place = (uv * frame_ray.xy + frame_ray.zw) * planar;
    if (!rays_meet) place += uv * frame_ray_flat.xy + frame_ray_flat.zw;
    return vec3(place, -planar);
}

/// Where the ray of this place leaves the plane of the eye: the eye itself, unless rays run side by side.
vec3 view_ray_start(vec2 uv) {
    return rays_meet ? vec3(0.0) : vec3(uv * frame_ray_flat.xy + frame_ray_flat.zw, 0.0);
}

/// Where a point of view space is in the picture.
vec2 view_to_uv(vec3 position) {
    float w = frame_projection_offset.w + position.z * frame_projection_offset.z;
    vec2 clip = frame_projection_scale.xy * position.xy + frame_projection_scale.zw * position.z +
                frame_projection_offset.xy;
    return clip / w * 0.5 + 0.5;
}

vec3 world_direction(vec3 view_direction) {
    return vec3(dot(frame_view_to_world_x.xyz, view_direction), dot(frame_view_to_world_y.xyz, view_direction),
                dot(frame_view_to_world_z.xyz, view_direction));
}

vec3 view_direction(vec3 world) {
    return frame_view_to_world_x.xyz * world.x + frame_view_to_world_y.xyz * world.y +
           frame_view_to_world_z.xyz * world.z;
}

vec3 camera_position() {
    return vec3(frame_view_to_world_x.w, frame_view_to_world_y.w, frame_view_to_world_z.w);
}

vec3 world_position(vec2 uv, float planar) { return camera_position() + world_direction(view_position(uv, planar)); }
#endif
