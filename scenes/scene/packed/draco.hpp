// SPDX-License-Identifier: MIT
#pragma once
// Triangles that are packed by Draco (bitstream 2.2, which glTF names). It knows no glTF. What is unpacked is bounded
// before it is: by the counts in the head, and by what the attributes declare, before there is room for them. What is
// between the two, the connections of the triangles, is the library's own to check.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/try.hpp"

namespace darkroom::scene {

struct DracoHead {
    std::uint64_t vertices = 0;  ///< at least: some are made as surfaces are cut apart
    bool has_all_vertices = false;
    std::uint64_t triangles = 0;
    std::uint64_t bytes_per_triangle = 0;  ///< that the library may need to connect them
};

/// Errors say what is wrong with the bytes.
[[nodiscard]] Result<DracoHead> read_draco_head(std::span<const std::byte> bytes);

enum class DracoNumber { Int8, UInt8, Int16, UInt16, UInt32, Float };

struct DracoAttribute {
    std::uint32_t id = 0;
    std::uint32_t components = 1;
    DracoNumber number = DracoNumber::Float;
    std::vector<std::byte> values;  ///< one of `components` a vertex, when it is unpacked
};

/// Allows `vertices` of so many bytes each, or refuses.
using AdmitVertices = std::function<Result<>(std::uint64_t vertices, std::uint64_t bytes)>;

/// Fills the values of `attributes`, and `corners` with three a triangle, each below `vertices`. Another number of
/// vertices than `vertices` is an error, told before they are unpacked.
[[nodiscard]] Result<> unpack_draco(std::span<const std::byte> bytes, std::uint64_t vertices,
                                    const AdmitVertices& admit, std::span<DracoAttribute> attributes,
                                    std::vector<std::uint32_t>& corners);

}  // namespace darkroom::scene
