// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/exposure.hpp>

#include "exposure/exposure_reference.hpp"

namespace darkroom {

namespace {

constexpr auto exposure_rows = describe(
    field<&Exposure::exposure>("Factor of the scene's light; 2 is one stop brighter.", {0, 1024}, unit::multiplier));

}  // namespace

const EffectInfo& effect_info(const Exposure&) {
    static const EffectInfo info{
        .name = "exposure",
        .doc = "Scales the scene's light before tone mapping.",
        .parameters = exposure_rows.table(),
        .files = embedded_files("exposure"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 60, .scene_linear = 60, .starts_on = true},
        .reference = pointwise_reference<Exposure, exposure_reference>,
        .is_identity =
            [](const void* parameters) { return static_cast<const Exposure*>(parameters)->exposure == 1.0f; },
        .exposure = [](const void* parameters) { return static_cast<const Exposure*>(parameters)->exposure; },
    };
    return info;
}

}  // namespace darkroom
