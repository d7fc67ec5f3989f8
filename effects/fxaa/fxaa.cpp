// SPDX-License-Identifier: MIT
#include <darkroom/effects/fxaa.hpp>

#include "fxaa/fxaa_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Fxaa&) {
    static const EffectInfo info{
        .name = "fxaa",
        .doc = "Smooths the stairs of edges.",
        .parameters = fxaa_rows.table(),
        .files = embedded_files("fxaa"),
        .touch = Touch::Warp,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::Encoded),
        .flat = {.documented = 95, .scene_linear = 95, .starts_on = false},
        .reference = fxaa_reference,
    };
    return info;
}

}  // namespace darkroom
