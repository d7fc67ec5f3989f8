// SPDX-License-Identifier: MIT
#pragma once
// Volumetric light: shafts of directional light in even haze, marched through each light's own shadow cascades. One
// scattering only, and the haze neither hides the scene nor casts a shadow: for that see fog.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Volumetric {
    float density = 1.0f;
    std::int32_t samples = 32;
    float max_distance = 100.0f;
    float decay = 0.98f;
};

[[nodiscard]] const EffectInfo& effect_info(const Volumetric&);

}  // namespace darkroom
