// SPDX-License-Identifier: MIT
#pragma once
// The interface lags behind the head that wears it: turning and jumping push it, and two critically damped springs pull
// it back. The host steps it once a frame and hands the offset to the effect that composes the interface. No part of a
// stack, and nothing of Vulkan: it may as well move a model of hands.

#include <darkroom/param.hpp>
#include <optional>

namespace darkroom {

class HudInertia {
  public:
    // Rates in 1/s, and what a push adds to the velocity: of a jump, in picture heights per second, and of turning, in
    // picture widths per second and degree.
    static constexpr double jump_rate = 18, turn_rate = 14, jump_push = -0.2, turn_push = -0.002;
    static constexpr double longest_step = 0.1;  ///< seconds; a longer frame moves no more than this
    /// Seconds without a push and below 1e-4 of the picture and 1e-3 of it a second, after which the springs rest.
    static constexpr double rest_after = 0.1;

    /// Pushes, then moves by `delta_time` seconds: the exact solution, so frames of any length give the same curve.
    /// `yaw`: of the view, in degrees, from any origin; the shorter way round counts. `velocity_z`: of the player,
    /// upward positive: leaving the ground with one is a jump. Frames without time change nothing, and numbers that are
    /// not finite count as unknown. Returns the offset in uv.
    Vec2 step(double delta_time, double yaw, bool is_on_ground, double velocity_z);
    [[nodiscard]] Vec2 offset() const { return {static_cast<float>(x_.position), static_cast<float>(y_.position)}; }
    /// At rest, and without a frame before: on loading, and when the player is put elsewhere.
    void reset() { *this = {}; }

  private:
    struct Spring {
        double position = 0, velocity = 0;
        double slight_seconds = 0;  ///< for how long it has been too slight to be seen
        void move(double delta_time, double rate);
        void push(double by);
    };
    Spring x_, y_;
    std::optional<double> yaw_;
    bool was_on_ground_ = false;
};

}  // namespace darkroom
