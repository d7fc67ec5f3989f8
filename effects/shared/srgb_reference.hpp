// SPDX-License-Identifier: MIT
#pragma once
// IEC 61966-2-1, for references and tests: written apart from what they judge. Above 1 the power goes on, below 0 the
// line.

#include <cmath>

namespace darkroom {

inline double srgb_encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}
inline double srgb_decoded(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace darkroom
