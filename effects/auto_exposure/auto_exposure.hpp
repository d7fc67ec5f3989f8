// SPDX-License-Identifier: MIT
#pragma once
// Auto exposure: meters the picture by a histogram of its luminance and multiplies the light so that what it meters
// comes to middle grey, at once in the first frame and after a cut, then as fast as an eye adapts. It moves all light
// alike; it compresses nothing, and an `exposure` behind it goes on top.
// Stops are counted from middle grey, 0.18 of scene-linear light.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct AutoExposure {
    /// How much brighter than middle grey what is metered becomes. [-16, 16] stops
    float compensation = 0.0f;
    /// Stops that are added, over those that are metered, both from middle grey; none: 0.
    /// up to 16 points [x, y], x ascending, y in [-16, 16]
    Curve compensation_curve;
    /// Part of the pixels, from the darkest on, that is not metered. [0, 1]
    float low = 0.4f;
    /// Part of the pixels up to which is metered. [0, 1]
    float high = 0.9f;
    /// Brightness from middle grey below which a picture counts as no darker. [-16, 16] stops
    float darkest = -4.0f;
    /// Brightness from middle grey above which a picture counts as no brighter. [-16, 16] stops
    float brightest = 8.0f;
    /// How fast it follows a picture that gets brighter; 0 holds still. [0, 100] stops/s
    float speed_up = 3.0f;
    /// How fast it follows a picture that gets darker; 0 holds still. [0, 100] stops/s
    float speed_down = 1.0f;
    /// How much less the borders count than the centre. [0, 1]
    float center_weight = 0.0f;
};

[[nodiscard]] const EffectInfo& effect_info(const AutoExposure&);

}  // namespace darkroom
