// SPDX-License-Identifier: MIT
#include <darkroom/effects/tonemap.hpp>

#include "tonemap/tonemap_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Tonemap&) {
    static const EffectInfo info{
        .name = "tonemap",
        .doc = "Brings the scene's light into the range of a display.",
        .parameters = tonemap_rows.table(),
        .files = embedded_files("tonemap"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .makes = [](Domain, const void*) { return Domain::DisplayLinear; },
        .flat = {.documented = 70, .scene_linear = 70, .starts_on = true},
        .reference = pointwise_reference<Tonemap, tonemap_reference>,
    };
    return info;
}

}  // namespace darkroom
