// SPDX-License-Identifier: MIT
#pragma once
// Libraries that are loaded while the program runs, and where the program and this library lie.

#include <darkroom/result.hpp>
#include <filesystem>

namespace darkroom {

/// The name of Vulkan's loader on this system.
extern const char* const vulkan_loader_name;

/// Loads a library by its path, or by a name that the system looks for. It is never closed: drivers leave threads and
/// exit handlers behind that need their code. The error says which one and why, in one line.
[[nodiscard]] Result<void*> load_library(const std::filesystem::path& library);
/// nullptr: it has none of this name.
[[nodiscard]] void* symbol_of(void* library, const char* name);

/// The file of the running program. Empty: unknown.
[[nodiscard]] std::filesystem::path running_program();
/// The file of the library, or of the program, that this code is linked into. Empty: unknown.
[[nodiscard]] std::filesystem::path own_library();

}  // namespace darkroom
