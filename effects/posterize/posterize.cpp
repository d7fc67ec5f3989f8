// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/posterize.hpp>

#include "posterize/posterize_reference.hpp"

namespace darkroom {

namespace {

constexpr auto posterize_rows =
    describe(field<&Posterize::levels>("Number of levels from 0 to 1, both included.", {2, 256}),
             field<&Posterize::mode>("Quantity that is rounded to a level."));

}  // namespace

const EffectInfo& effect_info(const Posterize&) {
    static const EffectInfo info{
        .name = "posterize",
        .doc = "Reduces the colours to a few levels.",
        .parameters = posterize_rows.table(),
        .files = embedded_files("posterize"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 76, .scene_linear = 84},
        .works = {.in = WorkingSpace::Straight},
        .reference = pointwise_reference<Posterize, posterize_reference>,
    };
    return info;
}

}  // namespace darkroom
