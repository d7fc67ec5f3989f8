// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/depth_of_field.hpp>

#include "depth_of_field/depth_of_field_lens.hpp"
#include "depth_of_field/depth_of_field_reference.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

constexpr Unit millimetres{"mm"}, dioptres_per_second{"1/m/s"};
constexpr std::int32_t max_rings = 8;

constexpr auto depth_of_field_rows = describe(
    field<&DepthOfField::focus_distance>("Distance along the view axis that is sharp.", {0.01, 1e5, Scale::Log},
                                         unit::metres),
    field<&DepthOfField::autofocus>(
        "Focuses on what is seen at `autofocus_place`; `focus_distance` then does not count.")
        .at_compile(),
    field<&DepthOfField::autofocus_place>(
        "Place in the picture that the lens focuses on: (0, 0) is the top left, (1, 1) the bottom right.", {0, 1}),
    field<&DepthOfField::autofocus_speed>(
        "Speed of the lens toward another distance, in dioptres (1/m); at 0 it stays.", {0, 100}, dioptres_per_second),
    field<&DepthOfField::f_stop>("Focal length divided by the aperture's diameter: a smaller number blurs more.",
                                 {0.5, 64, Scale::Log}),
    field<&DepthOfField::sensor_height>("Height of the sensor; with the field of view it gives the focal length.",
                                        {1, 1000, Scale::Log}, millimetres),
    field<&DepthOfField::max_radius>(
        "Largest radius of the circle of confusion, in hundredths of the picture's height.", {0.1, 4}),
    field<&DepthOfField::blades>("Number of the aperture's blades; fewer than 3 make a round aperture.", {0, 11}),
    field<&DepthOfField::roundness>("Bend of the blades' straight sides: 0 is a polygon, 1 a circle.", {0, 1}),
    field<&DepthOfField::rotation>("Angle by which the aperture is turned, counterclockwise.", {-180, 180},
                                   unit::degrees),
    field<&DepthOfField::anamorphic_ratio>("Height of the circle of confusion divided by its width.", {1, 2}),
    field<&DepthOfField::cats_eye>("Share by which the barrel of the lens cuts circles in the corners.", {0, 1}),
    field<&DepthOfField::rings>("Number of sample rings for a pixel: n rings are 4 n (n + 1) samples.", {2, max_rings})
        .as_loop_count(),
    field<&DepthOfField::resolution>("Size of the blurred picture, as a share of each side.").at_compile());

const DepthOfField& field_of(const void* parameters) { return *static_cast<const DepthOfField*>(parameters); }

float largest_circle(const DepthOfField& field, const PassContext& context) {
    return field.max_radius / 100 * static_cast<float>(context.frame_extent.height);
}

/// See depth_of_field.glsl#focus.
void focus_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const DepthConstants depth = depth_constants(*context.camera);
    const double way = std::max(context.delta_time, 0.0) * double{field_of(parameters).autofocus_speed};
    out[0] = depth.distance;
    out[1] = {depth.sky, static_cast<float>(way), static_cast<float>(autofocus_farthest),
              static_cast<float>(autofocus_nearest)};
}

/// See depth_of_field.glsl#focused.
void focused_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const DepthOfField& field = field_of(parameters);
    const DepthConstants depth = depth_constants(*context.camera);
    const AutofocusLens lens = autofocus_lens(field, *context.camera, context.frame_extent.height);
    out[0] = depth.distance;
    out[1] = {static_cast<float>(lens.strength), static_cast<float>(lens.focal), largest_circle(field, context),
              depth.sky};
    out[2] = {static_cast<float>(lens.nearest), 0, 0, 0};
}

