// SPDX-License-Identifier: MIT
#pragma once
// Tonemap: brings scene-linear light into the range of a display, by one of several published operators. The result is
// display-linear, in [0, 1]: it is not encoded, and it is not the place for exposure or for a look.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class TonemapOperator : std::uint32_t {
    AcesNarkowicz,
    AcesHill,
    ReinhardExtended,
    Hable,
    Agx,
    KhronosPbrNeutral,
    Linear,
};

struct Tonemap {
    /// The tone mapping operator.
    TonemapOperator curve = TonemapOperator::AcesNarkowicz;
    /// Luminance that reinhard_extended maps to white; the other operators ignore it. [0.1, 1024]
    float white = 4.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Tonemap&);

}  // namespace darkroom
