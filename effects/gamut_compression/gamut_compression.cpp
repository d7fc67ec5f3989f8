// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/gamut_compression.hpp>

#include "gamut_compression/gamut_compression_reference.hpp"

namespace darkroom {

namespace {

constexpr auto gamut_compression_rows = describe(
    field<&GamutCompression::into>("The primaries that are to make the colours."),
    field<&GamutCompression::limit>(
        "Distances from grey, towards cyan, magenta and yellow, that come to lie on the edge.", {1.001, 8}),
    field<&GamutCompression::threshold>("Distances up to which colours stay; the edge is at 1.", {0, 0.99}),
    field<&GamutCompression::power>("How late the curve bends: more keeps more colour, and parts less of it.", {1, 8}));

}  // namespace

const EffectInfo& effect_info(const GamutCompression&) {
    static const EffectInfo info{
        .name = "gamut_compression",
        .doc = "Brings colours beyond a display's primaries within them.",
        .parameters = gamut_compression_rows.table(),
        .files = embedded_files("gamut_compression"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear) | Domains::only(Domain::DisplayLinear),
        .flat = {.documented = 68, .scene_linear = 68},
        .reference = pointwise_reference<GamutCompression, gamut_compression_reference>,
    };
    return info;
}

}  // namespace darkroom
