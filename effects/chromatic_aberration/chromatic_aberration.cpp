// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/chromatic_aberration.hpp>

#include "chromatic_aberration/chromatic_aberration_reference.hpp"

namespace darkroom {

namespace {

constexpr auto chromatic_aberration_rows = describe(
    field<&ChromaticAberration::chromatic_aberration>("Separation of red and blue: each 1 moves them by 0.012 of the "
                                                      "distance from the centre; 0.001 and less do nothing.",
                                                      {0, 8})
        .as_amount());

}  // namespace

const EffectInfo& effect_info(const ChromaticAberration&) {
    static const EffectInfo info{
        .name = "chromatic_aberration",
        .doc = "Separates red and blue toward the edges.",
        .parameters = chromatic_aberration_rows.table(),
        .files = embedded_files("chromatic_aberration"),
        .touch = Touch::Warp,
        .accepts = Domains::all(),
        .flat = {.documented = 20, .scene_linear = 56, .starts_on = true},
        .reference = chromatic_aberration_reference,
        .is_identity =
            [](const void* parameters) {
                return static_cast<const ChromaticAberration*>(parameters)->chromatic_aberration <= 0.001f;
            },
    };
    return info;
}

}  // namespace darkroom
