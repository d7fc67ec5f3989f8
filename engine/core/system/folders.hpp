// SPDX-License-Identifier: MIT
#pragma once
// Where the library may keep files of its own between runs, and whether others may change them. Nothing is created
// here.

#include <filesystem>

namespace darkroom {

/// XDG_CACHE_HOME/darkroom, else HOME/.cache/darkroom; on Windows LOCALAPPDATA/darkroom. Else empty: no cache.
[[nodiscard]] std::filesystem::path user_cache_folder();

/// Does it belong to the user of this process, and may nobody else write to it? On Windows administrators and the
/// system may always.
[[nodiscard]] bool is_of_this_user_alone(const std::filesystem::path& path);

}  // namespace darkroom
