// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a thing before a wall, without a renderer.

#include <cstdint>

#include "develop/test_sequence.hpp"

namespace darkroom::test::depth_of_field {

inline constexpr std::uint32_t width = 96, height = 128;

inline Camera camera_of(std::uint32_t columns, std::uint32_t rows) {
    Camera camera = look_at({0, 0, 0}, {0, 0, -1}, 0.9, static_cast<double>(columns) / rows);
    camera.depth = DepthKind::Planar;
    return camera;
}

inline bool is_thing(std::uint32_t x, std::uint32_t y) { return x >= 30 && x < 61 && y >= 41 && y < 88; }

/// A red thing before a striped wall of green and blue.
inline Shot scene(double of_thing, double of_wall) {
    Shot shot{.color = ReferenceImage(width, height),
              .depth = ReferenceImage(width, height),
              .camera = camera_of(width, height)};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            shot.color.at(x, y) =
                is_thing(x, y) ? Rgba{1, 0, 0, 0.25} : Rgba{0, (x / 3 + y / 3) % 2 == 0 ? 0.75 : 0.25, 0.5, 0.25};
            shot.depth.at(x, y) = {is_thing(x, y) ? of_thing : of_wall, 0, 0, 1};
        }
    return shot;
}

}  // namespace darkroom::test::depth_of_field
