// SPDX-License-Identifier: MIT
#pragma once
// The text of a scene or prefab file, once it is known to be a file of a bearable size.

#include <darkroom/result.hpp>
#include <filesystem>
#include <string>

#include "toml/toml_text.hpp"

namespace darkroom::scene::reading {

[[nodiscard]] Result<std::string> read_scene_text(const std::filesystem::path& path);

/// Whether it has a table that only scenes, prefabs among them, have.
[[nodiscard]] bool is_scene(const toml::table& file);
[[nodiscard]] bool has_look(const toml::table& file);

}  // namespace darkroom::scene::reading
