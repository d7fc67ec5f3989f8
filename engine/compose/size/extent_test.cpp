// SPDX-License-Identifier: MIT
// Sizes are fractions of the scene's extent, or of what the frame is finished at: an upscaler in mid-chain parts the
// two.

#include <fmt/format.h>

#include <darkroom/custom_effect.hpp>

#include "compose/test_stacks/effects.hpp"
#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"
#include "graph/graph.hpp"

namespace darkroom {
namespace {

class ComposeExtent : public test::StackTest {};

constexpr EffectFile extent_files[] = {
    {"enlarge_up.glsl", "vec4 shade(Pixel pixel) { return sample_linear(enlarge_in, pixel.uv); }\n"},
    {"linger_mix.glsl",
     "vec4 shade(Pixel pixel) { return 0.5 * (load(linger_in, pixel.texel) + load(linger_last, pixel.texel)); }\n"},
};

ReferenceImage enlarge_reference(const void*, const ReferenceInput& input) {
    ReferenceImage out(input.output_width, input.output_height);
    const ReferenceImage& from = *input.picture;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) * from.width / out.width - 0.5, v = (y + 0.5) * from.height / out.height - 0.5;
            const double i = std::floor(u), j = std::floor(v);
            const auto column = static_cast<std::int64_t>(i), row = static_cast<std::int64_t>(j);
            const auto mixed = [&](double Rgba::*c) {
                const double above = std::lerp(from.clamped(column, row).*c, from.clamped(column + 1, row).*c, u - i);
                const double below =
                    std::lerp(from.clamped(column, row + 1).*c, from.clamped(column + 1, row + 1).*c, u - i);
                return std::lerp(above, below, v - j);
            };
            out.at(x, y) = {mixed(&Rgba::r), mixed(&Rgba::g), mixed(&Rgba::b), mixed(&Rgba::a)};
        }
    return out;
}
/// The scene at the output's extent.
const EffectInfo enlarge{
    .name = "enlarge",
    .doc = "Enlarges the picture.",
    .parameters = {.struct_name = "Enlarge"},
    .files = extent_files,
    .touch = Touch::Neighbourhood,
    .output_scale = {.is_of_output = true},
    .build =
        [](PassBuilder& builder) {
            builder.result(
                builder.add({.name = "up",
                             .shader = "enlarge_up.glsl",
                             .inputs = {{.name = "enlarge_in", .image = builder.picture()}},
                             .output = builder.create(
                                 {.name = "large", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .is_of_output = true})}));
        },
    .reference = enlarge_reference};

ReferenceImage linger_reference(const void*, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    ReferenceImage& last = (*input.history)["last"];
    if (last.pixels.empty()) last = ReferenceImage(out.width, out.height, {0, 0, 0, 0});
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Rgba &a = out.pixels[i], &b = last.pixels[i];
        out.pixels[i] = {(a.r + b.r) / 2, (a.g + b.g) / 2, (a.b + b.b) / 2, (a.a + b.a) / 2};
    }
    last = out;
    return out;
}
/// A trail of halves.
const EffectInfo linger{
    .name = "linger",
    .doc = "Half of what was.",
    .parameters = {.struct_name = "Linger"},
    .files = extent_files,
    .touch = Touch::History,
    .build =
        [](PassBuilder& builder) {
            const PassBuilder::History trail =
                builder.history({.name = "trail", .format = VK_FORMAT_R32G32B32A32_SFLOAT});
            builder.result(builder.add({.name = "mix",
                                        .shader = "linger_mix.glsl",
                                        .inputs = {{.name = "linger_in", .image = builder.picture()},
                                                   {.name = "linger_last", .image = trail.previous}},
                                        .output = trail.current}));
        },
    .reference = linger_reference};

ReferenceImage striped_ui(VkExtent2D extent) {
    ReferenceImage out(extent.width, extent.height, {0, 0, 0, 0});
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x)
            if ((x / 5 + y / 3) % 2 == 0) out.at(x, y) = {1, 51 / 255.0, 0, 1};
    return out;
}

