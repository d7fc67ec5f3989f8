// SPDX-License-Identifier: MIT
// What PassBuilder offers beyond what the shipped effects use: another output extent, histories, shared images.
#include <gtest/gtest.h>

#include <cmath>

#include "compose/test_support.hpp"
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
