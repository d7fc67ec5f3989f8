// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/gamut_compression.hpp>

#include "gamut_compression/gamut_compression_reference.hpp"

namespace darkroom {

namespace {

constexpr auto gamut_compression_rows = describe(
    field<&GamutCompression::into>("Primaries of the display that the colours are made for."),
    field<&GamutCompression::limit>(
        "Distances from grey, towards cyan, magenta and yellow, that are moved to the edge of the gamut.", {1.001, 8}),
    field<&GamutCompression::threshold>("Distances from grey up to which colours stay as they are; the edge is at 1.",
                                        {0, 0.99}),
    field<&GamutCompression::power>(
        "Sharpness of the curve's bend: a larger value keeps more colours as they are and separates the others less.",
        {1, 8}));

}  // namespace

const EffectInfo& effect_info(const GamutCompression&) {
    static const EffectInfo info{
        .name = "gamut_compression",
        .doc = "Moves colours that a display cannot show into its gamut.",
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
