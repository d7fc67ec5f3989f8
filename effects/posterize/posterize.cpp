// SPDX-License-Identifier: MIT
#include <darkroom/effects/posterize.hpp>

#include "posterize/posterize_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Posterize&) {
    static const EffectInfo info{
        .name = "posterize",
        .doc = "Leaves few levels of many.",
        .parameters = posterize_rows.table(),
        .files = embedded_files("posterize"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .reference = pointwise_reference<Posterize, posterize_reference>,
    };
    return info;
}

}  // namespace darkroom
