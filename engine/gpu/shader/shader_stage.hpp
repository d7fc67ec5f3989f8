// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace darkroom::gpu {

enum class ShaderStage : std::uint8_t { Vertex, Fragment, Compute };

}  // namespace darkroom::gpu
