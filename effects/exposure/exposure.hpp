// SPDX-License-Identifier: MIT
#pragma once
// Exposure: scales scene-linear colour by a multiplier, before tone mapping. It is not an automatic exposure.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Exposure {
    float exposure = 1.0f;
};
inline constexpr auto exposure_rows = describe(field<&Exposure::exposure>(
    "Multiplier of the scene's light; 2 is one stop brighter.", {0, 1024}, unit::multiplier));

[[nodiscard]] const EffectInfo& effect_info(const Exposure&);

}  // namespace darkroom