TEST_F(ComposeExtent, InterfacePassesFollowTheTargetOfTheFrame) {
    if (find_effect("ui_composite") == nullptr) GTEST_SKIP() << "this build has no effect ui_composite";
    const test::Host host(test::round_to_float(test::random_display(32, 24, 7)));
    const VkExtent2D small{50, 38};
    const gpu::test::Picture ui = gpu::test::upload(host.device.context(), test::pixels_of(striped_ui(small)),
                                                    VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_GENERAL);
    const gpu::test::Picture target = gpu::test::blank(host.device.context(), small, VK_FORMAT_R32G32B32A32_SFLOAT);
    const auto out = [&](VkExtent2D largest, OutputScale scale, KernelStage stage) {
        Composer composer(host.device);
        composer.ui().add(test::cross_effect, nullptr, {.scale = scale});
        test::add(composer, "ui_composite");
        CompileDesc desc = host.compile_desc();
        desc.ui = {VK_FORMAT_R8G8B8A8_UNORM};
        desc.target_extent = largest;
        desc.kernels = stage;
        test::must(composer.compile(desc));
        Frame frame = host.frame();
        frame.ui = test::image_ref(ui);
        frame.target = test::image_ref(target);
        test::must(host.record(composer, frame));
        return test::image_of(gpu::test::download(host.device.context(), target));
    };
    // Without what the edge of a region is mixed with, which three taps of the cross and the scaling may each be.
    constexpr std::uint32_t margin = 6;
    const auto inner = [&](const ReferenceImage& image) {
        ReferenceImage part(small.width - 2 * margin, small.height - 2 * margin);
        for (std::uint32_t y = 0; y < part.height; ++y)
            for (std::uint32_t x = 0; x < part.width; ++x) part.at(x, y) = image.at(x + margin, y + margin);
        return part;
    };
    const double edge = 4 * std::ldexp(1.0, -static_cast<int>(gpu::test::limits().subTexelPrecisionBits));
    for (const OutputScale scale : {OutputScale{1, 1}, {1, 2}, {3, 4}})
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage alone = out(small, scale, stage), within = out({97, 80}, scale, stage);
            // Places in a larger image are rounded elsewhere: some 2^-24 of its width, times the steps between texels.
            EXPECT_LE(test::worst_difference(inner(alone), inner(within)), 1e-4)
                << scale.numerator << "/" << scale.denominator;
            EXPECT_LE(test::worst_difference(alone, within), 1e-4 + edge)
                << scale.numerator << "/" << scale.denominator;
        }
}

TEST_F(ComposeExtent, FractionsThatUndoEachOtherLeaveNothing) {
    Composer composer(Device::assumed());
    for (int i = 0; i < 13; ++i) {
        composer.add(test::cross_effect, nullptr, {.scale = {3, 2}});
        composer.add(test::cross_effect, nullptr, {.scale = {66666666, 100000000}});
        composer.add(test::cross_effect, nullptr, {.scale = {3, 2}});
        composer.add(test::cross_effect, nullptr, {.scale = {2, 3}});
    }
    const Plan plan = test::must(composer.plan({.max_extent = {1920, 1080}}));
    EXPECT_NEAR(plan.passes.back().extent.width, 1920, 1);
    EXPECT_NEAR(plan.passes.back().extent.height, 1080, 1);
    for (const PlanPass& pass : plan.passes) EXPECT_LE(pass.extent.width, 2880u) << pass.name;
    for (const graph::Size size : {graph::Size{}.scaled(6, 4), graph::Size{}.scaled(3, 1).scaled(1, 2)})
        EXPECT_EQ(size, (graph::Size{.numerator = 3, .denominator = 2}));
}

