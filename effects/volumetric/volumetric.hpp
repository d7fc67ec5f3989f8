// SPDX-License-Identifier: MIT
#pragma once
// Volumetric light: shafts of directional light in even haze, marched through each light's own shadow cascades. One
// scattering only, and the haze neither hides the scene nor casts a shadow: for that see fog.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Volumetric {
    float density = 1.0f;
    std::int32_t samples = 32;
    float max_distance = 100.0f;
    float decay = 0.98f;
};
inline constexpr auto volumetric_rows = describe(
    field<&Volumetric::density>("How much light the haze scatters toward the camera, in hundredths a metre.", {0, 1000})
        .as_amount(),
    field<&Volumetric::samples>("Steps of the march. Brightness does not depend on it, smoothness does.", {1, 256}),
    field<&Volumetric::max_distance>("How far the march goes; the sky is marched as far.", {0.01, 1e6}, unit::metres),
    field<&Volumetric::decay>("What is left of the light after each thirty-second of the march.", {0.01, 1}));

[[nodiscard]] const EffectInfo& effect_info(const Volumetric&);

}  // namespace darkroom
