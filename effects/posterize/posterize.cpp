// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/posterize.hpp>

#include "posterize/posterize_reference.hpp"

namespace darkroom {

namespace {

constexpr auto posterize_rows =
    describe(field<&Posterize::levels>("How many levels there are from 0 to 1, both among them.", {2, 256}),
             field<&Posterize::mode>("What is rounded to a level."));

}  // namespace

const EffectInfo& effect_info(const Posterize&) {
    static const EffectInfo info{
        .name = "posterize",
        .doc = "Leaves few levels of many.",
        .parameters = posterize_rows.table(),
        .files = embedded_files("posterize"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 76, .scene_linear = 84},
        .maps_colors = true,
        .reference = pointwise_reference<Posterize, posterize_reference>,
    };
    return info;
}

}  // namespace darkroom
