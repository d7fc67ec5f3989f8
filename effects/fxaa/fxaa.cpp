// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/fxaa.hpp>

#include "fxaa/fxaa_reference.hpp"

namespace darkroom {

namespace {

constexpr auto fxaa_rows = describe(
    field<&Fxaa::quality>("Length and density of the search for the ends of an edge."),
    field<&Fxaa::subpixel>("Share of single pixels and thin lines that is smoothed away; 0 smooths edges alone.",
                           {0, 1}),
    field<&Fxaa::edge_threshold>("Contrast that makes an edge, as a share of the brightest luma around it.",
                                 {0.03, 0.5}),
    field<&Fxaa::edge_threshold_min>("Contrast in luma below which there is no edge; it spares dark parts.", {0, 0.5}));

}  // namespace

const EffectInfo& effect_info(const Fxaa&) {
    static const EffectInfo info{
        .name = "fxaa",
        .doc = "Smooths the stairs of edges.",
        .parameters = fxaa_rows.table(),
        .files = embedded_files("fxaa"),
        .touch = Touch::Warp,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::Encoded),
        .flat = {.documented = 95, .scene_linear = 95, .starts_on = true},
        .works = {.in = WorkingSpace::Light},
        .reference = fxaa_reference,
    };
    return info;
}

}  // namespace darkroom
