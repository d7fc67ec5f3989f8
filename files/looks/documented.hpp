// SPDX-License-Identifier: MIT
#pragma once
// What the order "documented" has for defaults where they differ from the effects' own: the values of the engine's
// chapter that its scenes were made with, so that they need no new key.

#include <array>
#include <string_view>

namespace darkroom {

struct DocumentedValue {
    std::string_view effect;
    std::string_view parameter;  ///< or "enabled"
    std::string_view text;       ///< as a flag takes it
};

inline constexpr std::array documented_values{
    DocumentedValue{"ssao", "method", "hemisphere"},    DocumentedValue{"volumetric", "decay_form", "per_step"},
    DocumentedValue{"volumetric", "decay", "0.98"},     DocumentedValue{"bloom", "reach", "pixels"},
    DocumentedValue{"fog", "density", "0.02"},          DocumentedValue{"fog", "end", "100"},
    DocumentedValue{"fog", "height_form", "end_point"}, DocumentedValue{"fog", "horizon", "0"},
    DocumentedValue{"fxaa", "enabled", "false"},        DocumentedValue{"dither", "enabled", "false"},
    DocumentedValue{"dither", "intensity", "0.03"},     DocumentedValue{"dither", "ends", "unrounded"},
    DocumentedValue{"dither", "moves", "true"},
};

}  // namespace darkroom
