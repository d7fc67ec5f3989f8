// SPDX-License-Identifier: MIT
#include "camera_rig.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace scene = darkroom::scene;
using darkroom::window::Window;

namespace {

constexpr float degrees_a_pixel = 0.15F, degrees_a_height = 180;
constexpr float fast = 4;

float axis(const Window& window, int forth, int back) {
    return (window.is_held(forth) ? 1.0F : 0.0F) - (window.is_held(back) ? 1.0F : 0.0F);
}

}  // namespace

scene::FreeCamera& CameraRig::taken(const scene::Snapshot& seen) {
    if (!camera_) camera_ = scene::free_camera(seen.camera);
    return *camera_;
}

void CameraRig::reset() {
    camera_.reset();
    walk_.reset();
    head_ = {};
}

void CameraRig::frame_all(const scene::Snapshot& seen, float aspect) {
    scene::frame_all(taken(seen), scene::scene_bounds(seen), aspect);
}

void CameraRig::turn(float yaw, const scene::Snapshot& seen) { scene::orbit(taken(seen), yaw, 0); }

void CameraRig::move(const Window& window, const Input& input, const scene::Snapshot& seen) {
    const auto [x, y] = window.mouse_moved();
    const auto height = static_cast<float>(std::max(input.picture.height, 1U));
    const float right = static_cast<float>(x), down = static_cast<float>(y);
    head_.delta_time = input.delta_time;
    if (camera_) head_.yaw = static_cast<double>(camera_->yaw);
    const auto look = [&] {
        if (right != 0 || down != 0) scene::look_around(taken(seen), -degrees_a_pixel * right, degrees_a_pixel * down);
    };
    if (kind_ == Kind::Walk) {
        if (window.is_cursor_captured()) look();
    } else if (input.has_mouse) {
        if (window.is_button_down(GLFW_MOUSE_BUTTON_RIGHT))
            look();
        else if (window.is_button_down(GLFW_MOUSE_BUTTON_MIDDLE) && (x != 0 || y != 0))
            scene::pan(taken(seen), {right / height, down / height});
        else if (window.is_button_down(GLFW_MOUSE_BUTTON_LEFT) && (x != 0 || y != 0))
            kind_ == Kind::Orbit
                ? scene::orbit(taken(seen), -degrees_a_height * right / height, degrees_a_height * down / height)
                : look();
        if (window.wheel() != 0) scene::dolly(taken(seen), std::pow(0.9F, static_cast<float>(window.wheel())));
    }
    kind_ == Kind::Walk ? walk(window, input, seen) : fly(window, input, seen);
}

// The first step takes the scene's camera over; from then on whoever has it has weight.
void CameraRig::walk(const Window& window, const Input& input, const scene::Snapshot& seen) {
    if (input.ground == nullptr) return fly(window, input, seen);
    scene::WalkInput step;
    if (input.has_keys)
        step = {.move = {axis(window, GLFW_KEY_D, GLFW_KEY_A), axis(window, GLFW_KEY_W, GLFW_KEY_S)},
                .is_running = window.is_down(GLFW_KEY_LEFT_SHIFT) || window.is_down(GLFW_KEY_RIGHT_SHIFT),
                .jumps = window.is_held(GLFW_KEY_SPACE)};
    if (!walk_ && step.move.x == 0 && step.move.y == 0 && !step.jumps) return;
    scene::FreeCamera& camera = taken(seen);
    if (!walk_) walk_ = scene::stand(*input.ground, camera.eye);
    step.yaw = camera.yaw;
    scene::advance(*walk_, *input.ground, step, static_cast<float>(input.delta_time));
    camera.eye = walk_->eye();
    head_.is_on_ground = walk_->is_on_ground;
    head_.velocity_up = static_cast<double>(walk_->velocity.y);
}

void CameraRig::fly(const Window& window, const Input& input, const scene::Snapshot& seen) {
    const float forward = axis(window, GLFW_KEY_W, GLFW_KEY_S), right = axis(window, GLFW_KEY_D, GLFW_KEY_A);
    const float up = axis(window, GLFW_KEY_E, GLFW_KEY_Q);
    if (!input.has_keys || (forward == 0 && right == 0 && up == 0)) return;
    const bool is_fast = window.is_down(GLFW_KEY_LEFT_SHIFT) || window.is_down(GLFW_KEY_RIGHT_SHIFT);
    scene::FreeCamera& camera = taken(seen);
    const float size = std::clamp(scene::radius_of(scene::scene_bounds(seen)) * 0.25F, 0.5F, 50.0F);
    const float step = size * (is_fast ? fast : 1) * static_cast<float>(input.delta_time);
    scene::fly(camera, {right * step, up * step, forward * step});
}

scene::OrbitOverride CameraRig::orbit(const scene::Snapshot& seen) const {
    return camera_ ? scene::override_of(*camera_, scene::scene_bounds(seen)) : own_;
}

}  // namespace app