/// See depth_of_field.glsl.
template <std::uint32_t denominator, bool is_focused>
void circle_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const DepthOfField& field = field_of(parameters);
    constexpr float pixels{denominator};
    const float limit = largest_circle(field, context);
    if (is_focused) {
        // The depth is what depth_of_field.glsl#focused made of it.
        out[0] = {0, 1, 1, 0};
        out[1] = {limit / pixels, 1 / pixels, limit / pixels, -1};
    } else {
        const DepthConstants depth = depth_constants(*context.camera);
        const ThinLens lens = depth_of_field_lens(field, *context.camera, context.frame_extent.height);
        out[0] = depth.distance;
        out[1] = {static_cast<float>(lens.infinity) / pixels, static_cast<float>(lens.infinity * lens.focus) / pixels,
                  limit / pixels, depth.sky};
    }
    const DepthOfFieldBlur blur = depth_of_field_blur(denominator);
    out[2] = {pixels, static_cast<float>(blur.own), static_cast<float>(blur.to * blur.slope),
              static_cast<float>(blur.slope)};
}

constexpr std::uint32_t max_pairs = 2 * max_rings * (max_rings + 1);

/// See depth_of_field.glsl#gather.
template <std::uint32_t denominator>
void gather_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const DepthOfField& field = field_of(parameters);
    const double width = context.frame_extent.width, height = context.frame_extent.height,
                 diagonal = std::hypot(width, height);
    const DepthOfFieldBlur blur = depth_of_field_blur(denominator);
    const double shift = 2 * double{field.cats_eye} / diagonal;
    out[0] = {static_cast<float>(blur.least), 0, static_cast<float>(width * shift), static_cast<float>(height * shift)};
    out[1] = {static_cast<float>(blur.to * blur.slope), static_cast<float>(blur.slope), 0, 0};
    std::size_t next = 2;
    for (std::uint32_t ring = 1; ring <= max_rings; ++ring)
        for (std::uint32_t i = 0; i < 8 * ring; i += 2) {
            const auto one = depth_of_field_place(field, ring, i), other = depth_of_field_place(field, ring, i + 1);
            out[next++] = {static_cast<float>(one[0]), static_cast<float>(one[1]), static_cast<float>(other[0]),
                           static_cast<float>(other[1])};
        }
}

/// The largest near circle of each tile, by way of small tiles, and then of those around it, too.
PassImage add_tiles(PassBuilder& builder, PassImage color) {
    const std::uint32_t tile = builder.from_max_extent(depth_of_field_tile);
    const auto add = [&](const char* name, const char* shader, PassImage from, std::uint32_t denominator) {
        return builder.add(
            {.name = name,
             .shader = shader,
             .inputs = {{.name = "depth_of_field_from", .image = from}},
             .output = builder.create({.name = name, .format = VK_FORMAT_R16_SFLOAT, .denominator = denominator})});
    };
    const PassImage small = add("small tiles", "depth_of_field.glsl#first_tiles", color, 8);
    const PassImage tiles = add("tiles", "depth_of_field.glsl#tiles", small, tile);
    return add("tiles around", "depth_of_field.glsl#around", tiles, tile);
}

/// Focuses, and makes of the depth what the other passes then take for it.
PassImage add_autofocus(PassBuilder& builder, PassImage depth) {
    const PassBuffer focus = builder.value("depth_of_field", 3);
    builder.add_compute({.name = "focus",
                         .shader = "depth_of_field.glsl#focus",
                         .inputs = {{.name = "depth_of_field_depth", .image = depth}},
                         .buffers = {{"depth_of_field_focus", focus, ComputePassDesc::Access::ReadWrite, "float"}},
                         .workgroup = {32, 1},
                         .shared_bytes = 4 * autofocus_side * autofocus_side,
                         .groups = {1, 1},
                         .custom_vectors = 2,
                         .constants = focus_constants});
    return builder.add({.name = "focused",
                        .shader = "depth_of_field.glsl#focused",
                        .inputs = {{.name = "depth_of_field_depth", .image = depth}},
                        .output = builder.create({.name = "focused", .format = VK_FORMAT_R32_SFLOAT}),
                        .values = {{"depth_of_field_focus", focus}},
                        .custom_vectors = 3,
                        .constants = focused_constants});
}

