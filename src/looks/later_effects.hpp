// SPDX-License-Identifier: MIT
#pragma once
// Effects that the documented [post_process] table has and that a build may lack. Their keys are no slips of the hand:
// they are passed over with one warning for each effect. A build that has the effect reads them, and this list is
// silent.

#include <array>
#include <string_view>

namespace darkroom {

inline constexpr std::array<std::string_view, 5> documented_effects{"ssao", "fog", "volumetric", "chromatic_aberration",
                                                                    "radial_blur"};

/// The effect that a key of the flat table belongs to, if it is one of these; else empty.
[[nodiscard]] constexpr std::string_view documented_effect_of(std::string_view key) {
    for (const std::string_view effect : documented_effects) {
        const bool is_own = key == effect || (key.starts_with(effect) && key.substr(effect.size()).starts_with('_'));
        if (is_own) return effect;
    }
    return {};
}

}  // namespace darkroom