TEST_F(ComposeExtent, AScaledEntryOnAPictureOfTheHostIsAPartOfThatPicture) {
    if (find_effect("blend") == nullptr) GTEST_SKIP() << "this build has no effect blend";
    const test::Host host(test::random_display(32, 24, 7));
    for (const bool is_previous : {false, true}) {
        Composer composer(host.device);
        const Handle picture = Composer::picture_of(test::must(composer.define(
            ResourceImage{.width = 40, .height = 20, .rgba = std::vector<float>(std::size_t{4} * 40 * 20, 0.5F)})));
        const Handle half = composer.add(test::cross_effect, nullptr, {.input = picture, .scale = {1, 2}});
        test::add(composer, "blend", {}, {.input = scene_color, .second = is_previous ? half.previous() : half});
        const Plan plan = test::must(composer.compile(host.compile_desc()));
        const auto of = [&](std::uint32_t width, std::uint32_t height) {
            return std::ranges::count_if(plan.passes, [&](const auto& pass) {
                return pass.extent.width == width && pass.extent.height == height;
            });
        };
        EXPECT_GT(of(20, 10), 0) << is_previous;
        EXPECT_EQ(of(16, 12), 0) << "half of the scene";
        EXPECT_EQ(of(40, 20), 0) << "nothing works at its whole size";
        test::must(host.record(composer, host.frame()));
    }
}

TEST_F(ComposeExtent, AScaleThatNoDeviceHoldsIsRefusedBeforeItIsTried) {
    Composer composer(Device::assumed());
    composer.add(test::cross_effect, nullptr, {.name = "wide", .scale = {4096, 1}});
    const auto plan = composer.plan({.max_extent = {1920, 1080}});
    ASSERT_FALSE(plan);
    EXPECT_TRUE(
        plan.error().text.starts_with("stack entry 'wide': scale = 4096/1 makes pictures of 7864320x4423680, 259200.0 "
                                      "GiB each: allowed are at most "))
        << plan.error().text;
}

