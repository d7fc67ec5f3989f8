// SPDX-License-Identifier: MIT
// What PassBuilder offers beyond what the shipped effects use: another output extent, histories, shared images.
#include <gtest/gtest.h>

#include <cmath>

#include <darkroom/describe.hpp>
#include "compose/test_stacks/support.hpp"
#include "gpu/test_run.hpp"

namespace darkroom {
namespace {

struct NoParameters {
    float unused = 0;
};
constexpr auto rows = describe(field<&NoParameters::unused>("Nothing.", {0, 1}));

constexpr EffectFile files[] = {
    {"double.glsl", "vec4 shade(Pixel pixel) { return load_clamped(double_in, pixel.texel / 2); }\n"},
    {"trail.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return vec4(0.5 * load(trail_before, pixel.texel).rgb + load(trail_in, pixel.texel).rgb, 1.0);\n}\n"},
    {"copy.glsl", "vec4 shade(Pixel pixel) { return load(copy_in, pixel.texel); }\n"},
    {"plus.glsl",
     "vec4 plus(vec4 color, Pixel pixel, NoParameters parameters) {\n"
     "    return vec4(color.rgb + sample_linear(plus_side, pixel.uv).rgb, color.a);\n}\n"},
    {"pool_fill.glsl", "vec4 shade(Pixel pixel) { return custom[0] * load_clamped(pool_in, pixel.texel); }\n"},
    {"pool_sum.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    vec4 corner = load(pool_one, size(pool_one) - 1);\n"
     "    return load(pool_so_far, ivec2(0)) + vec4(corner.r, vec2(size(pool_one)), 0.0);\n}\n"},
    {"pool_trail.glsl",
     "vec4 shade(Pixel pixel) { return 0.5 * (load_clamped(pool_before, pixel.texel) + load_clamped(pool_in, "
     "pixel.texel)); "
     "}\n"},
};

void build_double(PassBuilder& builder) {
    const PassImage big = builder.create({.name = "big", .numerator = 2});
    builder.result(builder.add({.name = "double",
                                .shader = "double.glsl",
                                .inputs = {{.name = "double_in", .image = builder.picture()}},
                                .output = big}));
}

void build_trail(PassBuilder& builder) {
    const PassBuilder::History trail = builder.history({.name = "trail", .format = VK_FORMAT_R32G32B32A32_SFLOAT});
    builder.result(builder.add({.name = "trail",
                                .shader = "trail.glsl",
                                .inputs = {{.name = "trail_in", .image = builder.picture()},
                                           {.name = "trail_before", .image = trail.previous}},
                                .output = trail.current}));
}

PassImage make_shared(PassBuilder& builder) {
    const PassImage small = builder.create({.name = "shared", .denominator = 2});
    return builder.add({.name = "shared",
                        .shader = "copy.glsl",
                        .inputs = {{.name = "copy_in", .image = builder.source()}},
                        .output = small});
}
void build_plus(PassBuilder& builder) { builder.side("plus_side", builder.shared("shared copy", make_shared), {}); }

/// An image of the pool: its share of the picture, its format, and what it holds, exactly.
struct PoolImage {
    std::uint32_t numerator, denominator;
    VkFormat format;
    float value;
};
constexpr std::array<PoolImage, 14> pool{{
    {1, 1, VK_FORMAT_R8G8B8A8_UNORM, 1},
    {1, 2, VK_FORMAT_R16G16B16A16_SFLOAT, 2},
    {1, 4, VK_FORMAT_R32G32B32A32_SFLOAT, 4},
    {1, 16, VK_FORMAT_R16G16B16A16_SFLOAT, 8},
    {3, 4, VK_FORMAT_R32_SFLOAT, 16},
    {2, 1, VK_FORMAT_R16_SFLOAT, 32},
    {1, 3, VK_FORMAT_R16G16_SFLOAT, 64},
    {1, 1, VK_FORMAT_R32_SFLOAT, 128},
    {1, 1, VK_FORMAT_R16G16B16A16_SFLOAT, 256},
    {1, 100, VK_FORMAT_R32G32B32A32_SFLOAT, 512},
    {1, 2, VK_FORMAT_R8G8B8A8_UNORM, 0},
    {5, 7, VK_FORMAT_R16_SFLOAT, 1024},
    {1, 4, VK_FORMAT_R32_SFLOAT, 2048},
    {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 4096},
}};

template <std::size_t index>
void pool_constant(const void*, const PassContext&, std::span<PassVector> out) {
    out[0] = {pool[index].value, pool[index].value, pool[index].value, 1};
}

/// Fills all images before it reads any, so that all must be there at once.
template <std::size_t... indices>
void build_pool(PassBuilder& builder, std::index_sequence<indices...>) {
    constexpr std::array<ConstantsFunction, pool.size()> constants{pool_constant<indices>...};
    const auto create = [&](std::size_t i) {
        return builder.create({.name = "image " + std::to_string(i),
                               .format = pool[i].format,
                               .numerator = pool[i].numerator,
                               .denominator = pool[i].denominator});
    };
    std::array<PassImage, pool.size()> images{};
    for (std::size_t i = 0; i < pool.size(); ++i)
        images[i] = builder.add({.name = "fill " + std::to_string(i),
                                 .shader = "pool_fill.glsl",
                                 .inputs = {{.name = "pool_in", .image = builder.picture()}},
                                 .output = create(i),
                                 .custom_vectors = 1,
                                 .constants = constants[i]});
    // And two trails, of a sixteenth and of a quarter of the picture's area.
    for (const auto& [format, denominator] :
         {std::pair{VK_FORMAT_R16G16B16A16_SFLOAT, 4U}, {VK_FORMAT_R32_SFLOAT, 2U}}) {
        const PassBuilder::History trail =
            builder.history({.name = "trail", .format = format, .denominator = denominator});
        images[denominator] = builder.add({.name = "trail",
                                           .shader = "pool_trail.glsl",
                                           .inputs = {{.name = "pool_in", .image = images[denominator]},
                                                      {.name = "pool_before", .image = trail.previous}},
                                           .output = trail.current});
    }
    PassImage sum = builder.add({.name = "zero",
                                 .shader = "pool_fill.glsl",
                                 .inputs = {{.name = "pool_in", .image = builder.picture()}},
                                 .output = builder.create({.name = "zero", .format = VK_FORMAT_R32G32B32A32_SFLOAT}),
                                 .custom_vectors = 1,
                                 .constants = pool_constant<10>});
    for (const PassImage image : images)
        sum = builder.add({.name = "sum",
                           .shader = "pool_sum.glsl",
                           .inputs = {{.name = "pool_so_far", .image = sum}, {.name = "pool_one", .image = image}},
                           .output = builder.create({.name = "sum", .format = VK_FORMAT_R32G32B32A32_SFLOAT})});
    builder.result(sum);
}

const EffectInfo pool_effect{
    .name = "pool",
    .doc = "Sums what many images hold, their widths and their heights.",
    .parameters = rows.table(),
    .files = files,
    .touch = Touch::History,
    .build = [](PassBuilder& builder) { build_pool(builder, std::make_index_sequence<pool.size()>()); }};

const EffectInfo doubling{.name = "double",
                          .doc = "Twice the extent.",
                          .parameters = rows.table(),
                          .files = files,
                          .touch = Touch::Neighbourhood,
                          .output_scale = {2, 1},
                          .build = build_double};
const EffectInfo trail{.name = "trail",
                       .doc = "Half of the last frame is added.",
                       .parameters = rows.table(),
                       .files = files,
                       .touch = Touch::History,
                       .build = build_trail};
const EffectInfo plus{
    .name = "plus", .doc = "Adds a shared copy.", .parameters = rows.table(), .files = files, .build = build_plus};

constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;

/// A composer on the test device that develops the same picture frame after frame.
class Rig {
  public:
    Rig(VkExtent2D extent, VkExtent2D target_extent, float value)
        : composer(gpu::test::device(), {.frames_in_flight = 1}),
          extent_(extent),
          color_(gpu::test::upload(context(),
                                   gpu::test::make_pixels(extent.width, extent.height,
                                                          [=](std::uint32_t, std::uint32_t) {
                                                              return std::array{value, value, value, 1.0F};
                                                          }),
                                   format, VK_IMAGE_LAYOUT_GENERAL)),
          target_(gpu::test::blank(context(), target_extent, format)) {}

