// SPDX-License-Identifier: MIT
#pragma once
// What the interface costs the CPU. Rows are 1000 frames, so their milliseconds are microseconds of a frame.

#include <vector>

#include "recipe.hpp"

namespace darkroom::bench {

inline constexpr int frames_of_a_row = 1000;

[[nodiscard]] std::vector<Recipe> interface_recipes();
/// None where scripts are not built.
[[nodiscard]] std::vector<Recipe> controller_recipes();

}  // namespace darkroom::bench
