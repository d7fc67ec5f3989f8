// SPDX-License-Identifier: MIT
#pragma once
// Tonemap: brings scene-linear light into the range of a display, by one of several published operators. The result is
// display-linear, in [0, 1]: it is not encoded, and it is not the place for exposure or for a look.

#include <darkroom/effect.hpp>

namespace darkroom {

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
    TonemapOperator curve = TonemapOperator::AcesNarkowicz;
    float white = 4.0f;
};
// The member cannot be called `operator`, which is a keyword of C++; files may still say it.
inline constexpr auto tonemap_rows =
    describe(field<&Tonemap::curve>("The tone mapping operator.").formerly("operator"),
             field<&Tonemap::white>("Luminance that reinhard_extended maps to white; the other operators ignore it.",
                                    {0.1, 1024, Scale::Log}));

[[nodiscard]] const EffectInfo& effect_info(const Tonemap&);

}  // namespace darkroom
