// SPDX-License-Identifier: MIT
#pragma once
// What an effect that mixes pixels (WorkingSpace::Light) does it by, in double precision: light in place of code
// values, multiplied by alpha where the picture is.

#include <darkroom/reference.hpp>

#include "shared/color_state_reference.hpp"
#include "shared/finite_reference.hpp"

namespace darkroom {

namespace light_detail {

template <class Function>
Rgba without_alpha(Rgba pixel, const ColorState& state, const Function& function) {
    const double alpha = state.is_associated && pixel.a > 0 && pixel.a < 1 ? pixel.a : 1;
    const auto [r, g, b] = function({pixel.r / alpha, pixel.g / alpha, pixel.b / alpha}, state);
    return {r * alpha, g * alpha, b * alpha, pixel.a};
}

}  // namespace light_detail

inline Rgba light_reference(const Rgba& pixel, const ColorState& state) {
    const Rgba finite{finite_reference(pixel.r), finite_reference(pixel.g), finite_reference(pixel.b),
                      finite_reference(pixel.a)};
    return state.domain == Domain::Encoded ? light_detail::without_alpha(finite, state, nits_of) : finite;
}
/// The other way round.
inline Rgba coded_reference(const Rgba& light, const ColorState& state) {
    return state.domain == Domain::Encoded ? light_detail::without_alpha(light, state, numbers_of) : light;
}
/// `from`, with so much of `toward` in its place.
inline Rgba toward_reference(const Rgba& from, const Rgba& base, const Rgba& toward, double amount) {
    return {from.r + amount * (toward.r - base.r), from.g + amount * (toward.g - base.g),
            from.b + amount * (toward.b - base.b), from.a + amount * (toward.a - base.a)};
}

}  // namespace darkroom
