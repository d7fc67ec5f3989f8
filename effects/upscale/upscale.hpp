// SPDX-License-Identifier: MIT
#pragma once
// Spatial upscaling: brings a picture of fewer pixels to the output's size by a filter that follows its edges. It knows
// one frame, so it makes no detail that was not drawn, and stairs become larger stairs: smooth them before. Sharpen
// behind it.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Upscale {
    /// Strength with which the filter follows edges: 1 as published, 0 the same filter everywhere. [0, 1]
    float adaption = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Upscale&);

}  // namespace darkroom
