// SPDX-License-Identifier: MIT
#pragma once
// The transfer function of IEC 61966-2-1 (sRGB). Above 1 the power goes on, below 0 the line. References of effects
// have their own (effects/shared/srgb_reference.hpp), so that a slip here is seen.

#include <cmath>
#include <concepts>

namespace darkroom {

/// Light to code values, in the precision of `light`.
template <std::floating_point T>
[[nodiscard]] T srgb_encode(T light) {
    return light <= T(0.0031308) ? T(12.92) * light : T(1.055) * std::pow(light, 1 / T(2.4)) - T(0.055);
}
/// Code values to light.
template <std::floating_point T>
[[nodiscard]] T srgb_decode(T code) {
    return code <= T(0.04045) ? code / T(12.92) : std::pow((code + T(0.055)) / T(1.055), T(2.4));
}

}  // namespace darkroom
