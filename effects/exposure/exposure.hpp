// SPDX-License-Identifier: MIT
#pragma once
// Exposure: scales scene-linear colour by a multiplier, before tone mapping. It is not an automatic exposure.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Exposure {
    /// Factor of the scene's light; 2 is one stop brighter. [0, 1024] x
    float exposure = 1.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Exposure&);

}  // namespace darkroom
