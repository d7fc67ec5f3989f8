// SPDX-License-Identifier: MIT
#pragma once
// Where the library may keep files of its own between runs. It asks the environment and creates nothing.

#include <filesystem>

namespace darkroom {

/// XDG_CACHE_HOME/darkroom, else HOME/.cache/darkroom, else empty: no cache.
[[nodiscard]] std::filesystem::path user_cache_folder();

}  // namespace darkroom
