// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/tonemap.hpp>

#include "tonemap/tonemap_reference.hpp"

namespace darkroom {

namespace {

// The member cannot be called `operator`, which is a keyword of C++; files may still say it.
constexpr auto tonemap_rows = describe(
    field<&Tonemap::curve>("Tone mapping operator.").formerly("operator"),
    field<&Tonemap::white>(
        "Luminance that reinhard_extended maps to white, and bt2390 to the peak; the other operators ignore it.",
        {0.1, 1024, Scale::Log}),
    field<&Tonemap::peak_nits>(
        "Peak luminance of the display, for bt2390, bt2390_ictcp and gt7; there 1.0 is 203 cd/m2.",
        {100, 10000, Scale::Log}, unit::nits));

ColorState makes(ColorState before, const void* parameters) {
    const Tonemap& values = *static_cast<const Tonemap*>(parameters);
    const bool has_peak = values.curve >= TonemapOperator::Bt2390;
    return {.domain = Domain::DisplayLinear,
            .white_nits = before.white_nits,
            .peak_nits = has_peak ? before.white_nits * values.peak_nits / 203 : before.white_nits};
}

}  // namespace

const EffectInfo& effect_info(const Tonemap&) {
    static const EffectInfo info{
        .name = "tonemap",
        .doc = "Brings the scene's light into the range of a display.",
        .parameters = tonemap_rows.table(),
        .files = embedded_files("tonemap"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .makes = makes,
        .flat = {.documented = 70, .scene_linear = 70, .starts_on = true},
        .works = {.in = WorkingSpace::Straight},
        .reference = pointwise_reference<Tonemap, tonemap_reference>,
    };
    return info;
}

}  // namespace darkroom
