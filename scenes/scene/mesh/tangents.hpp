// SPDX-License-Identifier: MIT
#pragma once
// Tangents for a primitive whose file gives none, as baking programs make them, so that normal maps light up as they
// were baked. It is our own writing of the method, not the mikktspace library: corners are grouped by what they have
// in common and not by the edges between them.

#include "scene/model.hpp"

namespace darkroom::scene {

/// Fills Vertex::tangent from the coordinates of `texture`. Where a mirrored part of the texture begins, vertices are
/// split, so there may be twice as many afterwards. O(n log n) time.
void make_tangents(Primitive& primitive, const Texture& texture);

/// What make_tangents() may need beside the primitive itself, for the budget: a vertex and a corner.
[[nodiscard]] std::size_t tangent_bytes_per_vertex(const Primitive& primitive);
inline constexpr std::size_t tangent_bytes_per_corner = 32;

}  // namespace darkroom::scene
