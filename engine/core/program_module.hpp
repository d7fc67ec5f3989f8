// SPDX-License-Identifier: MIT
#pragma once
// What belongs to the program and is no part of its file: libraries that it loads and programs that it starts when they
// are first needed.

#include <filesystem>

/// Before the one function by which a library of the program is reached.
#ifdef _MSC_VER
#define DARKROOM_MODULE_EXPORT __declspec(dllexport)
#else
#define DARKROOM_MODULE_EXPORT __attribute__((visibility("default")))
#endif

namespace darkroom {

/// Where `file` of <library folder>/darkroom is: where it was installed, seen from the running program or from the
/// library that this is linked into, so that the whole may be moved; else where it is in a build folder.
[[nodiscard]] std::filesystem::path program_module(const char* file);

}  // namespace darkroom
