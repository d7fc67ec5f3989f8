// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/auto_exposure.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "auto_exposure/auto_exposure_reference.hpp"

namespace darkroom {

namespace {

constexpr Unit stops{"stops"}, stops_per_second{"stops/s"};

constexpr auto auto_exposure_rows = describe(
    field<&AutoExposure::compensation>("Stops that the metered brightness is brought above middle grey.", {-16, 16},
                                       stops),
    field<&AutoExposure::compensation_curve>(
        "Stops added (y) for metered stops from middle grey (x); an empty curve adds none.", {-16, 16}),
    field<&AutoExposure::low>("Share of the pixels, from the darkest on, that the meter leaves out.", {0, 1}),
    field<&AutoExposure::high>("Share of the pixels, from the darkest on, at which the meter stops.", {0, 1}),
    field<&AutoExposure::darkest>("Lowest brightness that the meter reports, from middle grey.", {-16, 16}, stops),
    field<&AutoExposure::brightest>("Highest brightness that the meter reports, from middle grey.", {-16, 16}, stops),
    field<&AutoExposure::speed_up>("Speed of adaption to a brighter picture; at 0 the exposure stays.", {0, 100},
                                   stops_per_second),
    field<&AutoExposure::speed_down>("Speed of adaption to a darker picture; at 0 the exposure stays.", {0, 100},
                                     stops_per_second),
    field<&AutoExposure::center_weight>("Share of weight that the borders lose against the centre.", {0, 1}),
    field<&AutoExposure::metering_mask>(
        "Picture whose red says how much pixels count, from 0 to 1, stretched over the whole; without one all do.")
        .as_picture());

const AutoExposure& values_of(const void* parameters) { return *static_cast<const AutoExposure*>(parameters); }

/// A count and a sum each.
constexpr std::uint32_t bins = 256, numbers = 2 * bins;
constexpr std::uint32_t invocations = 128, adapted_numbers = 4, histogram_numbers = 6 + bins;
/// Two points of the curve a vector, behind one of the rest.
constexpr std::uint32_t adapt_vectors = 1 + Curve::capacity / 2;

void adapt_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const AutoExposure& values = values_of(parameters);
    const auto way = [&](float speed) { return static_cast<float>(std::max(context.delta_time, 0.0) * double{speed}); };
    const std::size_t points = std::min<std::size_t>(values.compensation_curve.count, Curve::capacity);
    out[0] = {way(values.speed_up), way(values.speed_down), static_cast<float>(points), 0};
    for (std::size_t i = 0; i < Curve::capacity; ++i) {
        out[1 + i / 2][i % 2 * 2] = i < points ? values.compensation_curve.x[i] : 0;
        out[1 + i / 2][i % 2 * 2 + 1] = i < points ? values.compensation_curve.y[i] : 0;
    }
}

/// What a pixel counts is a sixteenth at most: 8 bits say it.
std::optional<PassImage> mask_image(PassBuilder& builder) {
    const ResourceData* const data = builder.resource(values_of(builder.parameters()).metering_mask);
    const auto* const picture = data == nullptr ? nullptr : std::get_if<ResourceImage>(data);
    if (picture == nullptr) return {};
    TableDesc desc{
        .name = "mask", .format = VK_FORMAT_R8_UNORM, .extent = {picture->width, picture->height, 1}, .data = {}};
    for (std::size_t i = 0; i < picture->rgba.size(); i += 4)
        desc.data.push_back(static_cast<std::byte>(auto_exposure_mask_code(picture->rgba[i])));
    return builder.table(desc);
}

void build(PassBuilder& builder) {
    using Access = ComputePassDesc::Access;
    const PassBuffer counts = builder.create_buffer("counts", 4 * numbers),
                     adapted = builder.value("auto_exposure", adapted_numbers),
                     histogram = builder.value("auto_exposure.histogram", histogram_numbers);
    builder.add_compute({.name = "clear",
                         .shader = "auto_exposure.glsl#clear",
                         .inputs = {},
                         .buffers = {{"auto_exposure_counts", counts, Access::Write}},
                         .workgroup = {invocations, 1},
                         .groups = {numbers / invocations, 1}});
    const std::optional<PassImage> mask = mask_image(builder);
    std::vector<KernelPassDesc::Input> inputs{{.name = "auto_exposure_picture", .image = builder.source()}};
    if (mask) inputs.push_back({.name = "auto_exposure_mask", .image = *mask});
    builder.add_compute({.name = "count",
                         .shader = mask ? "auto_exposure.glsl#count_masked" : "auto_exposure.glsl#count",
                         .inputs = inputs,
                         .buffers = {{"auto_exposure_counts", counts, Access::ReadWrite}},
                         .workgroup = {16, 8},
                         .shared_bytes = 4 * bins,
                         .tile = {64, 16}});
    builder.add_compute({.name = "adapt",
                         .shader = "auto_exposure.glsl#adapt",
                         .inputs = {},
                         .buffers = {{"auto_exposure_counts", counts},
                                     {"auto_exposure_adapted", adapted, Access::ReadWrite, "float"},
                                     {"auto_exposure_histogram", histogram, Access::ReadWrite, "float"}},
                         .workgroup = {invocations, 1},
                         .shared_bytes = (4 + 8) * invocations,
                         .groups = {1, 1},
                         .custom_vectors = adapt_vectors,
                         .constants = adapt_constants});
    builder.value_side("auto_exposure_adapted", adapted);
}

std::string conflict(const void* parameters) {
    const AutoExposure& values = values_of(parameters);
    if (values.high <= values.low) return fmt::format("high = {}: must lie beyond low = {}", values.high, values.low);
    if (values.brightest < values.darkest)
        return fmt::format("brightest = {}: must not lie below darkest = {} stops", values.brightest, values.darkest);
    return {};
}

/// Until the widest step there may be is done but for what makes half a code of 8 bits: at white, the steepest place of
/// sRGB, a stop is 80 of them.
std::uint32_t pre_roll(const void* parameters, double delta_time) {
    const AutoExposure& values = values_of(parameters);
    const Curve& curve = values.compensation_curve;
    double least = 0, most = 0;
    for (std::uint32_t i = 0; i < std::min<std::uint32_t>(curve.count, Curve::capacity); ++i) {
        least = std::min(least, double{curve.y[i]});
        most = std::max(most, double{curve.y[i]});
    }
    const double widest = double{values.brightest} - double{values.darkest} + most - least;
    const double way = std::max(widest - 1, 0.0) + std::log(80 / 0.5);
    return static_cast<std::uint32_t>(
        std::min(std::ceil(way / (double{std::min(values.speed_up, values.speed_down)} * delta_time)) + 1, 1e9));
}

}  // namespace

const EffectInfo& effect_info(const AutoExposure&) {
    static const EffectInfo info{
        .name = "auto_exposure",
        .doc = "Brings the metered brightness to middle grey, as an eye adapts.",
        .parameters = auto_exposure_rows.table(),
        .files = embedded_files("auto_exposure"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 59, .scene_linear = 59},
        .build = build,
        .reference = auto_exposure_reference,
        .conflict = conflict,
        .pre_roll = pre_roll,
    };
    return info;
}

}  // namespace darkroom
