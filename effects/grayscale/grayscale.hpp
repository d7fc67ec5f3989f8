// SPDX-License-Identifier: MIT
#pragma once
// Grayscale: takes the colour out and keeps the luminance. It is not a channel mixer for black-and-white looks.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Grayscale {
    float amount = 1.0f;
};
inline constexpr auto grayscale_rows =
    describe(field<&Grayscale::amount>("How much of the colour goes; at 0 the picture stays as it is.", {0, 1}));

[[nodiscard]] const EffectInfo& effect_info(const Grayscale&);

}  // namespace darkroom
