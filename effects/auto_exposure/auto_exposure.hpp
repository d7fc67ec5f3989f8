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
    /// Stops that the metered brightness is brought above middle grey. [-16, 16] stops
    float compensation = 0.0f;
    /// Stops added (y) for metered stops from middle grey (x); an empty curve adds none. up to 16 points [x, y], x
    /// ascending, y in [-16, 16]
    Curve compensation_curve;
    /// Share of the pixels, from the darkest on, that the meter leaves out. [0, 1]
    float low = 0.4f;
    /// Share of the pixels, from the darkest on, at which the meter stops. [0, 1]
    float high = 0.9f;
    /// Lowest brightness that the meter reports, from middle grey. [-16, 16] stops
    float darkest = -4.0f;
    /// Highest brightness that the meter reports, from middle grey. [-16, 16] stops
    float brightest = 8.0f;
    /// Speed of adaption to a brighter picture; at 0 the exposure stays. [0, 100] stops/s
    float speed_up = 3.0f;
    /// Speed of adaption to a darker picture; at 0 the exposure stays. [0, 100] stops/s
    float speed_down = 1.0f;
    /// Share of weight that the borders lose against the centre. [0, 1]
    float center_weight = 0.0f;
    /// Picture whose red says how much pixels count, from 0 to 1, stretched over the whole; without one all do.
    Resource metering_mask;
};

[[nodiscard]] const EffectInfo& effect_info(const AutoExposure&);

}  // namespace darkroom
