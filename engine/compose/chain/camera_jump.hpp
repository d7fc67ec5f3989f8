// SPDX-License-Identifier: MIT
#pragma once
// A camera that is somewhere else from one frame to the next: a cut that nobody told of. What was drawn from the one
// place has nothing to do with what is drawn from the other.

#include <algorithm>
#include <cmath>
#include <darkroom/frame.hpp>
#include <limits>
#include <numbers>

namespace darkroom::compose {

/// Did the camera move or turn by more than Camera::jump_distance and jump_angle say, since its view was `before`?
/// Views only turn and move. NaN is a jump.
[[nodiscard]] inline bool is_camera_jump(const Matrix& before, const Camera& camera) {
    const Matrix& now = camera.view;
    double trace = 0, square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double way = 0;  // of the eye, -R^T t
        for (std::size_t row = 0; row < 3; ++row) {
            const double a{before[axis * 4 + row]}, b{now[axis * 4 + row]};
            trace += a * b;
            way += a * double{before[12 + row]} - b * double{now[12 + row]};
        }
        square += way * way;
    }
    // The trace of a matrix that turns by an angle is 1 + 2 cos(angle), so it is -1 at least.
    const double angle = camera.jump_angle;
    const double least_trace =
        angle >= std::numbers::pi ? -std::numeric_limits<double>::infinity() : 1 + 2 * std::cos(std::max(angle, 0.0));
    const double distance = camera.jump_distance;
    return !(trace >= least_trace && square <= distance * distance);
}

}  // namespace darkroom::compose
