// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/sharpen.hpp>

#include "sharpen/sharpen_reference.hpp"

namespace darkroom {

namespace {

constexpr auto sharpen_rows = describe(
    field<&Sharpen::mode>("Published method that sharpens."),
    field<&Sharpen::stops>(
        "Reduction of the strength, in stops: 0 is the most that the method allows, each stop halves it.", {-8, 0}));

}  // namespace

const EffectInfo& effect_info(const Sharpen&) {
    static const EffectInfo info{
        .name = "sharpen",
        .doc = "Sharpens the picture as far as its contrast allows, without halos.",
        .parameters = sharpen_rows.table(),
        .files = embedded_files("sharpen"),
        .touch = Touch::Warp,
        .accepts = Domains::all(),
        .flat = {.documented = 97, .scene_linear = 97},
        .reference = sharpen_reference,
    };
    return info;
}

}  // namespace darkroom
