// SPDX-License-Identifier: MIT
#pragma once
// Tables and pictures of the C interface as those of C++, and effects by name.

#include <darkroom/darkroom.h>

#include <darkroom/resource.hpp>
#include <darkroom/result.hpp>
#include <string_view>

namespace darkroom {
struct EffectInfo;
}

namespace darkroom::c {

/// Copies; of a size that no composer takes, the numbers are not read.
[[nodiscard]] ColorTable table_of(const DarkroomTable& given);
[[nodiscard]] ResourceImage picture_of(const DarkroomPicture& given);
/// The error names the nearest.
[[nodiscard]] Result<const EffectInfo*> effect_named(std::string_view name);

}  // namespace darkroom::c
