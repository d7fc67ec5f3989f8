// SPDX-License-Identifier: MIT
// In place of scene.cpp where the renderer is not built.
#include "scene.hpp"

namespace darkroom::bench {

std::vector<Recipe> scene_recipes() { return {}; }

}  // namespace darkroom::bench
