// SPDX-License-Identifier: MIT
#pragma once
// Tonemap: brings scene-linear light into the range of a display, by one of several published operators. The result is
// display-linear, in [0, 1], or for those of BT.2390 and gt7 up to a peak beyond: it is not encoded, and it is not the
// place for exposure or for a look.

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
    Bt2390,       ///< ITU-R BT.2390's EETF on the largest of red, green and blue
    Bt2390Ictcp,  ///< the same on the intensity of ICtCp
    Gt7,          ///< Gran Turismo 7, from standard to high range
};

struct Tonemap {
    /// Tone mapping operator.
    TonemapOperator curve = TonemapOperator::AcesNarkowicz;
    /// Luminance that reinhard_extended maps to white, and bt2390 to the peak; the other operators ignore it. [0.1,
    /// 1024]
    float white = 4.0f;
    /// Peak luminance of the display, for bt2390, bt2390_ictcp and gt7; there 1.0 is 203 cd/m2. [100, 10000] cd/m2
    float peak_nits = 203.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const Tonemap&);

}  // namespace darkroom
