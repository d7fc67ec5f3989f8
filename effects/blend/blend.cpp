// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/blend.hpp>

#include "blend/blend_reference.hpp"

namespace darkroom {

namespace {

constexpr auto blend_rows =
    describe(field<&Blend::mode>("Formula that lays the second picture over the picture."),
             field<&Blend::amount>("Share of the blended picture; 0 leaves the picture as it is.", {0, 1}));

}  // namespace

const EffectInfo& effect_info(const Blend&) {
    static const EffectInfo info{
        .name = "blend",
        .doc = "Puts a second picture over the picture.",
        .parameters = blend_rows.table(),
        .files = embedded_files("blend"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .second = Second::InPlace,
        .reference = blend_image_reference,
        .is_identity = [](const void* parameters) { return static_cast<const Blend*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
