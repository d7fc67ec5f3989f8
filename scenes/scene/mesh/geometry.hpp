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

/// Gives every triangle vertices of its own, with its normal.
void make_flat(Primitive& primitive);

/// Files may keep the vertices of many primitives in one array, of which each uses a part.
void drop_unused_vertices(Primitive& primitive);

[[nodiscard]] std::size_t size_in_memory(const Primitive& primitive);

}  // namespace darkroom::scene
