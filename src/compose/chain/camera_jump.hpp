// SPDX-License-Identifier: MIT
#pragma once
// A camera that is somewhere else from one frame to the next: a cut that nobody told of. What was drawn from the one
// place has nothing to do with what is drawn from the other.

#include <darkroom/frame.hpp>

namespace darkroom::compose {

/// Metres: 720 m/s at 24 frames a second.
inline constexpr double camera_jump_distance = 30;
/// Of the matrix that turns by 60 degrees, 1 + 2 cos(60 degrees): usual fields of view share little more than a corner.
inline constexpr double camera_jump_trace = 2;

/// Did a camera move by more than 30 m, or turn by more than 60 degrees about any axis? Matrices from world to camera
/// that turn and move alone. What is no number is a jump.
[[nodiscard]] inline bool is_camera_jump(const Matrix& before, const Matrix& now) {
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
    return !(trace >= camera_jump_trace && square <= camera_jump_distance * camera_jump_distance);
}

}  // namespace darkroom::compose
