// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <darkroom/effects/fog.hpp>

#include "fog/fog_reference.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

const Fog& fog_of(const void* parameters) { return *static_cast<const Fog*>(parameters); }

std::string conflict(const void* parameters) {
    const Fog& fog = fog_of(parameters);
    if (fog.end > fog.start) return {};
    return fmt::format("end = {}: must lie beyond start = {} m", fog.end, fog.start);
}

}  // namespace

const EffectInfo& effect_info(const Fog&) {
    static const EffectInfo info{
        .name = "fog",
        .doc = "Hides what is far, or low, behind a colour.",
        .parameters = fog_rows.table(),
        .files = embedded_files("fog"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .needs = {.depth = true},
        .flat = {.documented = 80, .scene_linear = 55, .starts_on = false},
        .toggle_key = 8,
        .build =
            [](PassBuilder& builder) {
                builder.loaded_side("fog_distance", linear_depth(builder), {1e10f, 0, 0, 0});
            },
        .reference = fog_reference,
        .conflict = conflict,
        .is_identity = [](const void* parameters) { return fog_of(parameters).density == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
