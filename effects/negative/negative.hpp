// SPDX-License-Identifier: MIT
#pragma once
// Negative: one minus the colour. It is not the inversion of a film scan.

#include <darkroom/effect.hpp>

namespace darkroom {

struct Negative {
    float amount = 1.0f;
};
inline constexpr auto negative_rows =
    describe(field<&Negative::amount>("Share of the negative; at 0 the picture stays as it is.", {0, 1}));

[[nodiscard]] const EffectInfo& effect_info(const Negative&);

}  // namespace darkroom
