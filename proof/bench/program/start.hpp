// SPDX-License-Identifier: MIT
#pragma once
// How long it takes from nothing to the first dispatch of the default stack with warm caches, against a bare program
// that creates a device by itself and loads the same shaders into the same pipelines.

#include <string>
#include <vector>

#include "bench/rows.hpp"

namespace darkroom::bench {

[[nodiscard]] Result<std::vector<Figure>> start_figures(const std::string& select, VkExtent2D extent,
                                                        std::uint32_t rounds);

}  // namespace darkroom::bench