template <std::uint32_t denominator, bool is_focused>
void build_at(PassBuilder& builder) {
    PassImage depth = builder.frame_image(FrameImage::Depth);
    if (is_focused) depth = add_autofocus(builder, depth);
    const auto create = [&](const char* name) { return builder.create({.name = name, .denominator = denominator}); };
    const PassImage color =
        builder.add({.name = denominator == 2 ? "half size" : "clean",
                     .shader = denominator == 2 ? "depth_of_field.glsl#half" : "depth_of_field.glsl#clean",
                     .inputs = {{.name = "depth_of_field_picture", .image = builder.picture()},
                                {.name = "depth_of_field_depth", .image = depth}},
                     .output = create("color and circle"),
                     .custom_vectors = 3,
                     .constants = circle_constants<denominator, is_focused>});
    const PassImage tiles = add_tiles(builder, color);
    const std::vector<PassImage> gathered =
        builder.add_all({.name = "gather",
                         .shader = "depth_of_field.glsl#gather",
                         .inputs = {{.name = "depth_of_field_color", .image = color},
                                    {.name = "depth_of_field_near_tiles", .image = tiles}},
                         .output = create("behind"),
                         .more_outputs = {create("near")},
                         .custom_vectors = 2 + max_pairs,
                         .constants = gather_constants<denominator>});
    if (gathered.size() < 2) return;
    const std::vector<PassImage> filled =
        builder.add_all({.name = "fill",
                         .shader = "depth_of_field.glsl#fill",
                         .inputs = {{.name = "depth_of_field_color", .image = color},
                                    {.name = "depth_of_field_near_tiles", .image = tiles},
                                    {.name = "depth_of_field_behind", .image = gathered[0]},
                                    {.name = "depth_of_field_near", .image = gathered[1]}},
                         .output = create("behind, filled"),
                         .more_outputs = {create("near, filled")}});
    if (filled.size() < 2) return;
    builder.side("depth_of_field_behind", filled[0], {});
    builder.side("depth_of_field_near", filled[1], {});
    builder.side("depth_of_field_depth", depth, {});
    builder.side("depth_of_field_picture", builder.picture(), {});
    builder.end_constants(3, circle_constants<denominator, is_focused>);
}

void build(PassBuilder& builder) {
    const DepthOfField& field = field_of(builder.parameters());
    const bool is_half = field.resolution == DepthOfFieldResolution::Half;
    if (field.autofocus)
        is_half ? build_at<2, true>(builder) : build_at<1, true>(builder);
    else
        is_half ? build_at<2, false>(builder) : build_at<1, false>(builder);
}

/// Until the lens has come from one end to the other but for a thousandth of a dioptre, by which a circle of 50 mm at
/// f/1.4 changes by a twentieth of a pixel of 1080 lines.
std::uint32_t pre_roll(const void* parameters, double delta_time) {
    const DepthOfField& field = field_of(parameters);
    if (!field.autofocus) return 0;
    const double way = autofocus_nearest - autofocus_farthest + autofocus_slow * (std::log(100) - 1);
    return static_cast<std::uint32_t>(std::min(std::ceil(way / (double{field.autofocus_speed} * delta_time)) + 1, 1e9));
}

}  // namespace

const EffectInfo& effect_info(const DepthOfField&) {
    static const EffectInfo info{
        .name = "depth_of_field",
        .doc = "Blurs everything nearer or farther than the focus distance.",
        .parameters = depth_of_field_rows.table(),
        .files = embedded_files("depth_of_field"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .needs = Needs{FrameImage::Depth}.and_perspective(),
        .flat = {.documented = 46, .scene_linear = 48, .starts_on = false},
        .is_in_traced_light = true,
        .build = build,
        .reference = depth_of_field_reference,
        .pre_roll = pre_roll,
    };
    return info;
}

}  // namespace darkroom
