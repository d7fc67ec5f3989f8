// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <darkroom/hud_inertia.hpp>

namespace darkroom {

// x'' = -w^2 x - 2 w x' from x, v is x(t) = (x + (v + w x) t) exp(-w t).
void HudInertia::Spring::move(double delta_time, double rate) {
    const double decay = std::exp(-rate * delta_time);
    const double slope = velocity + rate * position;
    position = (position + slope * delta_time) * decay;
    velocity = (velocity - slope * rate * delta_time) * decay;
    // What is left is less than a pixel, and nothing pushes: let the picture stand still.
    const bool is_slight = std::abs(position) < 1e-4 && std::abs(velocity) < 1e-3;
    slight_seconds = is_slight ? slight_seconds + delta_time : 0;
    if (slight_seconds >= rest_after) *this = {};
}

void HudInertia::Spring::push(double by) {
    velocity += by;
    if (by != 0) slight_seconds = 0;
}

Vec2 HudInertia::step(double delta_time, double yaw, bool is_on_ground, double velocity_z) {
    if (!(delta_time > 0)) return offset();
    const double seconds = std::min(delta_time, longest_step);
    if (was_on_ground_ && !is_on_ground && velocity_z > 0) y_.velocity = jump_push;
    was_on_ground_ = is_on_ground;
    if (std::isfinite(yaw)) {
        const double wrapped = std::remainder(yaw, 360.0);
        if (yaw_) x_.push(turn_push * std::remainder(wrapped - *yaw_, 360.0));
        yaw_ = wrapped;
    }
    x_.move(seconds, turn_rate);
    y_.move(seconds, jump_rate);
    return offset();
}

}  // namespace darkroom
