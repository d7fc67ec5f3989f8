// SPDX-License-Identifier: MIT
#pragma once
// What a scene's choice of Skins does to its figures, in words. It draws nothing.

#include <string>
#include <vector>

#include "scene/assets.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {

/// One line for each model whose figures are not as high, or not as wide, as all nodes of the model would make them,
/// where the scene does not say its Skins.
[[nodiscard]] std::vector<std::string> figure_notices(const Scene& scene, const Assets& assets);

}  // namespace darkroom::scene
