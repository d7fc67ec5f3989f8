// The skybox, or the background colour, where nothing is in front of it. Nothing branches on a uniform: Mesa's lavapipe,
// where that would take half of a shader away, compiles it anew for every draw and keeps them all.
layout(constant_id = 0) const bool has_environment = true;
layout(constant_id = 1) const uint output_mode = 0u;

#include "frame.glsl"
#include "light/environment.glsl"
#include "output.glsl"

layout(location = 0) in vec2 clip_place;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec2 velocity;

/// World direction seen at a place of the picture. Found without the camera's position and the far plane, so that
/// neither costs precision.
vec3 view_direction() {
    vec2 in_view = (clip_place + frame.projection[2].xy) / vec2(frame.projection[0].x, frame.projection[1].y);
    vec3 direction = normalize(transpose(mat3(frame.view)) * vec3(in_view, -1.0));
    return mix(direction, frame.camera_forward.xyz, bvec3(frame.camera_position.w == 0.0));
}

void main() {
    vec3 direction = view_direction();
    vec3 light = frame.background.rgb;
    if (has_environment) {
        light = textureLod(skybox, direction_to_uv(direction), 0.0).rgb * frame.environment_settings.x;
    }
    color = finish(light, 1.0, output_mode, frame.modes.y != 0u);
    normal = vec4(0);
    // What is infinitely far moves as the camera turns, not as it walks.
    velocity = motion(vec4(clip_place, 0.0, 1.0), frame.previous_view_projection * vec4(direction, 0.0));
}
