// SPDX-License-Identifier: MIT
#pragma once
// The text of a scene or prefab file, once it is known to be a file of a bearable size.

#include <darkroom/result.hpp>
#include <filesystem>
#include <string>

namespace darkroom::scene::reading {

[[nodiscard]] Result<std::string> read_scene_text(const std::filesystem::path& path);

}  // namespace darkroom::scene::reading
