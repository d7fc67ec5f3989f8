// SPDX-License-Identifier: MIT
#include <darkroom/effects/high_pass.hpp>

#include "high_pass/high_pass_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const HighPass&) {
    static const EffectInfo info{
        .name = "high_pass",
        .doc = "Keeps what is bright and turns the rest black.",
        .parameters = high_pass_rows.table(),
        .files = embedded_files("high_pass"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .reference = pointwise_reference<HighPass, high_pass_reference>,
    };
    return info;
}

}  // namespace darkroom
