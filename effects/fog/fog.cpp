// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/fog.hpp>
#include <numbers>

#include "fog/fog_reference.hpp"
#include "shared/camera.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

const Fog& fog_of(const void* parameters) { return *static_cast<const Fog*>(parameters); }

std::string conflict(const void* parameters) {
    const Fog& fog = fog_of(parameters);
    if (fog.end > fog.start) return {};
    return fmt::format("end = {}: must lie beyond start = {} m", fog.end, fog.start);
}

/// The share of the fog's colour at x metres behind `start` is x (curve.x + curve.y x) + curve.z (1 - 2^(curve.w x)),
/// and `range` is the depth of the sky, start, and the largest x. With height it is multiplied by 2^(height.x max(y,
/// 0)), with y the rise above the camera plus height.y; the sky lies at the distance height.z.
void fog_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Fog& fog = fog_of(parameters);
    const DepthConstants depth = depth_constants(*context.camera);
    const double span = std::max(double{fog.end} - double{fog.start}, 1e-6);
    const double density = std::max(double{fog.density}, 1e-30);
    const double coverage = -std::expm1(-density * span);
    out[0] = depth.distance;
    out[1] = {depth.sky, fog.start, static_cast<float>(span), 0};
    // In single precision 1 - 2^x would lose what thin fog is made of. The parabola that has the curve's slope at 0 and
    // its value at the end is within 1e-5 of it there.
    constexpr double thin = 0.01;
    const double slope = density / coverage;
    if (density * span < thin)
        out[2] = {static_cast<float>(slope), static_cast<float>((1 / span - slope) / span), 0, 0};
    else
        out[2] = {0, 0, static_cast<float>(1 / coverage), static_cast<float>(-density * std::numbers::log2e)};
    const SolvedCamera camera(*context.camera);
    out[3] = {static_cast<float>(-double{fog.height_falloff} * std::numbers::log2e),
              static_cast<float>(camera.eye[1] - double{fog.height_origin}), fog.end, 0};
}

}  // namespace

const EffectInfo& effect_info(const Fog&) {
    static const EffectInfo info{
        .name = "fog",
        .doc = "Hides what is far, or low, behind a colour.",
        .parameters = fog_rows.table(),
        .files = embedded_files("fog"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .needs = {.depth = true},
        .flat = {.documented = 80, .scene_linear = 55, .starts_on = false},
        .toggle_key = 8,
        .build =
            [](PassBuilder& builder) {
                builder.loaded_side("fog_depth", builder.frame_image(FrameImage::Depth), {});
                builder.end_constants(4, fog_constants);
            },
        .reference = fog_reference,
        .conflict = conflict,
        .is_identity = [](const void* parameters) { return fog_of(parameters).density == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
