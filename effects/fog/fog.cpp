// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/fog.hpp>

#include "fog/fog_reference.hpp"
#include "shared/camera.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

constexpr auto fog_rows = describe(
    field<&Fog::color>("Colour of full fog, in the domain of the picture that the fog is laid over.", {0, 65504}),
    field<&Fog::density>("Rate at which the fog thickens beyond `start`; 0 is no fog.", {0, 1000}, unit::per_metre)
        .as_amount(),
    field<&Fog::start>("Distance at which the fog begins.", {0, 1e6}, unit::metres),
    field<&Fog::end>("Distance at which the fog is full; it must lie beyond `start`.", {0.001, 1e9}, unit::metres),
    field<&Fog::height_enabled>("Thins the fog with height."),
    field<&Fog::height_form>(
        "Height that counts: integral takes the whole way to the eye, end_point the height of the surface alone."),
    field<&Fog::height_falloff>("Rate at which the fog thins above `height_origin`.", {0, 1000}, unit::per_metre)
        .as_amount_of<&Fog::height_enabled>(),
    field<&Fog::height_origin>("World height up to which the fog has its full density.", {-1e6, 1e6}, unit::metres),
    field<&Fog::sky>("Covers the sky with full fog, at every height."),
    field<&Fog::horizon>("Angle above the horizon over which fog fades out of the sky, so that land and sky meet; at 0 "
                         "it ends at the horizon.",
                         {0, 90}, unit::degrees));

const Fog& fog_of(const void* parameters) { return *static_cast<const Fog*>(parameters); }

std::string conflict(const void* parameters) {
    const Fog& fog = fog_of(parameters);
    if (fog.end > fog.start) return {};
    return fmt::format("end = {}: must lie beyond start = {} m", fog.end, fog.start);
}

/// The constants of planar_distance(), then: optical depth is distance * range.y + range.z, from 0 to range.w; full fog
/// is 1 / more.x of it; the eye is more.z above the height from which the fog thins.
void fog_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Fog& fog = fog_of(parameters);
    const double density = fog.density, start = fog.start, span = std::max(double{fog.end} - start, 1e-6);
    const double rise = SolvedCamera(*context.camera).eye[1] - double{fog.height_origin};
    depth_vectors(parameters, context, out);
    out[1][1] = fog.density;
    out[1][2] = static_cast<float>(-density * start);
    out[1][3] = static_cast<float>(density * span);
    out[2] = {static_cast<float>(-1 / std::expm1(-std::max(density * span, 1e-30))), 0, static_cast<float>(rise),
              static_cast<float>(1 / std::max(fog_horizon_sine(fog), 1e-6))};
}

}  // namespace

const EffectInfo& effect_info(const Fog&) {
    static const EffectInfo info{
        .name = "fog",
        .doc = "Hides distant or low parts of the scene behind a colour.",
        .parameters = fog_rows.table(),
        .files = embedded_files("fog"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .needs = {FrameImage::Depth},
        .flat = {.documented = 80, .scene_linear = 30, .starts_on = false, .toggle_key = 8},
        .is_in_traced_light = true,
        .build =
            [](PassBuilder& builder) {
                builder.side("fog_depth", builder.frame_image(FrameImage::Depth), {});
                builder.end_constants(3, fog_constants);
            },
        .reference = fog_reference,
        .conflict = conflict,
        .is_identity = [](const void* parameters) { return fog_of(parameters).density == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
