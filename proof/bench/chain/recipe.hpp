// SPDX-License-Identifier: MIT
#pragma once
// A row by its name, before it is made: rows are many, and a run asks for some.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure.hpp"

namespace darkroom::bench {

struct Recipe {
    std::string name;
    /// A row without work is dropped: what it would measure is not there, and `make` has said so.
    std::function<Result<Row>(Bed&, const std::string& name)> make;
};

// What the interface costs the CPU. Rows are 1000 frames, so their milliseconds are microseconds of a frame.

inline constexpr int frames_of_a_row = 1000;

[[nodiscard]] std::vector<Recipe> interface_recipes();
/// None where scripts are not built.
[[nodiscard]] std::vector<Recipe> controller_recipes();

// Rows that draw a scene with scenes/render: the dungeon that ships, scene and post-processing apart, it and the street
// with other shadows, and ten thousand boxes built in code. Their size is their own, not the bed's. A build without the
// renderer has none of them.

inline constexpr std::string_view dungeon_scene_name = "scene: dungeon 1280x720, scene";
inline constexpr std::string_view dungeon_plain_name = "scene: dungeon 1280x720, scene, plain shadows";
inline constexpr std::string_view dungeon_unshadowed_name = "scene: dungeon 1280x720, scene, no shadows";
inline constexpr std::string_view street_name = "scene: street 1280x720, scene";
inline constexpr std::string_view street_unshadowed_name = "scene: street 1280x720, scene, no shadows";
inline constexpr std::string_view dungeon_post_name = "scene: dungeon 1280x720, post";

[[nodiscard]] std::vector<Recipe> scene_recipes();

}  // namespace darkroom::bench
