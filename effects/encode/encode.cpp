// SPDX-License-Identifier: MIT
#include <darkroom/effects/encode.hpp>

#include "encode/encode_reference.hpp"

namespace darkroom {

namespace {

bool is_none(const void* parameters) {
    return static_cast<const Encode*>(parameters)->transfer == TransferFunction::None;
}

}  // namespace

const EffectInfo& effect_info(const Encode&) {
    static const EffectInfo info{
        .name = "encode",
        .doc = "Turns linear light into the code values of a display or file.",
        .parameters = encode_rows.table(),
        .files = embedded_files("encode"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::SceneLinear),
        .makes = [](Domain before, const void* parameters) { return is_none(parameters) ? before : Domain::Encoded; },
        .flat = {.documented = 90, .scene_linear = 90, .starts_on = true},
        .is_last_step = true,
        .reference = pointwise_reference<Encode, encode_reference>,
        .is_identity = is_none,
    };
    return info;
}

}  // namespace darkroom
