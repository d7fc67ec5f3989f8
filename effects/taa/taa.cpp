// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/taa.hpp>

#include "shared/scene_images.hpp"
#include "taa/taa_reference.hpp"

namespace darkroom {

namespace {

constexpr auto taa_rows = describe(
    field<&Taa::sharpness>("Sharpening of the gathered picture: 0 is none, 1 the most that its contrast allows.",
                           {0, 1})
        .at_compile(),
    field<&Taa::stability>("Number of frames that a still surface is gathered over: 0 is 8 frames, 1 is 128.", {0, 1}));

const Taa& taa_of(const void* parameters) { return *static_cast<const Taa*>(parameters); }

float ratio(std::uint32_t a, std::uint32_t b) { return static_cast<float>(a) / static_cast<float>(b); }

/// Of what is shown, between 0 and 1: halves are coarse near 1, which is bright light.
VkFormat shown_format(const PassBuilder& builder) {
    return builder.is_written(VK_FORMAT_R16G16B16A16_UNORM) ? VK_FORMAT_R16G16B16A16_UNORM
                                                            : VK_FORMAT_R16G16B16A16_SFLOAT;
}

/// Jitter is told in pixels of the scene: in those of the picture.
std::array<float, 2> in_pixels(const std::array<float, 2>& jitter, const PassContext& context) {
    return {jitter[0] * ratio(context.frame_extent.width, context.scene_extent.width),
            jitter[1] * ratio(context.frame_extent.height, context.scene_extent.height)};
}

template <bool is_of_codes>
void gather_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Camera& camera = *context.camera;
    const VkExtent2D in = context.frame_extent, made = context.output_extent;
    const std::array<float, 2> jitter = in_pixels(camera.jitter, context),
                               before = in_pixels(camera.previous_jitter, context);
    out[0] = {ratio(in.width, made.width), ratio(in.height, made.height), jitter[0], jitter[1]};
    out[1] = {ratio(made.width, in.width), ratio(made.height, in.height), before[0], before[1]};
    const TaaDepthBefore depth = taa_depth_before(camera);
    const auto [ray, flat] = ray_constants(camera, in, 1);
    const auto row = [&](std::size_t i) { return static_cast<float>(depth.row[i]); };
    out[2] = {-row(0) * ray[0], -row(1) * ray[1], row(2) - row(0) * ray[2] - row(1) * ray[3],
              -row(0) * flat[2] - row(1) * flat[3] - row(3)};
    out[3] = {-row(0) * flat[0], -row(1) * flat[1], context.has_history ? 1.0f : 0.0f,
              static_cast<float>(context.frame_index % 64)};
    const TaaExponents exponents(std::sqrt(double{out[1][0]} * double{out[1][1]}));
    out[4] = {static_cast<float>(1 / taa_max_frames(taa_of(parameters))),
              static_cast<float>(-exponents.narrow / std::log(2)), static_cast<float>(-exponents.wide / std::log(2)),
              is_of_codes ? 1.0f : 0.0f};
}

void motion_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    const Camera& camera = *context.camera;
    const TaaMotion motion(camera);
    const auto [ray, flat] = ray_constants(camera, context.frame_extent, 1);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) out[i][j] = static_cast<float>(motion.rows[i][j]);
    out[3] = ray;
    out[4] = flat;
    const std::array<float, 2> jitter = in_pixels(camera.jitter, context),
                               before = in_pixels(camera.previous_jitter, context);
    out[5] = {static_cast<float>(context.frame_extent.width), static_cast<float>(context.frame_extent.height),
              jitter[0] - before[0], jitter[1] - before[1]};
}

PassImage motion_of_camera(PassBuilder& builder, PassImage distance) {
    return builder.add({.name = "motion of the camera",
                        .shader = "taa.glsl#motion",
                        .inputs = {{.name = "taa_distance", .image = distance}},
                        .output = builder.create({.name = "motion", .format = VK_FORMAT_R16G16_SFLOAT}),
                        .custom_vectors = 6,
                        .constants = motion_constants});
}

template <bool has_transparency>
void mask_constants(const void*, const PassContext&, std::span<PassVector> out) {
    out[0] = {has_transparency ? static_cast<float>(taa::mask_per_change) : 0.0f, 0, 0, 0};
}

