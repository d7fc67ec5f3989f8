// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/grayscale.hpp>

#include "grayscale/grayscale_reference.hpp"

namespace darkroom {

namespace {

constexpr auto grayscale_rows =
    describe(field<&Grayscale::amount>("Share of the colour that is removed; 0 leaves the picture as it is.", {0, 1}));

}  // namespace

const EffectInfo& effect_info(const Grayscale&) {
    static const EffectInfo info{
        .name = "grayscale",
        .doc = "Removes the colour and keeps the luminance.",
        .parameters = grayscale_rows.table(),
        .files = embedded_files("grayscale"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 75, .scene_linear = 83},
        .reference = pointwise_reference<Grayscale, grayscale_reference>,
        .is_identity = [](const void* parameters) { return static_cast<const Grayscale*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
