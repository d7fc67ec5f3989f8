// SPDX-License-Identifier: MIT
#include "image/camera/camera_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace darkroom {
namespace {

/// By elimination with pivots. What is lost to rounding is far below the bound that it is held against.
double determinant(const Matrix& matrix) {
    std::array<std::array<double, 4>, 4> m{};
    for (std::size_t i = 0; i < 16; ++i) m[i / 4][i % 4] = double{matrix[i]};
    double out = 1;
    for (std::size_t i = 0; i < 4; ++i) {
        std::size_t pivot = i;
        for (std::size_t row = i + 1; row < 4; ++row)
            if (std::abs(m[row][i]) > std::abs(m[pivot][i])) pivot = row;
        if (m[pivot][i] == 0) return 0;
        if (pivot != i) {
            std::swap(m[pivot], m[i]);
            out = -out;
        }
        out *= m[i][i];
        for (std::size_t row = i + 1; row < 4; ++row) {
            const double part = m[row][i] / m[i][i];
            for (std::size_t column = i; column < 4; ++column) m[row][column] -= part * m[i][column];
        }
    }
    return out;
}

}  // namespace

Result<> check_camera_matrix(std::string_view name, const Matrix& matrix) {
    for (std::size_t i = 0; i < 16; ++i)
        if (!std::isfinite(matrix[i]))
            return user_error(
                fmt::format("{}: number {} of 16 is {}: allowed are finite numbers", name, i + 1, matrix[i]));
    if (std::ranges::all_of(matrix, [](float value) { return value == 0; }))
        return user_error(fmt::format("{}: all 16 numbers are 0: allowed is a matrix with an inverse", name));
    // Of the largest determinant that vectors of these lengths can have (Hadamard 1893).
    double most = 1;
    for (std::size_t column = 0; column < 4; ++column) {
        double square = 0;
        for (std::size_t row = 0; row < 4; ++row) square += std::pow(double{matrix[column * 4 + row]}, 2);
        most *= std::sqrt(square);
    }
    if (const double found = determinant(matrix); !(std::abs(found) > 1e-16 * most))
        return user_error(fmt::format("{}: the determinant is {:g}: allowed is a matrix with an inverse", name, found));
    return {};
}

Result<> check_camera(const FrameCamera& camera) {
    for (const auto& [name, matrix] :
         {std::pair("worldToCamera", &camera.world_to_camera), std::pair("darkroom:projection", &camera.projection),
          std::pair("darkroom:previousWorldToCamera", &camera.previous_world_to_camera),
          std::pair("darkroom:previousProjection", &camera.previous_projection)})
        if (*matrix) DARKROOM_TRY(check_camera_matrix(name, **matrix));
    // Renderers stay within a pixel; a much larger number is an error.
    constexpr float most = 64;
    for (const auto& [name, jitter] :
         {std::pair("darkroom:jitter", &camera.jitter), std::pair("darkroom:previousJitter", &camera.previous_jitter)})
        for (std::size_t i = 0; *jitter && i < 2; ++i)
            if (!(std::abs((**jitter)[i]) <= most))
                return user_error(fmt::format("{}: number {} of 2 is {}: allowed are [-{:g}, {:g}] pixels", name, i + 1,
                                              (**jitter)[i], most, most));
    return {};
}

}  // namespace darkroom
