// SPDX-License-Identifier: MIT
#pragma once
// UI composite: the interface over the picture, both encoded; premultiplied, or as light that is added.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct UiComposite {
    float ui_opacity = 1.0f;
    float additive = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const UiComposite&);

}  // namespace darkroom
