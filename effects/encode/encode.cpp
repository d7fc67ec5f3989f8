// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/encode.hpp>

#include "encode/encode_reference.hpp"

namespace darkroom {

namespace {

constexpr auto encode_rows =
    describe(field<&Encode::transfer>(
                 "Encoding of the display or file that the picture is for: transfer function and primaries."),
             field<&Encode::white_nits>("Luminance of linear 1.0; only pq, hlg and scrgb use it.",
                                        {1, 10000, Scale::Log}, unit::nits),
             field<&Encode::peak_nits>("Luminance at which each channel is clipped; only pq, hlg and scrgb use it.",
                                       {1, 10000, Scale::Log}, unit::nits));

bool is_none(const void* parameters) {
    return static_cast<const Encode*>(parameters)->transfer == TransferFunction::None;
}

ColorState makes(ColorState before, const void* parameters) {
    const Encode& encode = *static_cast<const Encode*>(parameters);
    ColorState out = srgb_color;
    out.white_nits = out.peak_nits = before.white_nits;
    const auto high_range = [&](Transfer transfer, Primaries primaries) {
        return ColorState{Domain::Encoded, primaries, transfer, encode.white_nits, encode.peak_nits};
    };
    switch (encode.transfer) {
        case TransferFunction::Srgb:
            break;
        case TransferFunction::Gamma22:
            out.transfer = Transfer::Gamma22;
            break;
        case TransferFunction::Pq:
            return high_range(Transfer::Pq, Primaries::Rec2020);
        case TransferFunction::Scrgb:
            return high_range(Transfer::Scrgb, Primaries::Rec709);
        case TransferFunction::None:
            return before;
        case TransferFunction::Hlg:
            return high_range(Transfer::Hlg, Primaries::Rec2020);
        case TransferFunction::P3:
            out.primaries = Primaries::P3;
            break;
    }
    return out;
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
        .makes = makes,
        .flat = {.documented = 90, .scene_linear = 90, .starts_on = true},
        .works = {.in = WorkingSpace::Straight},
        .is_last_step = true,
        .reference = pointwise_reference<Encode, encode_reference>,
        .is_identity = is_none,
    };
    return info;
}

}  // namespace darkroom
