// SPDX-License-Identifier: MIT
#pragma once
// Rows that draw a scene with scenes/render: the dungeon that ships, scene and post-processing apart, it and the street
// with other shadows, and ten thousand boxes built in code. Their size is their own, not the bed's. A build without the
// renderer has none of them.

#include <string_view>
#include <vector>

#include "bench/chain/recipe.hpp"

namespace darkroom::bench {

inline constexpr std::string_view dungeon_scene_name = "scene: dungeon 1280x720, scene";
inline constexpr std::string_view dungeon_plain_name = "scene: dungeon 1280x720, scene, plain shadows";
inline constexpr std::string_view dungeon_unshadowed_name = "scene: dungeon 1280x720, scene, no shadows";
inline constexpr std::string_view street_name = "scene: street 1280x720, scene";
inline constexpr std::string_view street_unshadowed_name = "scene: street 1280x720, scene, no shadows";
inline constexpr std::string_view dungeon_post_name = "scene: dungeon 1280x720, post";

[[nodiscard]] std::vector<Recipe> scene_recipes();

}  // namespace darkroom::bench
