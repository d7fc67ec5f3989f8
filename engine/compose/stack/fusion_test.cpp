// SPDX-License-Identifier: MIT
// Fusion is invisible: random stacks give the same picture fused and unfused, in either stage, and every time.

#include <cmath>
#include <limits>

#include "compose/test_stacks/random_stack.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeFusion : public test::StackTest {
  protected:
    void SetUp() override {
        StackTest::SetUp();
        if (find_effect("fog") == nullptr) GTEST_SKIP() << "this build has no effect fog";
    }
};

constexpr std::uint32_t stack_count = 14;

ReferenceImage picture_of(std::uint32_t number) {
    constexpr VkExtent2D sizes[] = {{64, 48}, {67, 41}, {1, 1}, {33, 2}, {97, 64}};
    const VkExtent2D size = sizes[number % std::size(sizes)];
    ReferenceImage picture = test::random_display(size.width, size.height, number);
    for (Rgba& pixel : picture.pixels) pixel = {pixel.r * 4.5 - 0.5, pixel.g * 4.5 - 0.5, pixel.b * 4.5 - 0.5, 1};
    return test::round_to_float(picture);
}

bool has_history(const Composer& composer) {
    for (std::size_t i = 0; i < composer.size(); ++i)
        if (composer.info(composer.entry(i))->touch == Touch::History) return true;
    return false;
}

/// Do both store what passes between their kernels in the same formats?
bool stores_alike(const Plan& a, const Plan& b) {
    return std::ranges::equal(a.images, b.images, {}, &PlanImage::format, &PlanImage::format);
}

TEST_F(ComposeFusion, FusedAndUnfusedGiveTheSamePicture) {
    std::size_t fused_kernels = 0, unfused_kernels = 0;
    for (std::uint32_t number = 0; number < stack_count; ++number) {
        const test::Host host(picture_of(number));
        Composer composer(host.device);
        std::mt19937 random(number * 2654435761u + 17);
        test::fill_random(random, composer, {});
        SCOPED_TRACE("stack " + std::to_string(number) + ":" + test::described(composer));
        CompileDesc desc = host.compile_desc();

        desc.kernels = KernelStage::Compute;
        const auto plan = composer.compile(desc);
        ASSERT_TRUE(plan) << plan.error().text;
        fused_kernels += plan->passes.size();
        const ReferenceImage fused = host.run(composer);
        // A mean of a frame and the same one before is that frame but for rounding.
        EXPECT_LE(test::worst_difference(host.run(composer), fused), has_history(composer) ? 1e-5 : 0)
            << "a second frame differs";

        // A first frame, too: histories outlive a change of the stage.
        desc.kernels = KernelStage::Raster;
        Composer other(host.device);
        std::mt19937 again(number * 2654435761u + 17);
        test::fill_random(again, other, {});
        const auto raster_plan = other.compile(desc);
        ASSERT_TRUE(raster_plan) << raster_plan.error().text;
        const ReferenceImage raster = host.run(other);
        // Where stages may round otherwise, fxaa, which compares pixels, may take another one for an edge.
        if (gpu::test::is_lavapipe()) {
            EXPECT_EQ(test::worst_difference(raster, fused), 0) << "the stages differ";
        } else if (stores_alike(*plan, *raster_plan) && !composer.find("fxaa")) {
            EXPECT_LE(test::worst_codes(raster, fused), 1) << "the stages differ";
        }

        desc.kernels = KernelStage::Auto;
        desc.fuse = false;
        const auto unfused_plan = composer.compile(desc);
        ASSERT_TRUE(unfused_plan) << unfused_plan.error().text;
        unfused_kernels += unfused_plan->passes.size();
        EXPECT_LE(test::worst_codes(host.run(composer), fused), 1) << "unfused differs";
    }
    EXPECT_LT(fused_kernels + 5, unfused_kernels) << "nothing was fused";
}

// A left-out entry hands on what it gets, and its readers with it.
TEST_F(ComposeFusion, ALeftOutEntryPassesItsReadersOn) {
    const test::Host host(picture_of(0));
    const auto picture = [&](bool is_fused, bool has_fog) {
        Composer composer(host.device);
        const Handle exposure = add(composer, "exposure", {{"exposure", 0.5}});
        const Handle read = has_fog ? add(composer, "fog") : exposure;
        add(composer, "tonemap");
        add(composer, "negative", {}, {.input = read});
        CompileDesc desc = host.compile_desc();
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        return host.run(composer);
    };
    EXPECT_LE(test::worst_difference(picture(true, true), picture(false, true)), 1e-6);
    EXPECT_EQ(test::worst_difference(picture(true, true), picture(true, false)), 0);
}

TEST_F(ComposeFusion, TheTargetReadsWhatALeftOutEntryHandsOn) {
    const ReferenceImage picture = picture_of(0);
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle exposure = add(composer, "exposure", {{"exposure", 0.5}});
    add(composer, "negative", {}, {.input = exposure});
    add(composer, "fog", {}, {.input = exposure});
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage out = host.run(composer);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) ASSERT_EQ(out.pixels[i].g, picture.pixels[i].g * 0.5);
}

TEST_F(ComposeFusion, FiniteInputStaysFinite) {
    const ReferenceImage picture = test::round_to_half(test::random_hdr(45, 37, 3));
    const test::Host host(picture, VK_FORMAT_R16G16B16A16_SFLOAT);
    Composer composer(host.device);
    add(composer, "bloom", {{"intensity", 1}, {"threshold", 0}}, {.source = scene_color});
    const Handle bright = add(composer, "exposure", {{"exposure", 100}});
    add(composer, "gaussian_blur", {{"radius", 5}}, {.opacity = 0.5f});
    add(composer, "blend", {{"amount", 0.25}}, {.second = bright});
    add(composer, "tonemap");
    add(composer, "encode");
    add(composer, "dither", {{"intensity", 0.1}});
    add(composer, "vignette", {{"intensity", 1}});
    for (const bool is_fused : {true, false}) {
        CompileDesc desc = host.compile_desc();
        desc.intermediate = VK_FORMAT_R16G16B16A16_SFLOAT;
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        for (const Rgba& p : host.run(composer).pixels)
            ASSERT_TRUE(p.r >= 0 && p.r <= 1 && p.g >= 0 && p.g <= 1 && p.b >= 0 && p.b <= 1)
                << p.r << " " << p.g << " " << p.b;
    }
}

TEST_F(ComposeFusion, WarpsCountWhatIsNoNumberAsNothing) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(45, 37, 3));
    for (std::uint32_t i = 0; i < 45; i += 4) picture.at(i, i % 37) = {nan, nan, nan, 1};
    picture.at(30, 9) = {infinity, -infinity, nan, 1};
    const test::Host host(picture);
    std::mt19937 random(8);
    std::size_t tried = 0;
    for (const EffectInfo* const info : all_effects()) {
        // What lies on no edge it leaves as it is.
        if (info->touch != Touch::Warp || info->name == "fxaa" || info->name == "smaa") continue;
        ++tried;
        for (int i = 0; i < 5; ++i) {
            Composer composer(host.device);
            test::set_random(random, composer, composer.add(*info, nullptr), test::Values::Sane);
            test::must(composer.compile(host.compile_desc()));
            for (const Rgba& p : host.run(composer).pixels)
                ASSERT_TRUE(std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b)) << info->name;
        }
    }
    EXPECT_GE(tried, 1U);
}

}  // namespace
}  // namespace darkroom
