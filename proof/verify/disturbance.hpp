// SPDX-License-Identifier: MIT
#pragma once
// What a device may round, put into the numbers that a reference starts from.

#include <darkroom/reference.hpp>
#include <random>

namespace darkroom::verify {

/// By how much numbers are moved. Some drivers cut off what they round, so that all numbers err to one side.
struct Disturbance {
    enum class Toward : std::uint8_t { Zero, Infinity, EitherSide };
    double relative = 0;  ///< of each number
    double filter = 0;    ///< of the span of the texels around
    double absolute = 0;
    Toward toward = Toward::EitherSide;
};

/// The same numbers, each moved by as much as the disturbance says; those of the sky stay.
[[nodiscard]] ReferenceImage moved(const ReferenceImage& image, std::mt19937& random, const Disturbance& by);

}  // namespace darkroom::verify
