// SPDX-License-Identifier: MIT
// What a frame may bring and need not: effects read it, or what stands in for it, at their own size.

#include <darkroom/custom_effect.hpp>

#include "compose/test_stacks/effects.hpp"
#include "compose/test_stacks/host.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom {
namespace {

constexpr std::uint32_t mask_width = 26, mask_height = 18;

constexpr EffectFile careful_files[] = {
    {"careful.glsl",
     "vec4 careful(vec4 color, Pixel pixel, Careful parameters) {\n"
     "    float loaded = load(careful_reactive, pixel.texel).r;\n"
     "    float sampled = sample_linear(careful_reactive, pixel.uv).r;\n"
     "    return vec4(loaded, sampled, color.b * load(careful_exposure, pixel.texel).r, 1.0);\n}\n"},
};
/// Shows the reactive mask, loaded and sampled, and its blue exposed.
const EffectInfo careful{.name = "careful",
                         .doc = "Shows what a frame need not bring.",
                         .parameters = {.struct_name = "Careful"},
                         .files = careful_files,
                         .needs = {FrameImage::Reactive, FrameImage::Exposure},
                         .build = [](PassBuilder& builder) {
                             builder.side("careful_reactive", builder.frame_image(FrameImage::Reactive), {});
                             builder.side("careful_exposure", builder.frame_image(FrameImage::Exposure), {});
                         }};

constexpr std::string_view custom_text =
    "// @effect careful_file: Shows what a frame need not bring.\n"
    "// @needs reactive exposure\n"
    "vec4 careful_file(vec4 color, Pixel pixel, CarefulFile parameters) {\n"
    "    float loaded = load(frame_reactive, pixel.texel).r;\n"
    "    float sampled = sample_linear(frame_reactive, pixel.uv).r;\n"
    "    return vec4(loaded, sampled, color.b * load(frame_exposure, pixel.texel).r, 1.0);\n}\n";

double mask_at(std::uint32_t x, std::uint32_t y) { return ((x * 7 + y * 3) % 16) / 16.0; }

class ComposeFrameInput : public ::testing::Test {
  protected:
    /// What the effect sees, behind a halved picture or not.
    ReferenceImage shown(const EffectInfo& effect, bool is_given, bool is_halved = false,
                         KernelStage kernels = KernelStage::Auto) {
        Composer composer(host.device);
        if (is_halved) composer.add(test::halve_effect, nullptr);
        composer.add(effect, nullptr);
        CompileDesc desc = host.compile_desc();
        desc.kernels = kernels;
        Frame frame = host.frame();
        if (is_given) {
            desc.reactive = {reactive.image.info.format};
            desc.exposure = {exposure.image.info.format};
            frame.reactive = test::image_ref(reactive);
            frame.exposure = test::image_ref(exposure);
        }
        const Plan plan = test::must(composer.compile(desc));
        EXPECT_TRUE(plan.left_out.empty());
        EXPECT_EQ(std::ranges::count(plan.frame_images, "reactive"), is_given ? 1 : 0);
        const gpu::test::Picture target =
            gpu::test::blank(host.device.context(), plan.passes.back().extent, desc.target.format);
        frame.target = test::image_ref(target);
        test::must(host.record(composer, frame));
        return test::image_of(gpu::test::download(host.device.context(), target));
    }
    void expect_shown(const EffectInfo& effect) {
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage with = shown(effect, true, false, stage), without = shown(effect, false, false, stage);
            for (std::uint32_t y = 0; y < mask_height; ++y)
                for (std::uint32_t x = 0; x < mask_width; ++x) {
                    ASSERT_NEAR(with.at(x, y).r, mask_at(x, y), 0.5 / 255 + 1e-6) << x << ", " << y;
                    ASSERT_NEAR(with.at(x, y).g, with.at(x, y).r, 1e-6 + gpu::test::filter_step());
                    ASSERT_NEAR(with.at(x, y).b, 0.25 * 1.5, 1e-6);
                    ASSERT_EQ(without.at(x, y).r, 0) << x << ", " << y;
                    ASSERT_EQ(without.at(x, y).g, 0);
                    ASSERT_EQ(without.at(x, y).b, 0.25);
                }
        }
    }

