// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/motion_blur.hpp>
#include <string>

#include "motion_blur/motion_blur_reference.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

constexpr auto motion_blur_rows = describe(
    field<&MotionBlur::shutter_angle>("Time that the shutter is open: 360 is the whole time from frame to frame.",
                                      {0, 720}, unit::degrees)
        .as_amount(),
    field<&MotionBlur::max_radius>(
        "Largest distance that a point smears to either side, in hundredths of the picture's height.", {0.1, 3}),
    field<&MotionBlur::samples>("Number of points along the way that a pixel reads; an odd number counts as one less.",
                                {2, 64})
        .as_loop_count(),
    field<&MotionBlur::resolution>("Size of the smeared picture, as a share of each side.").at_compile());

const MotionBlur& blur_of(const void* parameters) { return *static_cast<const MotionBlur*>(parameters); }

/// Where the distances come from: the frame's depth, or half_depth().
enum class Distances : std::uint8_t { Frame, Half };

/// How far velocities reach, and how depths are distances; see the shaders. After a cut nothing has a velocity.
template <std::uint32_t denominator, Distances from>
void reach_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const MotionBlur& blur = blur_of(parameters);
    const DepthConstants depth = from == Distances::Half ? DepthConstants{} : depth_constants(*context.camera);
    constexpr float pixels{denominator};
    const float open = context.camera->is_cut ? 0.0f : blur.shutter_angle / 360.0f;
    const float limit = blur.max_radius / 100.0f * static_cast<float>(context.frame_extent.height);
    out[0] = {open / 2 / pixels, std::max(limit / pixels, 1e-3f), from == Distances::Half ? -pixels : pixels,
              depth.sky};
    out[1] = depth.distance;
}

using Rows = std::array<std::array<double, 4>, 4>;

Rows rows_of(const Matrix& matrix) {
    Rows out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column) out[row][column] = matrix[column * 4 + row];
    return out;
}

Rows product(const Rows& a, const Rows& b) {
    Rows out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            for (std::size_t i = 0; i < 4; ++i) out[row][column] += a[row][i] * b[i][column];
    return out;
}

/// View matrices turn and move: the transposed turn, and the way back.
Rows inverse_of(const Rows& view) {
    Rows out{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            out[row][column] = view[column][row];
            out[row][3] -= view[column][row] * view[column][3];
        }
    out[3][3] = 1;
    return out;
}

/// From view space to x, y (down) and w of the clip space of a moment ago.
template <std::uint32_t denominator, Distances from>
void camera_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Camera& camera = *context.camera;
    reach_constants<denominator, from>(parameters, context, out);
    const Rows before = product(rows_of(camera.previous_projection),
                                product(rows_of(camera.previous_view), inverse_of(rows_of(camera.view))));
    const double down = camera.is_y_down ? 1 : -1;
    for (std::size_t i = 0; i < 4; ++i) {
        out[2][i] = static_cast<float>(before[0][i]);
        out[3][i] = static_cast<float>(before[1][i] * down);
        out[4][i] = static_cast<float>(before[3][i]);
    }
    // The picture's size, and what a point that stands still moves by as the jitter changes.
    out[5] = {static_cast<float>(context.frame_extent.width), static_cast<float>(context.frame_extent.height),
              camera.jitter[0] - camera.previous_jitter[0], camera.jitter[1] - camera.previous_jitter[1]};
}

/// By what its velocity image says, else by the camera's motion.
template <std::uint32_t denominator, Distances from>
PassImage add_motion(PassBuilder& builder, PassImage depth) {
    const bool is_given = builder.has_frame_image(FrameImage::Velocity);
    KernelPassDesc desc{
        .name = is_given ? "motion" : "motion of the camera",
        .shader = is_given ? "motion_blur.glsl#given" : "motion_blur.glsl#camera",
        .inputs = {{.name = "motion_blur_depth", .image = depth}},
        .output = builder.create({.name = "motion", .denominator = denominator}),
        .custom_vectors = is_given ? 2u : 6u,
        .constants = is_given ? reach_constants<denominator, from> : camera_constants<denominator, from>};
    if (is_given) desc.inputs.push_back({.name = "motion_blur_velocity", .image = velocity(builder)});
    return builder.add(desc);
}

PassImage add_motion(PassBuilder& builder, bool is_half) {
    const PassImage depth = builder.frame_image(FrameImage::Depth);
    if (!is_half) return add_motion<1, Distances::Frame>(builder, depth);
    const PassImage half = half_depth_if_made(builder);
    const bool is_made = half.index != PassImage{}.index;
    return is_made ? add_motion<2, Distances::Half>(builder, half) : add_motion<2, Distances::Frame>(builder, depth);
}

/// The picture as it is smeared.
PassImage add_color(PassBuilder& builder, bool is_half) {
    KernelPassDesc desc{.name = is_half ? "half size" : "clean",
                        .shader = is_half ? "motion_blur.glsl#half" : "motion_blur.glsl#clean",
                        .inputs = {{.name = "motion_blur_picture", .image = builder.picture()}},
                        .output = builder.create({.name = "color", .denominator = is_half ? 2u : 1u})};
    if (is_half) {
        desc.inputs.push_back({.name = "motion_blur_depth", .image = builder.frame_image(FrameImage::Depth)});
        desc.custom_vectors = 2;
        desc.constants = reach_constants<2, Distances::Frame>;
    }
    return builder.add(desc);
}

/// The fastest motion of each tile, by way of small tiles, and then of those around it, too.
PassImage add_tiles(PassBuilder& builder, PassImage motion) {
    const std::uint32_t tile = builder.from_max_extent(motion_blur_tile);
    const auto add = [&](const char* name, const char* shader, PassImage from, std::uint32_t denominator) {
        return builder.add({.name = name,
                            .shader = shader,
                            .inputs = {{.name = "motion_blur_from", .image = from}},
                            .output = builder.create({.name = name, .denominator = denominator})});
    };
    const PassImage small = add("small tiles", "motion_blur.glsl#tiles", motion, 8);
    const PassImage tiles = add("tiles", "motion_blur.glsl#tiles", small, tile);
    return add("tiles around", "motion_blur.glsl#around", tiles, tile);
}

void build(PassBuilder& builder) {
    const bool is_half = blur_of(builder.parameters()).resolution == MotionBlurResolution::Half;
    const PassImage motion = add_motion(builder, is_half);
    builder.side("motion_blur_smeared",
                 builder.add({.name = "smear",
                              .shader = "motion_blur.glsl#smear",
                              .inputs = {{.name = "motion_blur_color", .image = add_color(builder, is_half)},
                                         {.name = "motion_blur_motion", .image = motion},
                                         {.name = "motion_blur_fastest", .image = add_tiles(builder, motion)}},
                              .output = builder.create({.name = "smeared", .denominator = is_half ? 2u : 1u})}),
                 {});
}

}  // namespace

std::uint32_t motion_blur_tile(VkExtent2D extent) { return std::max((extent.height * 3 + 799) / 800, 1u) * 8; }

const EffectInfo& effect_info(const MotionBlur&) {
    static const EffectInfo info{
        .name = "motion_blur",
        .doc = "Smears moving things while the shutter is open.",
        .parameters = motion_blur_rows.table(),
        .files = embedded_files("motion_blur"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .needs = {FrameImage::Depth},
        .flat = {.documented = 47, .scene_linear = 50, .starts_on = false},
        .is_in_traced_light = true,
        .build = build,
        .reference = motion_blur_reference,
        .is_identity = [](const void* parameters) { return blur_of(parameters).shutter_angle == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
