// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/negative.hpp>

#include "negative/negative_reference.hpp"

namespace darkroom {

namespace {

constexpr auto negative_rows =
    describe(field<&Negative::amount>("Share of the negative; 0 leaves the picture as it is.", {0, 1}));

}  // namespace

const EffectInfo& effect_info(const Negative&) {
    static const EffectInfo info{
        .name = "negative",
        .doc = "Turns the picture into its negative.",
        .parameters = negative_rows.table(),
        .files = embedded_files("negative"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 74, .scene_linear = 82},
        .works = {.in = WorkingSpace::Straight},
        .reference = pointwise_reference<Negative, negative_reference>,
        .is_identity = [](const void* parameters) { return static_cast<const Negative*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
