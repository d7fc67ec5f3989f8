// SPDX-License-Identifier: MIT
#pragma once
// Contrast and gamma of the finished picture with its interface: the two sliders of a game's display menu.

#include <darkroom/effect.hpp>

namespace darkroom {

struct ContrastGamma {
    float contrast = 1.0f;
    float gamma = 1.0f;
};
inline constexpr auto contrast_gamma_rows = describe(
    field<&ContrastGamma::contrast>("Factor of the encoded picture.", {1, 2}).as_amount().also_named("contrast", true),
    field<&ContrastGamma::gamma>("Exponent behind it: below 1 brightens.", {0.1, 4, Scale::Log})
        .as_amount()
        .also_named("gamma", true));

[[nodiscard]] const EffectInfo& effect_info(const ContrastGamma&);

}  // namespace darkroom
