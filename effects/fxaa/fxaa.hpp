// SPDX-License-Identifier: MIT
#pragma once
// Fast approximate anti-aliasing: smooths the stairs of edges in the finished picture, by looking along each edge for
// where its step begins and ends. It knows the picture alone, so it softens small text and cannot mend what flickers.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

enum class FxaaQuality : std::uint32_t {
    Low,     ///< the steps of preset 11
    Medium,  ///< of preset 15
    High,    ///< of preset 29
};

struct Fxaa {
    FxaaQuality quality = FxaaQuality::Low;
    float subpixel = 0.75f;
    float edge_threshold = 0.166f;
    float edge_threshold_min = 0.0833f;
};

[[nodiscard]] const EffectInfo& effect_info(const Fxaa&);

}  // namespace darkroom
