// SPDX-License-Identifier: MIT
#pragma once
// The tessellated grid of an effect that moves coordinates: how far is worked out in the vertices alone, and
// interpolated between them. The grid is an image with a texel for each vertex, so it works in both stages; a shader
// reads it by sample_linear(IMAGE, grid_uv(pixel.uv, size(IMAGE))) with shared/warp_grid.glsl.

#include <darkroom/effect.hpp>

namespace darkroom {

/// Adds the pass that writes the grid: (columns + 1) x (rows + 1) vertices, two numbers each in half precision, so
/// shifts are best in pixels. In `pass`, `output` is filled in.
[[nodiscard]] PassImage warp_grid(PassBuilder& builder, std::uint32_t columns, std::uint32_t rows, KernelPassDesc pass);

}  // namespace darkroom
