// SPDX-License-Identifier: MIT
// Pictures that no entry of this frame makes, and outputs of a size and format of their own.

#include <algorithm>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/support.hpp"
#include "develop/reference_chain.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::test {
namespace {

class ComposeWires : public StackTest {
  protected:
    /// Random colours whose alpha is a layer of its own.
    static ReferenceImage layered(std::uint32_t width, std::uint32_t height) {
        ReferenceImage out = round_to_float(random_display(width, height, 7));
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            out.pixels[i].a = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 0.25 : 0.0;
        return out;
    }
    static ReferenceImage reference(const Composer& composer, const ReferenceImage& picture) {
        auto out = run_reference(composer, {.color = &picture, .target_domain = Domain::Encoded});
        return out ? std::move(out->picture) : ReferenceImage{};
    }
    /// Both say the same, and it is returned.
    static ReferenceImage develop_both(const std::function<void(Composer&)>& fill, const ReferenceImage& picture) {
        Composer composer(gpu::test::device());
        fill(composer);
        const ReferenceImage gpu = develop(fill, picture);
        // The driver's pow() of 32 bits.
        EXPECT_LT(worst_difference(gpu, reference(composer, picture)), 1e-4);
        return gpu;
    }
};

TEST_F(ComposeWires, TheAlphaOfTheSceneIsAPicture) {
    const ReferenceImage picture = layered(11, 7);
    const ReferenceImage out = develop_both(
        [](Composer& composer) {
            add(composer, "blend", {{"amount", 1}}, {.second = scene_alpha});
            add(composer, "encode");
        },
        picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const double seen = srgb_encoded(picture.pixels[i].a);
        ASSERT_NEAR(out.pixels[i].r, seen, 1e-4) << i;
        ASSERT_NEAR(out.pixels[i].b, seen, 1e-4) << i;
    }
}

TEST_F(ComposeWires, AnEntryWorksWhereAlphaMarksThePicture) {
    ReferenceImage picture = layered(11, 7);
    for (Rgba& pixel : picture.pixels) pixel = {0.25, 0.25, 0.25, pixel.a};
    const auto fill = [](Composer& composer) {
        add(composer, "negative", {}, {.mask = scene_alpha});
        add(composer, "encode");
    };
    const ReferenceImage marked = develop_both(fill, picture);
    const ReferenceImage plain = develop([](Composer& composer) { add(composer, "encode"); }, picture);
    ASSERT_EQ(marked.pixels.size(), plain.pixels.size());
    for (std::size_t i = 0; i < marked.pixels.size(); ++i) {
        const bool is_marked = picture.pixels[i].a > 0;
        ASSERT_EQ(std::abs(marked.pixels[i].r - plain.pixels[i].r) > 1e-3, is_marked) << i;
    }
}

TEST_F(ComposeWires, APictureOfTheHostIsAnInputLikeAnyOther) {
    const ResourceImage given{.width = 2, .height = 1, .rgba = {1, 0, 0, 1, 0, 0, 1, 1}};
    const auto fill = [&](Composer& composer) {
        const auto picture = composer.define(given);
        ASSERT_TRUE(picture);
        add(composer, "blend", {{"amount", 1}}, {.second = Composer::picture_of(*picture)});
        add(composer, "encode");
    };
    const ReferenceImage out = develop_both(fill, uniform(8, 4, {0.5, 0.5, 0.5, 1}));
    ASSERT_EQ(out.pixels.size(), 32u);
    EXPECT_EQ(out.at(0, 0).r, 1);
    EXPECT_EQ(out.at(0, 3).b, 0);
    EXPECT_EQ(out.at(7, 2).b, 1);
    EXPECT_GT(out.at(4, 2).r, 0) << "the larger picture is filled by linear interpolation";
    EXPECT_LT(out.at(4, 2).r, out.at(3, 2).r);
}

TEST_F(ComposeWires, TheFrameBeforeIsBlackFirstThenWhatWasMade) {
    const Host host(uniform(9, 5, {0.125, 0.25, 0.0625, 1}));
    Composer composer(gpu::test::device());
    const Handle sum = add(composer, "blend", {{"amount", 1}}, {.second = scene_color});
    set_word(composer, sum, "mode", static_cast<std::uint32_t>(BlendMode::Add));
    must(composer.rewire(sum, {.second = sum.previous()}));
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    must(composer.compile(desc));
    EXPECT_EQ(composer.pre_roll(), previous_pre_roll);
    ReferenceHistories histories;
    const ReferenceImage picture = uniform(9, 5, {0.125, 0.25, 0.0625, 1});
    for (std::uint32_t number = 0; number < 4; ++number) {
        const auto expected = run_reference(
            composer,
            {.color = &picture, .delta_time = 1.0 / 60, .histories = &histories, .target_domain = Domain::SceneLinear});
        ASSERT_TRUE(expected) << expected.error().text;
        EXPECT_EQ(expected->picture.at(3, 2).g, 0.25 * (number + 1)) << number;
        Frame frame = host.frame();
        frame.delta_time = 1.0 / 60;
        frame.frame_index = number;
        must(host.record(composer, frame));
        EXPECT_EQ(host.read_target().at(3, 2).g, 0.25 * (number + 1)) << number;
    }
    Frame cut = host.frame();
    cut.delta_time = 1.0 / 60;
    cut.camera.is_cut = true;
    must(host.record(composer, cut));
    EXPECT_EQ(host.read_target().at(3, 2).g, 0.25) << "a cut starts anew";
}

// 79.4 codes are kept as 79, so that each frame loses what a wider format would add up.
TEST_F(ComposeWires, TheFrameBeforeIsInTheFormatOfItsEntry) {
    const ReferenceImage picture = uniform(9, 5, {0.25, 79.4 / 255, 0.0625, 1});
    const Host host(picture);
    Composer composer(gpu::test::device());
    const Handle sum = add(composer, "blend", {{"amount", 1}}, {.second = scene_color});
    set_word(composer, sum, "mode", static_cast<std::uint32_t>(BlendMode::Add));
    must(composer.rewire(sum, {.second = sum.previous(), .format = VK_FORMAT_R8G8B8A8_UNORM}));
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    must(composer.compile(desc));
    for (std::uint32_t number = 0; number < 3; ++number) {
        Frame frame = host.frame();
        frame.delta_time = 1.0 / 60;
        frame.frame_index = number;
        must(host.record(composer, frame));
    }
    const double codes = host.read_target().at(3, 2).g * 255;
    EXPECT_GT(codes, 236.9);
    EXPECT_LT(codes, 237.5) << "238.2 in floats";
}

// What is copied a thousand times is what it was: texels and pixels lie on each other.
TEST_F(ComposeWires, AFeedbackLoopNeitherDriftsNorBleeds) {
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        const ReferenceImage first = layered(37, 23);
        const Host host(first);
        const Host other(uniform(37, 23, {0.5, 0.5, 0.5, 0.5}));
        Composer composer(gpu::test::device());
        const Handle loop = add(composer, "blend", {}, {.second = scene_color});
        must(composer.rewire(loop, {.second = loop.previous()}));
        CompileDesc desc = host.compile_desc();
        desc.target_domain = Domain::SceneLinear;
        desc.kernels = stage;
        must(composer.compile(desc));
        for (std::uint32_t number = 0; number < 1000; ++number) {
            must(composer.set(loop, "amount", number == 0 ? 0.0 : 1.0));
            Frame frame = number == 0 ? host.frame() : other.frame();
            frame.target = host.frame().target;
            frame.delta_time = 1.0 / 60;
            must(host.record(composer, frame));
        }
        const ReferenceImage last = host.read_target();
        for (std::size_t i = 0; i < first.pixels.size(); ++i) {
            ASSERT_EQ(last.pixels[i].r, first.pixels[i].r) << i;
            ASSERT_EQ(last.pixels[i].g, first.pixels[i].g) << i;
            ASSERT_EQ(last.pixels[i].b, first.pixels[i].b) << i;
        }
    }
}

