// SPDX-License-Identifier: MIT
#pragma once
// A camera that hands move: it looks around and flies, or goes around what lies ahead of it. Both are one state, so
// that changing the way of moving keeps the view. It never rolls, and knows neither keys nor time.
//
//     FreeCamera camera = free_camera(snapshot.camera);
//     orbit(camera, -0.3F * dragged.x, 0.3F * dragged.y);
//     options.previous_orbit = std::exchange(options.orbit, override_of(camera, scene_bounds(snapshot)));

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

struct FreeCamera {
    vec3 eye{0, 0, 15};
    /// Degrees, as OrbitOverride's: at 0, 0 it looks along -z, a growing yaw turns left and a growing pitch down.
    float yaw = 0, pitch = 0;
    float distance = 15;  ///< metres from the eye to the target, [0.001, 1e6]
    Projection kind = Projection::Perspective;
    float field_of_view = 45;  ///< vertical, degrees
    float ortho_height = 10;   ///< of the view, metres; Projection::Orthographic

    [[nodiscard]] vec3 forward() const;
    [[nodiscard]] vec3 right() const;
    [[nodiscard]] vec3 up() const;  ///< of the picture
    [[nodiscard]] vec3 target() const { return eye + distance * forward(); }
};

/// The view of a snapshot; a roll is lost.
[[nodiscard]] FreeCamera free_camera(const CameraState& camera);
/// The camera as SnapshotOptions takes it, without the scene's own say in any of it. The far plane lies beyond
/// `bounds`.
[[nodiscard]] OrbitOverride override_of(const FreeCamera& camera, const Box& bounds = {});

/// Turns in place. Degrees; the pitch stays in [-90, 90].
void look_around(FreeCamera& camera, float yaw, float pitch);
/// The same turn, around the target.
void orbit(FreeCamera& camera, float yaw, float pitch);
/// Moves along with the picture: what is at the target's distance follows a pointer. In heights of the picture, x
/// right, y down.
void pan(FreeCamera& camera, vec2 moved);
/// Scales the distance to the target, which stays; below 1 goes nearer.
void dolly(FreeCamera& camera, float factor);
/// Metres along the camera's right, along y, and along where it looks.
void fly(FreeCamera& camera, vec3 right_up_forward);
/// Brings all of the box into view, with a margin of 10 % around its sphere, and makes its middle the target. An empty
/// one changes nothing. `aspect`: width over height.
void frame_all(FreeCamera& camera, const Box& bounds, float aspect);

/// Of the sphere around a box; 1 where that is a point.
[[nodiscard]] float radius_of(const Box& bounds);
/// The distance from which a sphere fills the smaller of the picture's two angles, with that margin.
[[nodiscard]] float fitting_distance(float radius, float field_of_view, float aspect);

}  // namespace darkroom::scene
