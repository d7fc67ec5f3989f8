// SPDX-License-Identifier: MIT
#include "render/targets.hpp"

#include <gtest/gtest.h>

#include "gpu/test_support.hpp"

namespace darkroom::render {
namespace {

using gpu::test::must;

constexpr VkExtent2D small_target{5, 3};

TEST(RenderGpuTargets, FinalImagesCanBeReadWrittenAndCopied) {
    const Targets targets = must(Targets::create(gpu::test::context(), {.extent = small_target, .formats = {}}));
    EXPECT_FALSE(targets.is_multi_sampled());
    EXPECT_TRUE(targets.has_layers());
    constexpr VkImageUsageFlags least =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    for (const gpu::Image* image : {&targets.color, &targets.normals, &targets.velocity, &targets.planar_depth}) {
        EXPECT_EQ(image->info.usage & least, least) << image->info.name;
        const bool has_storage = gpu::test::context().supports(image->info.format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
        EXPECT_EQ((image->info.usage & VK_IMAGE_USAGE_STORAGE_BIT) != 0, has_storage) << image->info.name;
        EXPECT_EQ(image->info.extent.width, 5U);
        EXPECT_EQ(image->info.extent.height, 3U);
    }
    EXPECT_EQ(targets.planar_depth.info.format, VK_FORMAT_R32_SFLOAT);
}

TEST(RenderGpuTargets, SamplesAreKeptApartFromWhatIsHandedOn) {
    if ((gpu::test::context().traits.sample_counts & VK_SAMPLE_COUNT_4_BIT) == 0)
        GTEST_SKIP() << "the device has no 4 samples";
    const Targets targets = must(
        Targets::create(gpu::test::context(), {.extent = small_target, .formats = {.samples = VK_SAMPLE_COUNT_4_BIT}}));
    EXPECT_TRUE(targets.is_multi_sampled());
    for (const gpu::Image* image : {&targets.many_color, &targets.many_normals, &targets.many_velocity, &targets.depth})
        EXPECT_EQ(image->info.samples, VK_SAMPLE_COUNT_4_BIT) << image->info.name;
    EXPECT_EQ(targets.color.info.samples, VK_SAMPLE_COUNT_1_BIT);
}

TEST(RenderGpuTargets, DisplayPicturesHaveNoLayers) {
    const TargetFormats formats{.color = VK_FORMAT_B8G8R8A8_UNORM, .has_layers = false};
    const Targets targets = must(Targets::create(gpu::test::context(), {.extent = small_target, .formats = formats}));
    EXPECT_FALSE(targets.has_layers());
    EXPECT_EQ(targets.planar_depth.handle, VK_NULL_HANDLE);
    const ImageRef picture = targets.copied_picture();
    EXPECT_EQ(picture.format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(picture.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

TEST(RenderGpuTargets, ReferencesSayHowImagesWereLeft) {
    const Targets targets = must(Targets::create(gpu::test::context(), {.extent = small_target, .formats = {}}));
    const ResolveUse compute{.stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             .write_stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             .write_access = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                             .write_layout = VK_IMAGE_LAYOUT_GENERAL};
    const ImageRef color = targets.drawn(targets.color, compute), depth = targets.drawn(targets.planar_depth, compute);
    EXPECT_EQ(color.layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL) << "drawn, not resolved";
    EXPECT_EQ(color.last_stages, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT);
    EXPECT_EQ(depth.layout, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_EQ(depth.last_access, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

}  // namespace
}  // namespace darkroom::render
