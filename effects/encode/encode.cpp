// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/encode.hpp>

#include "encode/encode_reference.hpp"

namespace darkroom {

namespace {

constexpr auto encode_rows = describe(
    field<&Encode::transfer>("The curve of the display or file that the picture is for."),
    field<&Encode::white_nits>("Luminance of linear 1.0; for pq and scrgb.", {1, 10000, Scale::Log}, unit::nits),
    field<&Encode::peak_nits>("What is brighter is clipped, channel by channel; for pq and scrgb.",
                              {1, 10000, Scale::Log}, unit::nits));

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
