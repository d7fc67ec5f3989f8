// SPDX-License-Identifier: MIT
#pragma once
// AnamorphicStreaks: what is bright draws a line of light across the picture, as in front of a lens that squeezes it.
// The line falls off exponentially to both sides and holds the light that it is given. It is no lens flare: it stays
// where the light is.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct AnamorphicStreaks {
    /// Amount of the streaks added to the picture. [0, 64]
    float intensity = 0.2f;
    /// Light above this value makes streaks. [0, 65504]
    float threshold = 1.0f;
    /// Distance at which a streak has fallen to 1/e, in a picture of 1080 lines. [8, 512] px
    float length = 120.0f;
    /// Colour that multiplies the streaks. [0, 4]
    Rgb tint{0.35f, 0.6f, 1.0f};
};

[[nodiscard]] const EffectInfo& effect_info(const AnamorphicStreaks&);

}  // namespace darkroom
