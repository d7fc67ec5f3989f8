// SPDX-License-Identifier: MIT
#include "render/pass/resolve.hpp"

#include <gtest/gtest.h>

#include <darkroom/composer.hpp>
#include <darkroom/effects.hpp>
#include <limits>
#include <set>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D resolved_extent{64, 48};

bool has_four_samples() { return (gpu::test::context().traits.sample_counts & VK_SAMPLE_COUNT_4_BIT) != 0; }

/// A bright wall whose left edge cuts pixels of column 20 in half: at distance 4 there are 6 pixels a metre.
scene::Snapshot half_covered(float brightness) {
    scene::Snapshot snapshot = snapshot_of(resolved_extent);
    add_box(snapshot, {(20.5F - 32) / 6, -9, -5}, {9, 9, -4}, plain({brightness, brightness, brightness, 1}));
    return snapshot;
}

TEST(RenderGpuResolve, OneSampleHasHardEdges) {
    Renderer renderer = renderer_for({.extent = resolved_extent}, {}, dark_scene());
    const Shot shot = shoot(renderer, half_covered(4));
    EXPECT_EQ(shot.color.at(19, 24)[0], 0);
    EXPECT_EQ(shot.color.at(21, 24)[0], 4);
    EXPECT_TRUE(shot.color.at(20, 24)[0] == 0 || shot.color.at(20, 24)[0] == 4);
}

TEST(RenderGpuResolve, AnInfiniteFarPlaneCutsNothingAndHasDepth) {
    scene::Snapshot snapshot = snapshot_of(resolved_extent);
    snapshot.camera.far_distance = std::numeric_limits<float>::infinity();
    snapshot.camera.projection[2].z = 0;
    snapshot.camera.projection[3].z = near_plane;
    snapshot.camera.previous_projection = snapshot.camera.projection;
    add_wall(snapshot, 5000, 9000, plain(vec4(1)));
    Renderer renderer = renderer_for({.extent = resolved_extent}, {}, dark_scene());
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_EQ(shot.color.at(32, 24)[0], 1);
    EXPECT_NEAR(shot.depth.at(32, 24)[0], 5000, 0.1F);
    EXPECT_NEAR(shot.velocity.at(32, 24)[0], 0, 1e-3F);
}

TEST(RenderGpuResolve, EdgesAreWeighedByTheInverseOfOnePlusLuminance) {
    if (!has_four_samples()) GTEST_SKIP() << "the device has no 4 samples";
    Renderer renderer = renderer_for({.extent = resolved_extent, .samples = 4}, {}, dark_scene());
    const Shot shot = shoot(renderer, half_covered(4));
    EXPECT_EQ(shot.color.at(19, 24)[0], 0);
    EXPECT_NEAR(shot.color.at(21, 24)[0], 4, 4e-3F);
    // Two samples of 4 with weight 1/5, two of 0 with weight 1: 2 * 4/5 / (2 + 2/5). A plain mean would be 2.
    EXPECT_NEAR(shot.color.at(20, 24)[0], 1.6F / 2.4F, 2e-3F);
    EXPECT_EQ(shot.color.at(20, 24)[3], 1);
}

TEST(RenderGpuResolve, DepthNormalsAndVelocityAreOfTheNearestSample) {
    if (!has_four_samples()) GTEST_SKIP() << "the device has no 4 samples";
    Renderer renderer = renderer_for({.extent = resolved_extent, .samples = 4}, {}, dark_scene());
    scene::Snapshot snapshot = half_covered(1);
    snapshot.instances[0].previous_world = glm::translate(mat4(1), {0, 0.5F, 0}) * snapshot.instances[0].world;
    add_wall(snapshot, 10, 30, plain(vec4(1)));
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_NEAR(shot.depth.at(19, 24)[0], 10, 1e-3F);
    EXPECT_NEAR(shot.depth.at(20, 24)[0], 4, 1e-3F);
    EXPECT_NEAR(shot.depth.at(21, 24)[0], 4, 1e-3F);
    EXPECT_NEAR(shot.normals.at(20, 24)[2], 1, 1e-3F);
    EXPECT_NEAR(shot.velocity.at(19, 24)[1], 0, 0.01F);
    EXPECT_NEAR(shot.velocity.at(20, 24)[1], -3, 0.01F);
}

TEST(RenderGpuResolve, AlphaIsAPlainMean) {
    if (!has_four_samples()) GTEST_SKIP() << "the device has no 4 samples";
    scene::Scene scene = dark_scene();
    scene.has_alpha_layer = true;
    Renderer renderer = renderer_for({.extent = resolved_extent, .samples = 4}, {}, scene);
    scene::Snapshot snapshot = half_covered(4);
    snapshot.materials[0].writes = scene::Writes::Alpha;
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_EQ(shot.color.at(19, 24)[3], 0);
    EXPECT_EQ(shot.color.at(20, 24)[3], 0.5F);
    EXPECT_EQ(shot.color.at(21, 24)[3], 1);
}

/// Watches a device for multi-sampled images: who makes them, who reads them, what attachments resolve.
struct SampleWatch {
    static inline std::set<VkImage> images;
    static inline std::set<VkImageView> views;
    static inline std::uint32_t reads = 0, resolving_attachments = 0;
    static inline gpu::Dispatch real;

