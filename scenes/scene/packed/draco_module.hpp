// SPDX-License-Identifier: MIT
#pragma once
// All that the program and the module of Draco (scenes/draco) know of each other.

#include "scene/packed/draco.hpp"

namespace darkroom::scene {

struct DracoModule {
    /// unpack_draco(), of bytes whose head has been read.
    Result<> (*unpack)(std::span<const std::byte> bytes, std::uint64_t vertices, const AdmitVertices& admit,
                       std::span<DracoAttribute> attributes, std::vector<std::uint32_t>& corners);
};

}  // namespace darkroom::scene
