// SPDX-License-Identifier: MIT
// In place of controllers.cpp where scripts are not built.
#include "bench/chain/recipe.hpp"

namespace darkroom::bench {

std::vector<Recipe> controller_recipes() { return {}; }

}  // namespace darkroom::bench
