// SPDX-License-Identifier: MIT
#pragma once
// Arrays that are packed by meshoptimizer (Khronos Group, EXT_meshopt_compression, 2021). It knows no glTF. Sizes are
// known before anything is unpacked, and the library writes no more.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::scene {

enum class MeshoptMode { Attributes, Triangles, Indices };
enum class MeshoptFilter { None, Octahedral, Quaternion, Exponential };

struct MeshoptDesc {
    MeshoptMode mode = MeshoptMode::Attributes;
    MeshoptFilter filter = MeshoptFilter::None;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
};

/// By the names of the extension, which the error lists.
[[nodiscard]] Result<MeshoptMode> meshopt_mode(const std::string& name);
[[nodiscard]] Result<MeshoptFilter> meshopt_filter(const std::string& name);

/// What the mode and the filter ask of count and stride. Errors begin with the property.
[[nodiscard]] Result<> check_meshopt(const MeshoptDesc& desc);

/// count * stride bytes, of what check_meshopt() has passed.
[[nodiscard]] Result<std::vector<std::byte>> unpack_meshopt(std::span<const std::byte> bytes, const MeshoptDesc& desc);

}  // namespace darkroom::scene
