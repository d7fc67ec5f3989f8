// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/radial_blur.hpp>

#include "radial_blur/radial_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr auto radial_blur_rows = describe(
    field<&RadialBlur::radial_blur>("Length and strength of the streaks; 0.001 and less do nothing.", {0, 4})
        .as_amount(),
    field<&RadialBlur::center>(
        "Point that the streaks run from: (0, 0) is the top left of the picture, (1, 1) the bottom right.", {-1, 2}));

}  // namespace

const EffectInfo& effect_info(const RadialBlur&) {
    static const EffectInfo info{
        .name = "radial_blur",
        .doc = "Smears the picture away from a centre.",
        .parameters = radial_blur_rows.table(),
        .files = embedded_files("radial_blur"),
        .touch = Touch::Warp,
        .accepts = Domains::all(),
        .flat = {.documented = 10, .scene_linear = 54, .starts_on = true},
        .reference = radial_blur_reference,
        .is_identity =
            [](const void* parameters) { return static_cast<const RadialBlur*>(parameters)->radial_blur <= 0.001f; },
    };
    return info;
}

}  // namespace darkroom
