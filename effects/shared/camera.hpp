// SPDX-License-Identifier: MIT
#pragma once
// What passes of effects ask of a camera, on the CPU: the functions of camera.glsl. Solved once from the matrices, and
// in double precision, since constants are differences of its points. The references have a camera of their own
// (camera_reference.hpp), so that an error in either shows against the other.

#include <array>
#include <cstddef>
#include <darkroom/frame.hpp>

namespace darkroom {

using Vector3 = std::array<double, 3>;

class SolvedCamera {
  public:
    explicit SolvedCamera(const Camera& camera) {
        const Matrix& p = camera.projection;
        // The picture's v runs down, so where clip space has y up its row changes sign.
        const double down = camera.is_y_down ? 1 : -1;
        const std::array<double, 2> sign{1, down};
        turn_ = p[11];
        one_ = p[15];
        for (std::size_t axis = 0; axis < 2; ++axis) {
            scale_[axis] = double{p[axis * 5]} * sign[axis];
            shear_[axis] = double{p[8 + axis]} * sign[axis];
            offset_[axis] = double{p[12 + axis]} * sign[axis];
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t row = 0; row < 3; ++row) axes_[row][axis] = camera.view[axis * 4 + row];
        }
        // The view matrix turns and moves: the eye is what it takes to the origin.
        const Vector3 moved{-double{camera.view[12]}, -double{camera.view[13]}, -double{camera.view[14]}};
        eye = world_direction(moved);
    }

    /// Do rays part from each other with the distance?
    [[nodiscard]] bool is_perspective() const { return turn_ != 0; }

    /// The point at a planar distance behind this place of the picture, in view space.
    [[nodiscard]] Vector3 view_position(double u, double v, double planar) const {
        const std::array<double, 2> place{u * 2 - 1, v * 2 - 1};
        const double w = one_ - turn_ * planar;
        Vector3 out{0, 0, -planar};
        for (std::size_t axis = 0; axis < 2; ++axis)
            out[axis] = (place[axis] * w + shear_[axis] * planar - offset_[axis]) / scale_[axis];
        return out;
    }

    /// Where a point of view space is in the picture, as u and v.
    [[nodiscard]] std::array<double, 2> uv(const Vector3& view) const {
        const double w = one_ + turn_ * view[2];
        std::array<double, 2> out{};
        for (std::size_t axis = 0; axis < 2; ++axis)
            out[axis] = ((scale_[axis] * view[axis] + shear_[axis] * view[2] + offset_[axis]) / w + 1) / 2;
        return out;
    }

    [[nodiscard]] Vector3 world_direction(const Vector3& view) const {
        Vector3 out{};
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += axes_[row][axis] * view[row];
        return out;
    }
    [[nodiscard]] Vector3 view_direction(const Vector3& world) const {
        Vector3 out{};
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t axis = 0; axis < 3; ++axis) out[row] += axes_[row][axis] * world[axis];
        return out;
    }

    Vector3 eye{};  ///< world space

  private:
    // clip.xy = scale * view.xy + shear * view.z + offset, y down; clip.w = turn * view.z + one.
    std::array<double, 2> scale_{}, shear_{}, offset_{};
    double turn_ = 0, one_ = 1;
    std::array<Vector3, 3> axes_{};  ///< right, up and back of the camera, world space
};

}  // namespace darkroom