/// What the past tells little of.
PassImage mask(PassBuilder& builder) {
    const PassImage reactive = builder.frame_image(FrameImage::Reactive);
    const bool has_transparency = builder.has_frame_image(FrameImage::Transparency);
    if (!has_transparency && !builder.has_frame_image(FrameImage::Reactive)) return reactive;
    return builder.add({.name = "mask",
                        .shader = "taa.glsl#mask",
                        .inputs = {{.name = "taa_color", .image = builder.picture()},
                                   {.name = "taa_transparency", .image = builder.frame_image(FrameImage::Transparency)},
                                   {.name = "taa_reactive", .image = reactive},
                                   {.name = "taa_exposure", .image = builder.frame_image(FrameImage::Exposure)}},
                        .output = builder.create({.name = "mask", .format = VK_FORMAT_R8G8_UNORM}),
                        .custom_vectors = 1,
                        .constants = has_transparency ? mask_constants<true> : mask_constants<false>});
}

void sharpen_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {static_cast<float>(taa_sharpening(taa_of(parameters))), 0, 0, 0};
}

void build(PassBuilder& builder) {
    const PassBuilder::History distance = builder.history({.name = "distance", .format = VK_FORMAT_R16_SFLOAT});
    const PassImage inverse =
        builder.add({.name = "distance",
                     .shader = "taa.glsl#distance",
                     .inputs = {{.name = "taa_depth", .image = builder.frame_image(FrameImage::Depth)}},
                     .output = distance.current,
                     .custom_vectors = 2,
                     .constants = depth_vectors});
    const PassImage motion =
        builder.has_frame_image(FrameImage::Velocity) ? velocity(builder) : motion_of_camera(builder, inverse);
    const VkFormat format = shown_format(builder);
    const PassBuilder::History shown = builder.history({.name = "shown", .format = format, .is_of_output = true});
    const PassBuilder::History kept =
        builder.history({.name = "kept", .format = VK_FORMAT_R8G8_UNORM, .is_of_output = true});
    const std::vector<PassImage> made = builder.add_all(
        {.name = "gather",
         .shader = "taa.glsl#gather",
         .inputs = {{.name = "taa_color", .image = builder.picture()},
                    {.name = "taa_distance", .image = inverse},
                    {.name = "taa_distance_before", .image = distance.previous},
                    {.name = "taa_velocity", .image = motion},
                    {.name = "taa_mask", .image = mask(builder)},
                    {.name = "taa_exposure", .image = builder.frame_image(FrameImage::Exposure)},
                    {.name = "taa_shown_before", .image = shown.previous},
                    {.name = "taa_kept_before", .image = kept.previous}},
         .output = shown.current,
         .more_outputs = {kept.current, builder.create({.name = "gathered", .is_of_output = true})},
         .custom_vectors = 5,
         .constants = format == VK_FORMAT_R16G16B16A16_UNORM ? gather_constants<true> : gather_constants<false>});
    if (made.empty()) return;
    if (taa_of(builder.parameters()).sharpness == 0.0f) {
        builder.result(made.back());
        return;
    }
    builder.result(
        builder.add({.name = "sharpen",
                     .shader = "taa.glsl#sharpen",
                     .inputs = {{.name = "taa_gathered", .image = made.back()},
                                {.name = "taa_exposure", .image = builder.frame_image(FrameImage::Exposure)}},
                     .output = builder.create({.name = "sharp", .is_of_output = true}),
                     .custom_vectors = 1,
                     .constants = sharpen_constants}));
}

}  // namespace

const EffectInfo& effect_info(const Taa&) {
    static const EffectInfo info{
        .name = "taa",
        .doc = "Gathers the frames of a jittered camera: smooth edges, and more pixels than were drawn.",
        .parameters = taa_rows.table(),
        .files = embedded_files("taa"),
        .touch = Touch::History,
        .accepts = Domains::only(Domain::SceneLinear),
        .needs = {FrameImage::Depth, FrameImage::Reactive, FrameImage::Transparency, FrameImage::Exposure},
        .flat = {.documented = 41, .scene_linear = 42},
        .output_scale = {.is_of_output = true},
        .build = build,
        .reference = taa_reference,
        .pre_roll = [](const void* parameters, double) { return taa_pre_roll(taa_of(parameters)); },
    };
    return info;
}

}  // namespace darkroom