TEST_F(ComposeExtent, TheReferencesWorkAtTheSameSizes) {
    if (find_effect("fog") == nullptr) GTEST_SKIP() << "this build has no effect fog";
    const ReferenceImage picture = test::round_to_float(test::random_display(23, 17, 3));
    ReferenceImage depth(23, 17);
    for (std::uint32_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i].r = 5.0 + (i * 37) % 100;
    const test::Host host(picture);
    const gpu::test::Picture depth_image =
        gpu::test::upload(host.device.context(), test::pixels_of(depth), VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    for (const OutputScale scale : {OutputScale{1, 2}, {3, 1}, {3, 2}, {2, 7}}) {
        Composer composer(host.device);
        const Handle fog = composer.add(*find_effect("fog"), nullptr, {.scale = scale});
        test::must(composer.set(fog, "density", 0.02));
        // Back again: a fraction of the scene, not of a rounded size.
        composer.add(test::shift_effect, nullptr, {.scale = {scale.denominator, scale.numerator}});
        CompileDesc desc = host.compile_desc();
        desc.depth = {VK_FORMAT_R32_SFLOAT};
        desc.is_depth_planar = true;
        test::must(composer.compile(desc));
        Frame frame = host.frame();
        frame.camera.depth = DepthKind::Planar;
        frame.depth = test::image_ref(depth_image);
        test::must(host.record(composer, frame));
        const auto expected = test::must(run_reference(composer, {.color = &picture,
                                                                  .images = {{FrameImage::Depth, &depth}},
                                                                  .camera = frame.camera,
                                                                  .encodes_target = false}));
        EXPECT_LE(test::worst_difference(host.read_target(), expected.picture), 2e-3 + gpu::test::filter_step())
            << scale.numerator << "/" << scale.denominator;
    }
}

TEST_F(ComposeExtent, BehindAnUpscalerAllIsOfTheOutputWhateverTheSceneIs) {
    if (find_effect("ui_composite") == nullptr) GTEST_SKIP() << "this build has no effect ui_composite";
    const VkExtent2D most{40, 28}, output{80, 56};
    const test::Host host(ReferenceImage(most.width, most.height, {}));
    gpu::Context& context = host.device.context();
    const ReferenceImage ui = striped_ui(output);
    const gpu::test::Picture ui_image =
        gpu::test::upload(context, test::pixels_of(ui), VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_GENERAL);
    const gpu::test::Picture target = gpu::test::blank(context, output, VK_FORMAT_R32G32B32A32_SFLOAT);
    for (const bool is_fused : {true, false}) {
        Composer composer(host.device);
        composer.add(enlarge, nullptr);
        test::add(composer, "bloom", {{"intensity", 0.2}, {"threshold", 0}});
        composer.add(test::shift_effect, nullptr);
        composer.add(linger, nullptr);
        test::add(composer, "ui_composite");
        CompileDesc desc = host.compile_desc();
        desc.ui = {VK_FORMAT_R8G8B8A8_UNORM};
        desc.target_extent = output;
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        ReferenceHistories histories;
        std::uint32_t number = 0;
        for (const VkExtent2D scene : {most, VkExtent2D{27, 19}, {40, 28}, {20, 14}, {33, 28}}) {
            const ReferenceImage picture =
                test::round_to_float(test::random_display(scene.width, scene.height, ++number));
            const gpu::test::Picture color = gpu::test::upload(context, test::pixels_of(picture),
                                                               VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
            Frame frame = host.frame();
            frame.color = test::image_ref(color);
            frame.ui = test::image_ref(ui_image);
            frame.target = test::image_ref(target);
            test::must(host.record(composer, frame));
            const auto expected = test::must(run_reference(composer, {.color = &picture,
                                                                      .images = {{FrameImage::Ui, &ui}},
                                                                      .target_extent = output,
                                                                      .histories = &histories,
                                                                      .encodes_target = false}));
            const ReferenceImage out = test::image_of(gpu::test::download(context, target));
            EXPECT_LE(test::worst_difference(out, expected.picture), 4e-3 + 2 * gpu::test::filter_step())
                << "frame " << number << ", fused " << is_fused;
        }
    }
}

// A plan that serves a larger extent is asked again what it makes of it.
TEST_F(ComposeExtent, ImagesThatTheDeviceCannotHaveAreRefused) {
    const test::Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    const std::uint32_t most = host.device.context().traits.max_image_dimension;
    CompileDesc small = host.compile_desc(), large = small;
    small.max_extent = {most / 16, 4};
    large.max_extent = {most - 8, 4};
    const auto error = [](const auto& done) { return done ? std::string("none") : done.error().text; };
    Composer scaled(host.device);
    test::add(scaled, "tonemap", {}, {.scale = {4, 1}});
    test::add(scaled, "gaussian_blur", {{"radius", 2}});
    EXPECT_EQ(error(scaled.compile(small)), "none");
    for (const bool is_planned : {true, false}) {
        const std::string text = is_planned ? error(scaled.plan(large)) : error(scaled.compile(large));
        EXPECT_NE(text.find(fmt::format("{}x16", 4 * (most - 8))), std::string::npos) << text;
        EXPECT_NE(text.find(fmt::format("at most {0}x{0}", most)), std::string::npos) << text;
    }
    for (const std::string_view kind : {"image", "history"}) {
        const CustomEffect twice = test::must(CustomEffect::parse(
            fmt::format(
                "// @effect twice: Twice.\n{}// @{} big: 2 rgba8\n// @pass make: picture -> big\n"
                "vec4 twice_make(Pixel pixel, Twice parameters) {{ return sample_linear(picture, pixel.uv); }}\n"
                "// @end big\n"
                "vec4 twice(vec4 color, Pixel pixel, Twice parameters) {{ return sample_linear(big, pixel.uv); "
                "}}\n",
                kind == "history" ? "// @pre_roll 1\n" : "", kind),
            "twice.glsl"));
        Composer composer(host.device);
        composer.add(twice.info(), nullptr);
        EXPECT_EQ(error(composer.compile(small)), "none");
        EXPECT_EQ(error(composer.compile(large)), fmt::format("image 'twice.big' would be {}x8: this device allows at "
                                                              "most {}x{}",
                                                              2 * (most - 8), most, most));
    }
    const ResourceImage wide{.width = most + 1, .height = 1, .rgba = std::vector<float>(std::size_t{4} * (most + 1))};
    EXPECT_FALSE(scaled.define(wide));
}

}  // namespace
}  // namespace darkroom
