// SPDX-License-Identifier: MIT
#include <darkroom/effects/negative.hpp>

#include "negative/negative_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Negative&) {
    static const EffectInfo info{
        .name = "negative",
        .doc = "Turns the picture into its negative.",
        .parameters = negative_rows.table(),
        .files = embedded_files("negative"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .reference = pointwise_reference<Negative, negative_reference>,
        .is_identity = [](const void* parameters) { return static_cast<const Negative*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
