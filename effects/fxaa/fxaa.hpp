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
    Ultra,   ///< of preset 39: every pixel at first, so that short steps end where they do
};

struct Fxaa {
    /// Length and density of the search for the ends of an edge.
    FxaaQuality quality = FxaaQuality::Low;
    /// Share of single pixels and thin lines that is smoothed away; 0 smooths edges alone. [0, 1]
    float subpixel = 0.75f;
    /// Contrast that makes an edge, as a share of the brightest luma around it. [0.03, 0.5]
    float edge_threshold = 0.166f;
    /// Contrast in luma below which there is no edge; it spares dark parts. [0, 0.5]
    float edge_threshold_min = 0.0833f;
};

[[nodiscard]] const EffectInfo& effect_info(const Fxaa&);

}  // namespace darkroom
