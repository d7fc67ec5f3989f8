// SPDX-License-Identifier: MIT
#pragma once
// Posterize: few levels instead of many, as of a screen print. It is not what a target's format rounds to, nor its
// cure.

#include <darkroom/effect.hpp>

namespace darkroom {

enum class PosterizeMode : std::uint32_t {
    Channel,  ///< every channel by itself: levels^3 colours
    Luma,     ///< the luma alone: hues and saturations stay
};

struct Posterize {
    std::int32_t levels = 6;
    PosterizeMode mode = PosterizeMode::Channel;
};
inline constexpr auto posterize_rows =
    describe(field<&Posterize::levels>("How many levels there are from 0 to 1, both among them.", {2, 256}),
             field<&Posterize::mode>("What is rounded to a level."));

[[nodiscard]] const EffectInfo& effect_info(const Posterize&);

}  // namespace darkroom
