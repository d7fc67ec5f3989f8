// SPDX-License-Identifier: MIT
#pragma once
// Effects of files: their parameters are flags of the runs that name them, so they are looked for before the arguments
// are parsed.

#include <darkroom/look.hpp>
#include <span>
#include <vector>

namespace app {

inline constexpr const char* no_custom_effects = "--no-custom-effects";

/// Of the files that the arguments name, and of the looks among these. What cannot be read is passed over: whoever
/// reads it for its own sake says why.
[[nodiscard]] std::vector<darkroom::LookEntry> effects_named_by(std::span<char* const> arguments);

}  // namespace app
