// SPDX-License-Identifier: MIT
#pragma once
// The camera of a viewer: the scene's own until a hand moves it, then one that orbits, flies or walks.

#include <darkroom/hud_inertia.hpp>
#include <optional>

#include "scene/walk/free_camera.hpp"
#include "scene/walk/walk.hpp"
#include "viewer/source/live_interface.hpp"
#include "window/window.hpp"

namespace app {

class CameraRig {
  public:
    enum class Kind : std::uint8_t { Orbit, Fly, Walk };
    /// `own`: what the flags say on top of the scene's camera.
    CameraRig(Kind kind, darkroom::scene::OrbitOverride own) : kind_(kind), own_(own) {}

    struct Input {
        double delta_time = 0;
        VkExtent2D picture{};
        bool has_keys = false, has_mouse = false;         ///< are they the camera's, and not a panel's?
        const darkroom::scene::Ground* ground = nullptr;  ///< for Kind::Walk
    };
    /// Moves it by what happened in the window. `seen`: the snapshot of the frame before.
    void move(const darkroom::window::Window& window, const Input& input, const darkroom::scene::Snapshot& seen);
    /// Turns around the target, as nobody touches it. Degrees.
    void turn(float yaw, const darkroom::scene::Snapshot& seen);
    /// Back to the scene's own.
    void reset();
    void frame_all(const darkroom::scene::Snapshot& seen, float aspect);
    void set_kind(Kind kind) { kind_ = kind; }
    [[nodiscard]] Kind kind() const { return kind_; }

    /// For the next frame, and for the one before it.
    [[nodiscard]] darkroom::scene::OrbitOverride orbit(const darkroom::scene::Snapshot& seen) const;
    [[nodiscard]] HeadMotion head() const { return head_; }
    /// Does it move although nobody touches it?
    [[nodiscard]] bool is_falling() const { return walk_ && !walk_->is_on_ground; }

  private:
    /// The camera as it is, taken over from the scene's where that one was used so far.
    darkroom::scene::FreeCamera& taken(const darkroom::scene::Snapshot& seen);
    void fly(const darkroom::window::Window& window, const Input& input, const darkroom::scene::Snapshot& seen);
    void walk(const darkroom::window::Window& window, const Input& input, const darkroom::scene::Snapshot& seen);

    Kind kind_;
    darkroom::scene::OrbitOverride own_;
    std::optional<darkroom::scene::FreeCamera> camera_;
    std::optional<darkroom::scene::Walk> walk_;
    HeadMotion head_;
};

}  // namespace app
