// SPDX-License-Identifier: MIT
#pragma once
// UI echo: a ghost of the interface around it, as a reflection in the visor's glass. It is bent as the interface is.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiEcho {
    /// Brightness of the ghost. [0, 4]
    float strength = 0.0f;
    /// Side lengths of the ghost, relative to the interface's. [0.05, 20]
    float size = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const UiEcho&);

}  // namespace darkroom
