// SPDX-License-Identifier: MIT
#pragma once
// camera.glsl in double precision, from the matrices themselves.

#include <array>
#include <darkroom/frame.hpp>

namespace darkroom {

using Double3 = std::array<double, 3>;

struct ReferenceCamera {
    explicit ReferenceCamera(const Camera& camera) : camera_(camera) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t row = 0; row < 3; ++row)
                eye[axis] -= double{camera.view[axis * 4 + row]} * double{camera.view[12 + row]};
    }

    /// The point that is `planar` metres away along the view axis, behind this place of the picture.
    [[nodiscard]] Double3 view_position(double u, double v, double planar) const {
        const auto p = [&](std::size_t column, std::size_t row) {
            return double{camera_.projection[column * 4 + row]};
        };
        const double x = u * 2 - 1, y = (v * 2 - 1) * (camera_.is_y_down ? 1 : -1), z = -planar;
        const double w = p(2, 3) * z + p(3, 3);
        return {(x * w - p(2, 0) * z - p(3, 0)) / p(0, 0), (y * w - p(2, 1) * z - p(3, 1)) / p(1, 1), z};
    }

    /// Where a point of view space is in the picture, as u and v.
    [[nodiscard]] std::array<double, 2> uv(const Double3& view) const {
        const auto p = [&](std::size_t column, std::size_t row) {
            return double{camera_.projection[column * 4 + row]};
        };
        const double w = p(2, 3) * view[2] + p(3, 3);
        const double x = (p(0, 0) * view[0] + p(2, 0) * view[2] + p(3, 0)) / w;
        const double y = (p(1, 1) * view[1] + p(2, 1) * view[2] + p(3, 1)) / w;
        return {x * 0.5 + 0.5, (camera_.is_y_down ? y : -y) * 0.5 + 0.5};
    }

    [[nodiscard]] Double3 world_direction(const Double3& view) const {
        Double3 out{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t row = 0; row < 3; ++row) out[axis] += double{camera_.view[axis * 4 + row]} * view[row];
        return out;
    }
    [[nodiscard]] Double3 view_direction(const Double3& world) const {
        Double3 out{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t row = 0; row < 3; ++row) out[row] += double{camera_.view[axis * 4 + row]} * world[axis];
        return out;
    }

    Double3 eye{};  ///< world space

  private:
    const Camera& camera_;
};

}  // namespace darkroom
