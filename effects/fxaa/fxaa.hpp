// SPDX-License-Identifier: MIT
#pragma once
// Fast approximate anti-aliasing: smooths the stairs of edges in the finished picture, by looking along each edge for
// where its step begins and ends. It knows the picture alone, so it softens small text and cannot mend what flickers.

#include <darkroom/effect.hpp>

namespace darkroom {

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
inline constexpr auto fxaa_rows = describe(
    field<&Fxaa::quality>("How far and how densely the ends of an edge are searched."),
    field<&Fxaa::subpixel>("How much of single pixels and thin lines is smoothed away; 0 leaves all but edges.",
                           {0, 1}),
    field<&Fxaa::edge_threshold>("Contrast that makes an edge, as a part of the brightest luma around.", {0.03, 0.5}),
    field<&Fxaa::edge_threshold_min>("Contrast in luma below which nothing is an edge: spares the dark.", {0, 0.5}));

[[nodiscard]] const EffectInfo& effect_info(const Fxaa&);

}  // namespace darkroom
