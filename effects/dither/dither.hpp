// SPDX-License-Identifier: MIT
#pragma once
// Dither: hides the steps of an 8- or 10-bit target with blue noise of triangular distribution, added to the encoded
// picture as its last step. It is not film grain.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class DitherEnds : std::uint32_t {
    Rounded,    ///< the mean stays what it was once the picture is rounded to steps of half the intensity
    Unrounded,  ///< the mean stays before rounding, which near black and white it does not survive
};

struct Dither {
    /// Width of the noise, in units of the encoded range; 2/255 hides the steps of 8 bits. [0, 1]
    float intensity = 2.0f / 255.0f;
    /// Mean that is kept near black and white: that of the rounded picture, or that before rounding.
    DitherEnds ends = DitherEnds::Rounded;
    /// Changes the noise in each frame while time runs, for filters that average frames.
    Toggle moves = false;
};

[[nodiscard]] const EffectInfo& effect_info(const Dither&);

}  // namespace darkroom
