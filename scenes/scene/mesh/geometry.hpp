// SPDX-License-Identifier: MIT
#pragma once
// Work on the triangles of a primitive that has been read: it knows no file. Arrays of a primitive keep one length.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/model.hpp"

namespace darkroom::scene {

/// `mode`: of glTF: 4 triangles, 5 strip, 6 fan. Corners that make no whole triangle are passed over.
[[nodiscard]] std::vector<std::uint32_t> triangles_of(std::span<const std::uint32_t> corners, int mode);

/// Vertex i becomes what vertex from[i] was, in all arrays but the indices.
void rearrange(Primitive& primitive, std::span<const std::uint32_t> from);

/// Gives every triangle vertices of its own, with its normal, and every morph target the change of it (glTF 2.0
/// specification, 3.7.2.2). Changes are of normals as long as triangles are large against the one at rest: where
/// targets move corners along one direction, what is between two weights is exact.
void make_flat(Primitive& primitive);

/// Files may keep the vertices of many primitives in one array, of which each uses a part.
void drop_unused_vertices(Primitive& primitive);

[[nodiscard]] std::size_t size_in_memory(const Primitive& primitive);

// Tangents for a primitive whose file gives none, as baking programs make them, so that normal maps light up as they
// were baked. It is our own writing of the method, not the mikktspace library: corners are grouped by what they have
// in common and not by the edges between them.

/// Fills Vertex::tangent from the coordinates of `texture`. Where a mirrored part of the texture begins, vertices are
/// split, so there may be twice as many afterwards. O(n log n) time.
void make_tangents(Primitive& primitive, const Texture& texture);

/// What make_tangents() may need beside the primitive itself, for the budget: a vertex and a corner.
[[nodiscard]] std::size_t tangent_bytes_per_vertex(const Primitive& primitive);
inline constexpr std::size_t tangent_bytes_per_corner = 32;

}  // namespace darkroom::scene
