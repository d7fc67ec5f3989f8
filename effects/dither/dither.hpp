// SPDX-License-Identifier: MIT
#pragma once
// Dither: hides the steps of an 8- or 10-bit target with blue noise of triangular distribution, added to the encoded
// picture as its last step. It is not film grain.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

struct Dither {
    float intensity = 0.03f;
};

[[nodiscard]] const EffectInfo& effect_info(const Dither&);

}  // namespace darkroom
