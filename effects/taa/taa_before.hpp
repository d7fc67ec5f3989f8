// SPDX-License-Identifier: MIT
#pragma once
// Where a world that stands still was before the camera a moment ago.

#include <array>
#include <cstddef>
#include <darkroom/frame.hpp>

namespace darkroom {

/// Row of the third coordinate: view space now to that of a moment ago, for a world that stands still.
struct TaaDepthBefore {
    std::array<double, 4> row{};
};
/// Rows of x, y (down) and w: view space now to the clip space of a moment ago.
struct TaaMotion {
    explicit TaaMotion(const Camera& camera);
    std::array<std::array<double, 4>, 3> rows{};
};

namespace taa {

using Row = std::array<double, 4>;

inline Row row_of(const Matrix& matrix, std::size_t row) {
    return {matrix[row], matrix[4 + row], matrix[8 + row], matrix[12 + row]};
}

/// `row` behind the way back from view space, which turns and moves.
inline Row behind_inverse(const Row& row, const Matrix& view) {
    Row out{0, 0, 0, row[3]};
    for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t k = 0; k < 3; ++k) out[j] += row[k] * double{view[k * 4 + j]};
        out[3] -= out[j] * double{view[12 + j]};
    }
    return out;
}

inline Row product(const Row& row, const Matrix& matrix) {
    Row out{};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) out[j] += row[k] * double{matrix[j * 4 + k]};
    return out;
}

}  // namespace taa

inline TaaDepthBefore taa_depth_before(const Camera& camera) {
    return {taa::behind_inverse(taa::row_of(camera.previous_view, 2), camera.view)};
}

inline TaaMotion::TaaMotion(const Camera& camera) {
    constexpr std::array<std::size_t, 3> of_clip{0, 1, 3};
    for (std::size_t i = 0; i < 3; ++i)
        rows[i] = taa::behind_inverse(
            taa::product(taa::row_of(camera.previous_projection, of_clip[i]), camera.previous_view), camera.view);
    if (!camera.is_y_down)
        for (double& number : rows[1]) number = -number;
}

}  // namespace darkroom
