// SPDX-License-Identifier: MIT
// In place of controllers.cpp where scripts are not built.
#include "interface.hpp"

namespace darkroom::bench {

std::vector<Recipe> controller_recipes() { return {}; }

}  // namespace darkroom::bench
