// SPDX-License-Identifier: MIT
#pragma once
// What the interface costs the CPU. Rows are 1000 frames, so their milliseconds are microseconds of a frame.

#include <vector>

#include "recipe.hpp"

namespace darkroom::bench {

[[nodiscard]] std::vector<Recipe> interface_recipes();

}  // namespace darkroom::bench
