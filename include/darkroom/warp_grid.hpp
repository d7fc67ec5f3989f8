// SPDX-License-Identifier: MIT
#pragma once
// The tessellated grid of an effect that moves coordinates: how far is worked out in the vertices alone, and
// interpolated between them. The grid is an image with a texel for each vertex, so it works in both stages; a shader
// reads it by sample_linear(IMAGE, grid_uv(pixel.uv, size(IMAGE))) with shared/warp_grid.glsl.

#include <darkroom/effect.hpp>

namespace darkroom {

/// The member `Vec2 grid = default_warp_grid` of an effect, and its row.
inline constexpr Vec2 default_warp_grid{32.0f, 18.0f};
template <auto M>
constexpr auto warp_grid_field() {
    return field<M>("Columns and rows of the grid whose vertices are evaluated.", {1, 256}).at_compile();
}
/// A value of that row in whole cells.
[[nodiscard]] VkExtent2D warp_grid_cells(Vec2 grid);

/// Adds the pass that writes the grid, whose shader has the vertex's uv by grid_vertex(pixel): up to four numbers each
/// in half precision, so shifts are best in pixels. In `pass`, `output` is filled in.
[[nodiscard]] PassImage warp_grid(PassBuilder& builder, Vec2 grid, KernelPassDesc pass);

}  // namespace darkroom
