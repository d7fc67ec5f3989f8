// SPDX-License-Identifier: MIT
#pragma once
// UI composite: the interface over the picture, both encoded; premultiplied, or as light that is added.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiComposite {
    /// Opacity of the interface; it never fades below 0.1. [0, 1]
    float ui_opacity = 1.0f;
    /// Mix between laying the interface over the picture (0) and adding it as light (1), which is dimmed to 0.7. [0, 1]
    float additive = 0.0f;
    /// Luminance of the interface's white, where the picture is light or for an HDR display. [1, 10000] cd/m2
    float ui_white_nits = 203.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const UiComposite&);

}  // namespace darkroom