    test::Host host{ReferenceImage(mask_width, mask_height, {0.5, 0.75, 0.25, 1})};
    gpu::test::Picture reactive =
        gpu::test::upload(host.device.context(),
                          gpu::test::make_pixels(mask_width, mask_height,
                                                 [](std::uint32_t x, std::uint32_t y) {
                                                     const auto value = static_cast<float>(mask_at(x, y));
                                                     return std::array{value, 0.0F, 0.0F, 0.0F};
                                                 }),
                          VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_GENERAL);
    gpu::test::Picture exposure =
        gpu::test::upload(host.device.context(),
                          gpu::test::make_pixels(1, 1,
                                                 [](std::uint32_t, std::uint32_t) {
                                                     return std::array{1.5F, 0.0F, 0.0F, 0.0F};
                                                 }),
                          VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
};

TEST_F(ComposeFrameInput, EffectsReadWhatIsThereAndElseWhatStandsIn) { expect_shown(careful); }

TEST_F(ComposeFrameInput, SoDoEffectsOfUsers) {
    const CustomEffect file = test::must(CustomEffect::parse(custom_text, "careful.glsl"));
    expect_shown(file.info());
}

TEST_F(ComposeFrameInput, AMaskIsFilteredToTheSizeOfThePicture) {
    const ReferenceImage half = shown(careful, true, true);
    ASSERT_EQ(half.width, mask_width / 2);
    for (std::uint32_t y = 0; y < half.height; ++y)
        for (std::uint32_t x = 0; x < half.width; ++x) {
            const double mean = (mask_at(2 * x, 2 * y) + mask_at(2 * x + 1, 2 * y) + mask_at(2 * x, 2 * y + 1) +
                                 mask_at(2 * x + 1, 2 * y + 1)) /
                                4;
            ASSERT_NEAR(half.at(x, y).r, mean, 0.5 / 255 + 0x1p-11) << x << ", " << y;
            ASSERT_NEAR(half.at(x, y).b, 0.25 * 1.5, 1e-6);
        }
}

TEST_F(ComposeFrameInput, WhatNeedsPerspectiveIsLeftOutOfFramesWithout) {
    constexpr EffectFile lens_files[] = {{"lens.glsl",
                                          "vec4 lens(vec4 color, Pixel pixel, Lens parameters) {\n"
                                          "    return vec4(1.0 - color.rgb, color.a);\n}\n"}};
    const EffectInfo lens{.name = "lens",
                          .doc = "Turns the picture as a lens does.",
                          .parameters = {.struct_name = "Lens"},
                          .files = lens_files,
                          .needs = Needs{}.and_perspective()};
    Composer composer(host.device);
    composer.add(lens, nullptr);
    EXPECT_TRUE(test::must(composer.compile(host.compile_desc())).left_out.empty());
    for (const bool has_perspective : {true, false, true}) {
        Frame frame = host.frame();
        if (has_perspective) frame.camera.projection[11] = -1;
        test::must(host.record(composer, frame));
        EXPECT_EQ(host.read_target().at(3, 2).r, 0.5);
        EXPECT_EQ(host.read_target().at(3, 2).g, has_perspective ? 0.25 : 0.75);
        const std::vector<std::string> left_out{"lens: needs perspective, which the frame's camera does not have"};
        EXPECT_EQ(composer.current_plan()->left_out, has_perspective ? std::vector<std::string>{} : left_out);
    }
}

// After a day a float's steps are of 8 ms; kernels get the time since the last full hour.
TEST_F(ComposeFrameInput, ShadersSeeTheTimeToTheMillisecondAfterADay) {
    const CustomEffect clock =
        test::must(CustomEffect::parse("// @effect clock: Shows the time.\n"
                                       "vec4 clock(vec4 color, Pixel pixel, Clock parameters) {\n"
                                       "    return vec4(frame_time / 4096.0, fract(frame_time), 0.0, 1.0);\n}\n",
                                       "clock.glsl"));
    Composer composer(host.device);
    composer.add(clock.info(), nullptr);
    test::must(composer.compile(host.compile_desc()));
    const auto shown_at = [&](double time) {
        Frame frame = host.frame();
        frame.time = time;
        test::must(host.record(composer, frame));
        return host.read_target().at(3, 2);
    };
    for (const double time : {10.125, 3599.125, 3600.125, 3.0 * 3600 + 7.125, 86400.0 + 10.125}) {
        EXPECT_NEAR(shown_at(time).r * 4096, std::fmod(time, 3600.0), 0.01) << time;
        EXPECT_NEAR(shown_at(time).g, 0.125, 1e-3) << time;
    }
    EXPECT_NEAR(shown_at(24 * 3600.0 + 0.001).g, 0.001, 1e-4);
}

TEST(FrameInputs, EveryOneIsReadByNameOrLeavesItsReadersOut) {
    for (const plan::FrameInput& input : plan::frame_inputs) {
        EXPECT_EQ(&plan::frame_input(input.image), &input);
        EXPECT_EQ(input.given == nullptr, input.use == nullptr) << input.name;
        const std::string missing = plan::missing_needs({input.image}, [](FrameImage) { return false; });
        EXPECT_EQ(missing, input.is_optional ? "" : input.shown);
        EXPECT_EQ(plan::missing_needs({input.image}, [&](FrameImage image) { return image == input.image; }), "");
        CompileDesc a, b;
        if (input.use != nullptr) (a.*input.use).format = VK_FORMAT_R8_UNORM;
        EXPECT_EQ(plan::is_given(a, input), input.use != nullptr);
        EXPECT_EQ(plan::bring_the_same(a, b), input.use == nullptr) << input.name << ": a plan would be kept";
    }
}

}  // namespace
}  // namespace darkroom
