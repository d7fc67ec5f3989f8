// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/high_pass.hpp>

#include "high_pass/high_pass_reference.hpp"

namespace darkroom {

namespace {

constexpr auto high_pass_rows = describe(
    field<&HighPass::threshold>("Colours of at least this luminance stay; 0 keeps all light.", {0, 65504}),
    field<&HighPass::knee>("Width below the threshold over which colours fade in; 0 is a hard edge.", {0, 65504}));

}  // namespace

const EffectInfo& effect_info(const HighPass&) {
    static const EffectInfo info{
        .name = "high_pass",
        .doc = "Keeps colours that are brighter than a threshold.",
        .parameters = high_pass_rows.table(),
        .files = embedded_files("high_pass"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 72, .scene_linear = 80},
        .works = {.in = WorkingSpace::Straight},
        .reference = pointwise_reference<HighPass, high_pass_reference>,
    };
    return info;
}

}  // namespace darkroom
