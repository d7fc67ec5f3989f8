// SPDX-License-Identifier: MIT
#pragma once
// Dither: hides the steps of an 8- or 10-bit target with blue noise of triangular distribution, added to the encoded
// picture as its last step. It is not film grain.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Dither {
    float intensity = 0.03f;
};
inline constexpr auto dither_rows =
    describe(field<&Dither::intensity>(
                 "Width of the noise, in units of the encoded range; 2/255 hides the steps of 8 bits.", {0, 1})
                 .as_amount());

[[nodiscard]] const EffectInfo& effect_info(const Dither&);

}  // namespace darkroom
