// SPDX-License-Identifier: MIT
#pragma once
// Spaces, displays and views of an OpenColorIO configuration: see ColorChains.

#include <string>

#include "image/table/color_chain.hpp"

namespace darkroom {

[[nodiscard]] Result<std::unique_ptr<ColorChain>> chain_from_space(const std::filesystem::path& configuration,
                                                                   const std::string& space);
[[nodiscard]] Result<std::unique_ptr<ColorChain>> chain_to_view(const std::filesystem::path& configuration,
                                                                const std::string& display, const std::string& view,
                                                                const std::string& space);

}  // namespace darkroom
