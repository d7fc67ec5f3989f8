// SPDX-License-Identifier: MIT
#pragma once
// Posterize: few levels instead of many, as of a screen print. It is not what a target's format rounds to, nor its
// cure.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class PosterizeMode : std::uint32_t {
    Channel,  ///< every channel by itself: levels^3 colours
    Luma,     ///< the luma alone: hues and saturations stay
};

struct Posterize {
    /// Number of levels from 0 to 1, both included. [2, 256]
    std::int32_t levels = 6;
    /// Quantity that is rounded to a level.
    PosterizeMode mode = PosterizeMode::Channel;
};

[[nodiscard]] const EffectInfo& effect_info(const Posterize&);

}  // namespace darkroom
