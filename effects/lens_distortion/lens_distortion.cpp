// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/lens_distortion.hpp>

#include "lens_distortion/lens_distortion_reference.hpp"

namespace darkroom {

namespace {

constexpr auto lens_distortion_rows = describe(
    field<&LensDistortion::lens_distortion>(
        "Coefficient of the squared distance from the centre: above 0 a barrel, below 0 a pincushion.", {-0.3, 1}),
    field<&LensDistortion::quartic>("Coefficient of the fourth power of that distance; it bends mainly the corners.",
                                    {-0.2, 1}),
    field<&LensDistortion::dispersion>(
        "Amount added to the first coefficient for red and taken from it for blue: coloured fringes.", {-0.1, 0.1}),
    field<&LensDistortion::fill>("Scales the picture so that it just fills its frame."),
    field<&LensDistortion::evaluation>(
        "Place where the bend is computed: every pixel, or the vertices of a grid with interpolation between them.")
        .at_compile(),
    warp_grid_field<&LensDistortion::grid>());

const LensDistortion& lens_of(const void* parameters) { return *static_cast<const LensDistortion*>(parameters); }

/// The largest of 1 + k q + quartic q^2 for q in [first, 1].
double largest_factor(double k, double quartic, double first) {
    const auto at = [&](double q) { return 1 + k * q + quartic * q * q; };
    const double bend = quartic < 0 ? std::clamp(-k / (2 * quartic), first, 1.0) : first;
    return std::max({at(first), at(1), at(bend)});
}

void constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const LensDistortion& lens = lens_of(parameters);
    const LensDistortionWay way = lens_distortion_way(lens, context.frame_extent);
    out[0] = {way.half_size[0], way.half_size[1], way.scale, lens.dispersion == 0 ? 1.0f : 3.0f};
    out[1] = {lens.lens_distortion, lens.quartic, lens.dispersion, way.half_diagonal};
}

bool asks_for_grid(const void* parameters, const PassContext&, std::uint32_t) {
    return lens_of(parameters).evaluation == LensDistortionEvaluation::Vertex;
}

void build(PassBuilder& builder) {
    const LensDistortion& lens = lens_of(builder.parameters());
    PassImage grid;
    if (lens.evaluation == LensDistortionEvaluation::Vertex)
        grid = warp_grid(builder, lens.grid,
                         {.name = "grid",
                          .shader = "lens_distortion.glsl#grid",
                          .custom_vectors = 2,
                          .constants = constants,
                          .condition = asks_for_grid});
    builder.side("lens_distortion_vertices", grid, {});
    builder.end_constants(2, constants);
}

/// Nothing may be seen twice: r (1 + k r^2 + quartic r^4) must rise to the corner for every channel.
std::string conflict(const void* parameters) {
    const LensDistortion& lens = lens_of(parameters);
    const double k = double{lens.lens_distortion} - std::abs(double{lens.dispersion}), quartic = lens.quartic;
    const auto slope = [&](double q) { return 1 + 3 * k * q + 5 * quartic * q * q; };
    const double flattest = quartic > 0 ? std::clamp(-3 * k / (10 * quartic), 0.0, 1.0) : 1.0;
    if (std::min(slope(1), slope(flattest)) > 0) return {};
    return fmt::format("quartic = {}: folds the picture together with lens_distortion = {} and dispersion = {}",
                       lens.quartic, lens.lens_distortion, lens.dispersion);
}

bool is_identity(const void* parameters) {
    const LensDistortion& lens = lens_of(parameters);
    return lens.lens_distortion == 0.0f && lens.quartic == 0.0f && lens.dispersion == 0.0f;
}

}  // namespace

LensDistortionWay lens_distortion_way(const LensDistortion& lens, VkExtent2D extent) {
    const double width = extent.width, height = extent.height, diagonal = std::hypot(width, height);
    LensDistortionWay way{.half_size = {static_cast<float>(width / diagonal), static_cast<float>(height / diagonal)},
                          .half_diagonal = static_cast<float>(0.5 * diagonal)};
    // A pixel of the border reads inside exactly if its factor is at most 1, and borders lie from the middle of the
    // long sides to the corners.
    const double nearest = std::min(width, height) / diagonal;
    double largest = 0;
    for (const int side : {-1, 0, 1}) {
        const double k = double{lens.lens_distortion} + side * double{lens.dispersion};
        largest = std::max(largest, largest_factor(k, double{lens.quartic}, nearest * nearest));
    }
    if (lens.fill && largest > 0) way.scale = static_cast<float>(1 / largest);
    return way;
}

const EffectInfo& effect_info(const LensDistortion&) {
    static const EffectInfo info{
        .name = "lens_distortion",
        .doc = "Bends the picture as a lens does.",
        .parameters = lens_distortion_rows.table(),
        .files = embedded_files("lens_distortion"),
        .touch = Touch::Warp,
        .accepts = Domains::all(),
        .flat = {.documented = 85, .scene_linear = 58, .starts_on = true},
        .build = build,
        .reference = lens_distortion_reference,
        .conflict = conflict,
        .is_identity = is_identity,
    };
    return info;
}

}  // namespace darkroom
