// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/vignette.hpp>

#include "vignette/vignette_reference.hpp"

namespace darkroom {

namespace {

constexpr auto vignette_rows = describe(
    field<&Vignette::intensity>("Darkening of the corners: their factor is 1 - intensity.", {0, 1}).as_amount(),
    field<&Vignette::smoothness>("Exponent of the falloff; a larger one keeps more of the middle untouched.",
                                 {0.1, 16}));

}  // namespace

const EffectInfo& effect_info(const Vignette&) {
    static const EffectInfo info{
        .name = "vignette",
        .doc = "Darkens the corners of the picture.",
        .parameters = vignette_rows.table(),
        .files = embedded_files("vignette"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 110, .scene_linear = 75, .starts_on = false},
        .reference = pointwise_reference<Vignette, vignette_reference>,
        .is_identity =
            [](const void* parameters) { return static_cast<const Vignette*>(parameters)->intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
