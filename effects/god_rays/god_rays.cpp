// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/god_rays.hpp>

#include "god_rays/god_rays_reference.hpp"
#include "shared/camera.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

constexpr auto god_rays_rows = describe(
    field<&GodRays::intensity>("Amount of the streaks added to the picture.", {0, 64}).as_amount(),
    field<&GodRays::follows_light>("Takes the position of the frame's first light; without a light `position` counts."),
    field<&GodRays::position>("Position of the light: (0, 0) is the top left of the picture, (1, 1) the bottom right.",
                              {-4, 5}),
    field<&GodRays::radius>("Distance around the light in which the sky sends streaks, in heights of the picture.",
                            {0.01, 16}),
    field<&GodRays::threshold>("Sky above this luminance sends streaks; without depth, everything brighter does.",
                               {0, 65504}),
    field<&GodRays::ceiling>("Largest luminance above the threshold that counts.", {0, 65504}),
    field<&GodRays::density>("Share of the way to the light that a streak gathers from.", {0, 1}),
    field<&GodRays::decay>("Weight of the light at the end of the way; at the beginning it is 1.", {0.001, 1}),
    field<&GodRays::samples>("Number of steps on the way. Brightness does not depend on it, smoothness does.",
                             {1, 256}),
    field<&GodRays::tint>("Colour that multiplies the streaks.", {0, 64}));

const GodRays& god_rays_of(const void* parameters) { return *static_cast<const GodRays*>(parameters); }

GodRaysLight light_of(const void* parameters, const PassContext& context) {
    return god_rays_light(god_rays_of(parameters), context.camera,
                          context.lights.empty() ? nullptr : &context.lights.front());
}

bool is_seen(const void* parameters, const PassContext& context, std::uint32_t) {
    return light_of(parameters, context).fade > 0;
}

void mask_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const GodRays& rays = god_rays_of(parameters);
    const GodRaysLight light = light_of(parameters, context);
    const float aspect =
        static_cast<float>(context.frame_extent.width) / static_cast<float>(context.frame_extent.height);
    out[0] = {static_cast<float>(light.u), static_cast<float>(light.v), aspect, rays.radius};
    out[1] = {rays.threshold, rays.ceiling, 0, 0};
}

void march_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const GodRays& rays = god_rays_of(parameters);
    const GodRaysLight light = light_of(parameters, context);
    const auto samples = static_cast<float>(rays.samples);
    const float gain = rays.intensity * static_cast<float>(light.fade) / samples;
    out[0] = {static_cast<float>(light.u), static_cast<float>(light.v), rays.density / samples, samples};
    out[1] = {rays.tint.r * gain, rays.tint.g * gain, rays.tint.b * gain, std::pow(rays.decay, 1 / samples)};
}

/// The distance of everything where a frame has no depth: that of the sky.
PassImage sky_everywhere(PassBuilder& builder) {
    constexpr float sky = 1e10f;
    TableDesc table{.name = "sky", .format = VK_FORMAT_R32_SFLOAT, .data = std::vector<std::byte>(sizeof sky)};
    std::memcpy(table.data.data(), &sky, sizeof sky);
    return builder.table(table);
}

void build(PassBuilder& builder) {
    const PassImage distance =
        builder.has_frame_image(FrameImage::Depth) ? linear_depth(builder) : sky_everywhere(builder);
    const PassImage mask = builder.add({.name = "mask",
                                        .shader = "god_rays.glsl#mask",
                                        .inputs = {{.name = "god_rays_source", .image = builder.source()},
                                                   {.name = "god_rays_distance", .image = distance}},
                                        .output = builder.create({.name = "mask", .denominator = 4}),
                                        .custom_vectors = 2,
                                        .constants = mask_constants,
                                        .condition = is_seen});
    const PassImage streaks = builder.add({.name = "march",
                                           .shader = "god_rays.glsl#march",
                                           .inputs = {{.name = "god_rays_mask", .image = mask}},
                                           .output = builder.create({.name = "streaks", .denominator = 4}),
                                           .custom_vectors = 2,
                                           .constants = march_constants,
                                           .condition = is_seen});
    builder.side("god_rays_streaks", streaks, {0, 0, 0, 0});
}

}  // namespace

GodRaysLight god_rays_light(const GodRays& parameters, const Camera* camera, const Light* first_light) {
    GodRaysLight out{.u = double{parameters.position.x}, .v = double{parameters.position.y}};
    if (parameters.follows_light && camera != nullptr && first_light != nullptr) {
        const SolvedCamera eye(*camera);
        const auto& d = first_light->direction;
        const Vector3 view = eye.view_direction({double{d[0]}, double{d[1]}, double{d[2]}});
        if (!(view[2] < 0)) return out;
        // So far away that it does not matter where the camera is.
        constexpr double far = 1e9;
        const auto [u, v] = eye.uv({view[0] * far, view[1] * far, view[2] * far});
        if (!std::isfinite(u) || !std::isfinite(v)) return out;
        out.u = u;
        out.v = v;
    }
    const double outside = std::max({std::abs(out.u - 0.5) - 0.5, std::abs(out.v - 0.5) - 0.5, 0.0});
    out.fade = std::max(1 - outside / 0.5, 0.0);
    return out;
}

const EffectInfo& effect_info(const GodRays&) {
    static const EffectInfo info{
        .name = "god_rays",
        .doc = "Draws streaks that run away from a light in the picture.",
        .parameters = god_rays_rows.table(),
        .files = embedded_files("god_rays"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 42, .scene_linear = 40},
        .is_in_traced_light = true,
        .build = build,
        .reference = god_rays_reference,
        .is_identity = [](const void* parameters) { return god_rays_of(parameters).intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
