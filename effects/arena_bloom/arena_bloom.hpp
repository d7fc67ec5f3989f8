// SPDX-License-Identifier: MIT
#pragma once
// Arena bloom: the glow of a fighting game, which keeps its picture within a display's range: what is bright glows in a
// fixed shape, through four small pictures with weights of their own and a power that leaves only strong light. For
// light without an upper end see bloom.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class ArenaBloomSource : std::uint32_t {
    Masked,  ///< colour and alpha within [0, 1], and alpha says how much glows
    Plain,   ///< colour as it is, whatever its alpha
};

struct ArenaBloom {
    /// Amount of the glow added to the picture. [0, 4]
    float intensity = 1.0f;
    /// Light that glows: masked limits colour to a display's range and lets alpha mask it, plain takes it as it is.
    ArenaBloomSource source_kind = ArenaBloomSource::Masked;
    /// Unit of the glow's width: pixels, as in the game, or parts of the picture's height.
    Reach reach = Reach::Pixels;
};

[[nodiscard]] const EffectInfo& effect_info(const ArenaBloom&);

}  // namespace darkroom
