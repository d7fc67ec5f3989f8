// SPDX-License-Identifier: MIT
// Device::assumed(): stacks are planned and developed by reference on it as on a device that is there, and no more.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>

#include "compose/test_stacks/support.hpp"
#include "develop/developer.hpp"
#include "develop/reference_chain.hpp"
#include "gpu/device/assumed_device.hpp"
#include "gpu/test_run.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

void fill_with_everything(Composer& composer) {
    for (const EffectInfo* const effect : all_effects())
        if (!effect->has_second()) composer.add(*effect, nullptr);
}

CompileDesc everything_given(Device& device, DevelopTarget target) {
    // Large enough that what drivers pad images by is little.
    constexpr VkExtent2D extent{637, 363};
    constexpr std::size_t count = std::size_t{extent.width} * extent.height;
    const std::vector<float> texels(4 * count, 0.1F);
    const std::vector<ReferenceLight> lights{{.resolution = 1, .cascades = {{1.0F}}}};
    const std::span<const float> all = texels;
    return compile_desc_for(device,
                            {.extent = extent,
                             .color = all,
                             .depth = all.first(count),
                             .normals = all.first(3 * count),
                             .velocity = all.first(2 * count),
                             .lights = lights},
                            {.target = target, .kernels = KernelStage::Raster});
}

TEST(ComposeAssumedDevice, PlansWhatADeviceWouldRun) {
    Device assumed = Device::assumed();
    for (const DevelopTarget target : {DevelopTarget::Encoded8, DevelopTarget::SceneLinear}) {
        Composer here(gpu::test::device()), nowhere(assumed);
        fill_with_everything(here);
        fill_with_everything(nowhere);
        Plan real = must(here.plan(everything_given(gpu::test::device(), target)));
        Plan plan = must(nowhere.plan(everything_given(assumed, target)));
        // Where one samples an image that another loads, these passes are of different rounds.
        for (Plan* const each : {&real, &plan}) std::ranges::stable_sort(each->passes, {}, &PlanPass::name);
        ASSERT_EQ(plan.passes.size(), real.passes.size());
        ASSERT_GT(plan.passes.size(), 3u);
        for (std::size_t i = 0; i < plan.passes.size(); ++i) {
            EXPECT_EQ(plan.passes[i].name, real.passes[i].name);
            EXPECT_EQ(plan.passes[i].entries, real.passes[i].entries);
            EXPECT_EQ(plan.passes[i].stage, real.passes[i].stage);
            EXPECT_EQ(plan.passes[i].bytes_read, real.passes[i].bytes_read) << plan.passes[i].name;
            EXPECT_EQ(plan.passes[i].bytes_written, real.passes[i].bytes_written) << plan.passes[i].name;
        }
        EXPECT_EQ(plan.left_out, real.left_out);
        EXPECT_LE(plan.transient_bytes, plan.transient_bytes_unaliased);
        EXPECT_NEAR(static_cast<double>(plan.transient_bytes_unaliased),
                    static_cast<double>(real.transient_bytes_unaliased),
                    0.25 * static_cast<double>(real.transient_bytes_unaliased))
            << "drivers add padding";
        ASSERT_EQ(plan.remarks.size(), real.remarks.size() + 1);
        EXPECT_EQ(plan.remarks.back(), gpu::assumed_device_remark(DeviceProfile::Gpu));
    }
}

TEST(ComposeAssumedDevice, RunsNothingAndSaysSo) {
    const Device assumed = Device::assumed();
    EXPECT_FALSE(assumed.info().is_usable);
    Composer composer(assumed);
    fill_with_everything(composer);
    for (const Result<>& refused : {composer.compile({.max_extent = {8, 8}}).map([](const Plan&) {}),
                                    composer.compile_later({.max_extent = {8, 8}})}) {
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().fault, Fault::User);
        EXPECT_TRUE(refused.error().text.starts_with("compile: the composer is on an assumed device"))
            << refused.error().text;
    }
    EXPECT_FALSE(composer.pending().is_pending);
    EXPECT_FALSE(composer.record(VK_NULL_HANDLE, {}));
}

TEST(ComposeAssumedDevice, AllowsPicturesOf16384ASide) {
    Device assumed = Device::assumed();
    const Composer composer(assumed);
    EXPECT_TRUE(check_extent(assumed, {16384, 16384}));
    EXPECT_TRUE(composer.plan({.max_extent = {16384, 16384}}));
    EXPECT_FALSE(composer.plan({.max_extent = {16385, 1}}));
    const Result<> refused = check_extent(assumed, {1, 16385});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "size 1x16385: an assumed device allows 1x1 to 16384x16384");
}

TEST(ComposeAssumedDevice, RefusesFormatsThatFewDevicesTake) {
    const Composer composer(Device::assumed());
    const auto is_target = [&](VkFormat format) {
        return composer.plan({.max_extent = {8, 8}, .target = {format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}})
            .has_value();
    };
    EXPECT_TRUE(is_target(VK_FORMAT_B8G8R8A8_SRGB));
    EXPECT_TRUE(is_target(VK_FORMAT_B10G11R11_UFLOAT_PACK32));
    EXPECT_FALSE(is_target(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32));
    EXPECT_FALSE(is_target(VK_FORMAT_R32G32B32_SFLOAT));
    EXPECT_FALSE(is_target(VK_FORMAT_D32_SFLOAT));
    EXPECT_FALSE(is_target(VK_FORMAT_BC7_SRGB_BLOCK));
}

TEST(ComposeAssumedDevice, HoldsAStackForTheReferences) {
    const ReferenceImage picture = test::random_hdr(19, 11, 4);
    const auto developed = [&](const Device& device) {
        Composer composer(device);
        for (const EffectInfo* const effect : all_effects())
            if (effect->flat.documented >= 0) composer.add(*effect, nullptr, {.source = scene_color});
        return must(run_reference(composer, {.color = &picture}));
    };
    const ReferenceChainOutput here = developed(gpu::test::device()), nowhere = developed(Device::assumed());
    EXPECT_EQ(nowhere.left_out, here.left_out);
    EXPECT_GT(test::worst_difference(nowhere.picture, picture), 0);
    EXPECT_EQ(test::worst_difference(nowhere.picture, here.picture), 0);
}

}  // namespace
}  // namespace darkroom
