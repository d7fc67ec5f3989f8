// SPDX-License-Identifier: MIT
#pragma once
// A person on foot in a scene: walks, jumps, climbs steps, slides along walls and falls. Not a physics engine: the body
// is a bundle of rays, between which a thin edge may pass, and what moves is passed through.
//
//     Walk walk = stand(ground, camera.eye);
//     advance(walk, ground, {.move = {0, 1}, .yaw = camera.yaw}, seconds);
//     camera.eye = walk.eye();

#include <limits>

#include "scene/walk/ground.hpp"

namespace darkroom::scene {

struct WalkInput {
    vec2 move{0};   ///< right, forward; a length above 1 counts as 1
    float yaw = 0;  ///< degrees, as FreeCamera's
    bool is_running = false;
    bool jumps = false;  ///< from the ground; while it is held, again after landing
};

struct Walk {
    // Metres and seconds.
    static constexpr float eye_height = 1.7F, body_height = 1.8F, body_radius = 0.3F, step_height = 0.45F;
    static constexpr float walking_speed = 3, running_speed = 6, jump_speed = 4.5F, gravity = 9.81F;

    vec3 feet{0};
    vec3 velocity{0};
    bool is_on_ground = true;
    float eye_offset = 0;  ///< what the eye still has to follow of a step, which the feet take at once
    vec3 start{0};         ///< where whoever falls out of the world is put back
    float floor = -std::numeric_limits<float>::infinity();  ///< height of an endless one below everything

    [[nodiscard]] vec3 eye() const { return feet + vec3(0, eye_height + eye_offset, 0); }
};

/// Stands on what is below the eye; where there is nothing, on an endless floor at the lowest point of the scene.
[[nodiscard]] Walk stand(const Ground& ground, vec3 eye);

/// In steps of 1/60 s at most, each exact for constant acceleration: the rate of frames moves nobody by more than 1 cm,
/// but for when the end of a floor is noticed, which is at the end of a step. Of more than 0.25 s the rest is dropped.
void advance(Walk& walk, const Ground& ground, const WalkInput& input, float seconds);

}  // namespace darkroom::scene