TEST_F(ComposeWires, AnOutputHasTheSizeAndFormatThatItsEntryAsksFor) {
    ReferenceImage picture(8, 6);
    for (std::uint32_t y = 0; y < 6; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) picture.at(x, y) = {(x + y) % 2 == 0 ? 1.0 : 0.5, 0.1, 2, 1};
    const Host host(picture);
    Composer composer(gpu::test::device());
    const Handle half =
        add(composer, "negative", {{"amount", 0}}, {.scale = {1, 2}, .format = VK_FORMAT_R8G8B8A8_UNORM});
    add(composer, "blend", {{"amount", 1}}, {.input = scene_color, .second = half});
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    const auto plan = composer.compile(desc);
    ASSERT_TRUE(plan) << plan.error().text;
    ASSERT_FALSE(plan->passes.empty());
    EXPECT_EQ(plan->passes.front().extent.width, 4u);
    EXPECT_EQ(plan->passes.front().bytes_written, 4u * 3 * 4);
    EXPECT_EQ(plan->passes.back().extent.width, 8u);
    const Rgba pixel = host.run(composer).at(4, 3);
    EXPECT_NEAR(pixel.r, 0.75, 0.5 / 255 + 1e-6) << "two and two texels";
    EXPECT_EQ(pixel.b, 1) << "eight bits hold no more";
}

TEST_F(ComposeWires, WhatCannotBeReadIsRefused) {
    Composer composer(gpu::test::device());
    const Handle later = add(composer, "negative");
    const CompileDesc desc{.max_extent = {8, 8}};
    must(composer.rewire(later, {.mask = later}));
    auto plan = composer.plan(desc);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().text, "stack entry 'negative': its mask is not the output of an earlier entry");
    must(composer.rewire(later, {.scale = {1, 0}}));
    plan = composer.plan(desc);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().text, "stack entry 'negative': scale 1/0: allowed are numbers above 0");
    must(composer.rewire(later, {.mask = scene_alpha.previous()}));
    plan = composer.plan(desc);
    ASSERT_FALSE(plan);
    EXPECT_EQ(
        plan.error().text,
        "the scene's alpha has no previous frame: copy it by an entry, and read the previous frame of that entry");
}

}  // namespace
}  // namespace darkroom::test
