// SPDX-License-Identifier: MIT
#pragma once
// Temporary files that a signal which ends the program takes along. Windows has no such signals: nothing is watched
// there.

#include <filesystem>
#include <functional>

namespace darkroom {

/// Its place among those that are watched; below 0: it is not.
[[nodiscard]] int watch_file(const std::filesystem::path& path) noexcept;
void unwatch_file(int place) noexcept;

/// Runs `create`, which makes a file and has it watched: no signal comes in between.
void create_watched(const std::function<void()>& create);

/// What AtomicPath::remove_on_signals does.
void remove_watched_files_on_signals();

}  // namespace darkroom