    explicit SampleWatch(gpu::Dispatch& table) : vk(table) {
        real = vk;
        images.clear();
        views.clear();
        vk.CreateImage = [](VkDevice device, const VkImageCreateInfo* info, const VkAllocationCallbacks* allocator,
                            VkImage* image) {
            const VkResult result = real.CreateImage(device, info, allocator, image);
            if (info->samples != VK_SAMPLE_COUNT_1_BIT) images.insert(*image);
            return result;
        };
        vk.CreateImageView = [](VkDevice device, const VkImageViewCreateInfo* info,
                                const VkAllocationCallbacks* allocator, VkImageView* view) {
            const VkResult result = real.CreateImageView(device, info, allocator, view);
            if (images.contains(info->image)) views.insert(*view);
            return result;
        };
        vk.UpdateDescriptorSets = [](VkDevice device, std::uint32_t count, const VkWriteDescriptorSet* writes,
                                     std::uint32_t copies, const VkCopyDescriptorSet* copied) {
            for (std::uint32_t i = 0; i < count; ++i)
                for (std::uint32_t j = 0; j < writes[i].descriptorCount; ++j)
                    if (writes[i].pImageInfo != nullptr && views.contains(writes[i].pImageInfo[j].imageView)) ++reads;
            real.UpdateDescriptorSets(device, count, writes, copies, copied);
        };
        vk.CmdBeginRendering = [](VkCommandBuffer commands, const VkRenderingInfo* info) {
            for (std::uint32_t i = 0; i < info->colorAttachmentCount; ++i)
                if (info->pColorAttachments[i].resolveMode != VK_RESOLVE_MODE_NONE) ++resolving_attachments;
            real.CmdBeginRendering(commands, info);
        };
    }
    ~SampleWatch() { vk = real; }
    SampleWatch(const SampleWatch&) = delete;
    SampleWatch& operator=(const SampleWatch&) = delete;

    gpu::Dispatch& vk;
};

// Each of the four drawn layers is read once a frame, and by nothing but the resolve, while effects read colour, depth
// and normals over and over.
TEST(RenderGpuResolve, ThereIsOneAFrameForAllEffects) {
    if (!has_four_samples()) GTEST_SKIP() << "the device has no 4 samples";
    Device& device = gpu::test::device();
    Composer composer(device, {.frames_in_flight = 1});
    for (const char* const name : {"ssao", "bloom", "fog", "tonemap", "encode"}) {
        if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
        composer.add(*find_effect(name), nullptr);
    }
    const gpu::test::Picture target = gpu::test::blank(device.context(), resolved_extent, VK_FORMAT_R8G8B8A8_UNORM);
    SampleWatch watch(device.context().vk);
    Renderer renderer = renderer_for({.extent = resolved_extent, .samples = 4});
    ASSERT_EQ(SampleWatch::images.size(), 4U) << "colour, normals, velocity, depth";
    const scene::Snapshot snapshot = half_covered(4);
    must(renderer.prepare(snapshot));
    Frame frame = renderer.frame();
    const auto plan = composer.compile({.max_extent = resolved_extent,
                                        .color = {frame.color.format, renderer.layer_usage()},
                                        .depth = {frame.depth.format, renderer.layer_usage()},
                                        .is_depth_planar = true,
                                        .normals = {frame.normals.format, renderer.layer_usage()},
                                        .target = {VK_FORMAT_R8G8B8A8_UNORM, target.image.info.usage}});
    ASSERT_TRUE(plan) << plan.error().text;
    ASSERT_TRUE(plan->left_out.empty()) << plan->left_out.front();
    for (std::uint64_t number = 1; number <= 3; ++number) {
        SampleWatch::reads = SampleWatch::resolving_attachments = 0;
        must(renderer.prepare(snapshot));
        must(gpu::submit_and_wait(device.context(), "a frame for all effects", [&](VkCommandBuffer commands) {
            must(renderer.record(commands));
            frame = renderer.frame();
            frame.target = {.image = target.image.handle,
                            .view = target.image.mip_views[0],
                            .format = VK_FORMAT_R8G8B8A8_UNORM,
                            .extent = resolved_extent,
                            .layout = target.layout,
                            .final_layout = target.layout};
            must(composer.record(commands, frame));
        }));
        EXPECT_EQ(SampleWatch::reads, 4U) << "frame " << number;
        EXPECT_EQ(SampleWatch::resolving_attachments, 0U);
        EXPECT_EQ(renderer.counters().resolves, number);
    }
}

TEST(RenderGpuResolve, DisplayPicturesHaveNone) {
    for (const std::uint32_t samples : {1U, 4U}) {
        if (samples == 4 && !has_four_samples()) continue;
        Renderer renderer = renderer_for(
            {.extent = resolved_extent, .samples = samples, .output = Output::Display, .is_tone_mapped = false}, {},
            dark_scene());
        const Pixels picture = shoot(renderer, half_covered(1)).color;
        EXPECT_EQ(renderer.counters().resolves, 0U);
        EXPECT_EQ(picture.at(19, 24)[0], 0);
        EXPECT_EQ(picture.at(21, 24)[0], 1);
        if (samples == 4) {
            EXPECT_NEAR(picture.at(20, 24)[0], 0.5F, 1.5F / 255) << "the mean of encoded samples";
        }
    }
}

TEST(RenderGpuResolve, DisplayPicturesAreEncoded) {
    Renderer renderer =
        renderer_for({.extent = resolved_extent, .output = Output::Display, .is_tone_mapped = false}, {}, dark_scene());
    scene::Snapshot snapshot = snapshot_of(resolved_extent);
    add_wall(snapshot, 4, 3, plain({0.5F, 0.0F, 1, 1}));
    const std::array<float, 4> found = shoot(renderer, snapshot).color.at(32, 24);
    EXPECT_NEAR(found[0], 188.0F / 255, 0.6F / 255);
    EXPECT_EQ(found[1], 0);
    EXPECT_EQ(found[2], 1);
}

}  // namespace
}  // namespace darkroom::render
