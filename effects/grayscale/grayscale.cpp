// SPDX-License-Identifier: MIT
#include <darkroom/effects/grayscale.hpp>

#include "grayscale/grayscale_reference.hpp"

namespace darkroom {

const EffectInfo& effect_info(const Grayscale&) {
    static const EffectInfo info{
        .name = "grayscale",
        .doc = "Takes the colour out and keeps the luminance.",
        .parameters = grayscale_rows.table(),
        .files = embedded_files("grayscale"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .reference = pointwise_reference<Grayscale, grayscale_reference>,
        .is_identity = [](const void* parameters) { return static_cast<const Grayscale*>(parameters)->amount == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
