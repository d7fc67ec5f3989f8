// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/contrast_gamma.hpp>

#include "contrast_gamma/contrast_gamma_reference.hpp"

namespace darkroom {

namespace {

constexpr auto contrast_gamma_rows = describe(
    field<&ContrastGamma::contrast>("Factor of the encoded picture.", {1, 2}).as_amount().also_named("contrast", true),
    field<&ContrastGamma::gamma>("Exponent applied after the contrast: below 1 brightens.", {0.1, 4, Scale::Log})
        .as_amount()
        .also_named("gamma", true));

}  // namespace

const EffectInfo& effect_info(const ContrastGamma&) {
    static const EffectInfo info{
        .name = "contrast_gamma",
        .doc = "Sets contrast and gamma of the finished picture, interface included.",
        .parameters = contrast_gamma_rows.table(),
        .files = embedded_files("contrast_gamma"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::Encoded),
        .flat = {.documented = 125, .scene_linear = 125, .ui = UiPart::Picture},
        .works = {.in = WorkingSpace::Encoded},
        .reference = pointwise_reference<ContrastGamma, contrast_gamma_reference>,
        .is_identity =
            [](const void* parameters) {
                const ContrastGamma& values = *static_cast<const ContrastGamma*>(parameters);
                return values.contrast == 1.0f && values.gamma == 1.0f;
            },
    };
    return info;
}

}  // namespace darkroom
