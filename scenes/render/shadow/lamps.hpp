// SPDX-License-Identifier: MIT
#pragma once
// Which lamps (point and spot lights) cast shadows, and the tiles of one depth image that they have for it: one a spot
// light, the six faces of a cube a point light or a spot light wider than a tile can be. Arithmetic alone, no GPU.

#include <cstdint>
#include <vector>

#include "render/frame_set.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

/// The budget: lamps beyond it shine without a shadow.
inline constexpr std::uint32_t max_lamps_with_shadows = 8, max_tiles = 6 * max_lamps_with_shadows;
/// Tiles of a row of the image; its rows follow their number.
inline constexpr std::uint32_t tiles_a_row = 8;
/// Texels of a tile beyond what its lamp lights, to each side: what the filter reaches and a receiver is moved by, so
/// that the faces of a cube meet without a seam.
inline constexpr std::uint32_t tile_border = 10;
/// Casters nearer to a lamp than this share of its range, or of the way to the farthest that is drawn, cast nothing:
/// they are what it is made of.
inline constexpr float lamp_near_share = 0.005F;

struct LampTiles {
    std::uint32_t light = 0;  ///< in Snapshot::lights
    std::uint32_t first = 0, count = 0;
};

struct LampShadows {
    std::vector<LampTiles> lamps;
    std::vector<scene::mat4> world_to_tile;  ///< see shaders/light/shadow_block.glsl
};

/// Texels of a side of a tile: a quarter of a cascade's, [64, 1024].
[[nodiscard]] std::uint32_t tile_side(std::uint32_t cascade_resolution);
/// How many tiles lamps of the snapshot may need at once, wherever the camera is.
[[nodiscard]] std::uint32_t tiles_needed(const scene::Snapshot& snapshot);
/// Those that cast and whose range touches what the camera sees; of more than the budget those with the most light at
/// the camera: luminance over the squared distance, of a metre at least. In the snapshot's order.
[[nodiscard]] LampShadows choose_lamps(const scene::Snapshot& snapshot, std::uint32_t side);

}  // namespace darkroom::render
