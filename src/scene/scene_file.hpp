// SPDX-License-Identifier: MIT
#pragma once
// The text of a scene or prefab file, once it is known to be a file of a bearable size.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <string>

namespace darkroom::scene::reading {

inline constexpr std::uintmax_t largest_file = 16U << 20;

[[nodiscard]] Result<std::string> read_scene_text(const std::filesystem::path& path);

}  // namespace darkroom::scene::reading
