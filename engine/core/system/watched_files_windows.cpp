// SPDX-License-Identifier: MIT
#include "core/system/watched_files.hpp"

namespace darkroom {

int watch_file(const std::filesystem::path&) noexcept { return -1; }

void unwatch_file(int) noexcept {}

void create_watched(const std::function<void()>& create) { create(); }

void remove_watched_files_on_signals() {}

}  // namespace darkroom