    [[nodiscard]] Result<Plan> compile(std::uint32_t views = 1) {
        return composer.compile({.max_extent = extent_,
                                 .color = {format, gpu::test::all_usage(context(), format)},
                                 .target = {format, gpu::test::all_usage(context(), format)},
                                 .views = views,
                                 .intermediate = format});
    }
    /// The red of the first pixel after one frame.
    float frame(std::uint32_t view = 0, bool is_cut = false) {
        Result<> recorded{};
        gpu::test::must(gpu::submit_and_wait(context(), "frame", [&](VkCommandBuffer commands) {
            Frame frame{.color = reference(color_), .view = view, .target = reference(target_)};
            frame.camera.is_cut = is_cut;
            recorded = composer.record(commands, frame);
        }));
        EXPECT_TRUE(recorded) << (recorded ? "" : recorded.error().text);
        return pixels().at(0, 0)[0];
    }
    [[nodiscard]] gpu::test::Pixels pixels() { return gpu::test::download(context(), target_); }

    Composer composer;

  private:
    static gpu::Context& context() { return gpu::test::device().context(); }
    static ImageRef reference(const gpu::test::Picture& picture) {
        return {.image = picture.image.handle,
                .view = picture.image.mip_views[0],
                .format = format,
                .extent = {picture.image.info.extent.width, picture.image.info.extent.height},
                .layout = VK_IMAGE_LAYOUT_GENERAL,
                .final_layout = VK_IMAGE_LAYOUT_GENERAL};
    }
    VkExtent2D extent_;
    gpu::test::Picture color_, target_;
};

TEST(ComposeBuilder, WhatFollowsTakesAnotherOutputExtent) {
    Rig rig({6, 5}, {12, 10}, 0.75F);
    const Handle handle = rig.composer.add(doubling, nullptr);
    rig.composer.add(plus, nullptr, {.source = scene_color});
    ASSERT_TRUE(rig.compile());
    EXPECT_EQ(rig.frame(), 1.5F);
    EXPECT_EQ(rig.pixels().at(11, 9)[0], 1.5F);
    // Off, the smaller picture is drawn to the same extent.
    ASSERT_TRUE(rig.composer.set_enabled(handle, false));
    EXPECT_EQ(rig.frame(), 1.5F);
    EXPECT_EQ(rig.pixels().at(11, 9)[0], 1.5F);
}

TEST(ComposeBuilder, PicturesOfTwoExtentsBlend) {
    Rig rig({6, 5}, {12, 10}, 0.5F);
    rig.composer.add(doubling, nullptr, {.opacity = 0.5F, .blend = BlendMode::Add});
    ASSERT_TRUE(rig.compile());
    EXPECT_EQ(rig.frame(), 0.75F);
    EXPECT_EQ(rig.pixels().at(11, 9)[0], 0.75F);
}

TEST(ComposeBuilder, HistoryIsTheLastFrameOfTheSameView) {
    Rig rig({8, 8}, {8, 8}, 1.0F);
    const Handle handle = rig.composer.add(trail, nullptr);
    ASSERT_TRUE(rig.compile(2));
    EXPECT_EQ(rig.frame(), 1.0F);
    EXPECT_EQ(rig.frame(), 1.5F);
    EXPECT_EQ(rig.frame(1), 1.0F);
    EXPECT_EQ(rig.frame(), 1.75F);
    EXPECT_EQ(rig.frame(1), 1.5F);
    EXPECT_EQ(rig.frame(0, true), 1.0F) << "a cut forgets";
    EXPECT_EQ(rig.frame(), 1.5F);
    ASSERT_TRUE(rig.composer.set_enabled(handle, false));
    EXPECT_EQ(rig.frame(), 1.0F);
    ASSERT_TRUE(rig.composer.set_enabled(handle, true));
    EXPECT_EQ(rig.frame(), 1.0F) << "a frame without it forgets";
    EXPECT_EQ(rig.frame(), 1.5F);
}

TEST(ComposeBuilder, ImagesAreOfAnyNumberSizeAndFormat) {
    for (const VkExtent2D extent : {VkExtent2D{64, 48}, {37, 5}}) {
        Rig rig(extent, extent, 1.0F);
        rig.composer.add(pool_effect, nullptr);
        const auto plan = rig.compile();
        ASSERT_TRUE(plan) << plan.error().text;
        float values = 0, widths = 0, heights = 0;
        for (std::size_t i = 0; i < pool.size(); ++i) {
            std::uint32_t width = std::max(1U, extent.width * pool[i].numerator / pool[i].denominator);
            std::uint32_t height = std::max(1U, extent.height * pool[i].numerator / pool[i].denominator);
            // In whose place the trails are read.
            if (i == 2 || i == 4) {
                width = std::max(1U, extent.width / static_cast<std::uint32_t>(i));
                height = std::max(1U, extent.height / static_cast<std::uint32_t>(i));
            } else {
                values += pool[i].value;
            }
            widths += static_cast<float>(width);
            heights += static_cast<float>(height);
        }
        float trails = 0;
        for (int frame = 0; frame < 4; ++frame) {
            trails = 0.5F * (trails + pool[2].value + pool[4].value);
            EXPECT_EQ(rig.frame(), values + trails) << "frame " << frame;
            EXPECT_EQ(rig.pixels().at(0, 0)[1], widths);
            EXPECT_EQ(rig.pixels().at(0, 0)[2], heights);
        }
    }
}

TEST(ComposeBuilder, SharedImagesAreMadeOnceWhileAnyoneNeedsThem) {
    Rig rig({8, 8}, {8, 8}, 1.0F);
    const Handle first = rig.composer.add(plus, nullptr, {.source = scene_color});
    const Handle second = rig.composer.add(plus, nullptr, {.source = scene_color});
    const auto plan = rig.compile();
    ASSERT_TRUE(plan) << plan.error().text;
    EXPECT_EQ(plan->passes.size(), 2U) << plan->text();
    EXPECT_EQ(rig.frame(), 3.0F);
    ASSERT_TRUE(rig.composer.set_enabled(first, false));
    EXPECT_EQ(rig.frame(), 2.0F);
    ASSERT_TRUE(rig.composer.set_enabled(second, false));
    EXPECT_EQ(rig.frame(), 1.0F);
    ASSERT_TRUE(rig.composer.set_enabled(first, true));
    EXPECT_EQ(rig.frame(), 2.0F);
}

}  // namespace
}  // namespace darkroom
