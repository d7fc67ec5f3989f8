// SPDX-License-Identifier: MIT
// Formats of which a device can do less than the software driver: its table of formats is faked. What it cannot load is
// sampled, and what it cannot filter the kernels do.

#include <map>
#include <set>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using gpu::Dispatch;

/// What the faked driver lacks, or says it can beyond the real one, and what was asked of it.
struct Fake {
    Dispatch real{};
    std::map<VkFormat, VkFormatFeatureFlags> missing, more;
    std::map<VkImageView, VkFormat> formats;
    std::set<VkFormat> loaded, sampled, filtered;  ///< by storage descriptors that are read or written, and by samplers
    VkSampler linear = VK_NULL_HANDLE;
};
Fake fake;

void fake_properties(VkPhysicalDevice device, VkFormat format, VkFormatProperties* out) {
    fake.real.GetPhysicalDeviceFormatProperties(device, format, out);
    if (const auto found = fake.missing.find(format); found != fake.missing.end())
        out->optimalTilingFeatures &= ~found->second;
    if (const auto found = fake.more.find(format); found != fake.more.end())
        out->optimalTilingFeatures |= found->second;
}
VkResult fake_view(VkDevice device, const VkImageViewCreateInfo* info, const VkAllocationCallbacks* allocator,
                   VkImageView* out) {
    const VkResult result = fake.real.CreateImageView(device, info, allocator, out);
    if (result == VK_SUCCESS) fake.formats[*out] = info->format;
    return result;
}
void fake_update(VkDevice device, std::uint32_t count, const VkWriteDescriptorSet* writes, std::uint32_t copies,
                 const VkCopyDescriptorSet* copied) {
    for (std::uint32_t i = 0; i < count; ++i) {
        if (writes[i].pImageInfo == nullptr) continue;
        const VkFormat format = fake.formats[writes[i].pImageInfo->imageView];
        if (writes[i].descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) fake.loaded.insert(format);
        if (writes[i].descriptorType != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) continue;
        fake.sampled.insert(format);
        if (writes[i].pImageInfo->sampler == fake.linear) fake.filtered.insert(format);
    }
    fake.real.UpdateDescriptorSets(device, count, writes, copies, copied);
}

class ComposeFormat : public test::StackTest {
  protected:
    void SetUp() override {
        test::StackTest::SetUp();
        renew();
    }
    /// A device asks for a format once: another one sees what is missing now.
    void renew() {
        device = test::must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
        gpu::Context& context = device.context();
        fake = {.real = context.vk, .linear = context.linear_sampler};
        context.vk.GetPhysicalDeviceFormatProperties = fake_properties;
        context.vk.CreateImageView = fake_view;
        context.vk.UpdateDescriptorSets = fake_update;
    }
    void TearDown() override { EXPECT_EQ(device.validation_messages(), 0u); }

    ReferenceImage enlarged();
    static ReferenceImage picture() { return test::round_to_half(test::random_display(40, 33, 5)); }
    static void fill(Composer& composer) {
        test::add(composer, "exposure", {{"exposure", 2}});
        test::add(composer, "gaussian_blur", {{"radius", 2}});
        test::add(composer, "negative");
    }

    Device device = test::must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
};

constexpr VkFormat half_format = VK_FORMAT_R16G16B16A16_SFLOAT, whole_format = VK_FORMAT_R32G32B32A32_SFLOAT,
                   packed_format = VK_FORMAT_B10G11R11_UFLOAT_PACK32, single_format = VK_FORMAT_R32_SFLOAT;
constexpr VkFormatFeatureFlags storage = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT,
                               filter = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;

TEST_F(ComposeFormat, WhatCannotBeLoadedIsSampled) {
    ReferenceImage expected;
    for (const bool is_missing : {false, true}) {
        renew();
        if (is_missing) fake.missing[half_format] = storage;
        test::Host host(picture(), half_format, whole_format, device);
        Composer composer(device, {.frames_in_flight = 1});
        fill(composer);
        CompileDesc desc = host.compile_desc();
        desc.color.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
        desc.intermediate = half_format;
        test::must(composer.compile(desc));
        const ReferenceImage out = host.run(composer);
        EXPECT_EQ(fake.loaded.contains(half_format), !is_missing);
        EXPECT_TRUE(fake.sampled.contains(half_format) || !is_missing);
        if (!is_missing) expected = out;
        EXPECT_EQ(test::worst_difference(out, expected), 0);
    }
}

TEST_F(ComposeFormat, DepthIsNoTargetThoughADeviceStoresIt) {
    fake.more[VK_FORMAT_D32_SFLOAT] = storage;
    Composer composer(device);
    fill(composer);
    const ImageUse depth{VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT};
    const CompileDesc good{
        .max_extent = {40, 33}, .color = {half_format}, .target = {half_format, VK_IMAGE_USAGE_STORAGE_BIT}};
    CompileDesc bad = good, badly_watched = good;
    bad.target = depth;
    badly_watched.watches = {{.id = 1, .target = depth}};
    test::must(composer.compile(good));
    for (const auto& [desc, name] : {std::pair{bad, "target"}, {badly_watched, "watches[0].target"}}) {
        const auto plan = composer.compile(desc);
        ASSERT_FALSE(plan) << name;
        EXPECT_TRUE(plan.error().text.starts_with(std::string("compile: ") + name + ".format = D32_SFLOAT"))
            << plan.error().text;
    }
}

TEST_F(ComposeFormat, AnExtendedFormatIsLoadedOnlyWhereTheFeatureIsEnabled) {
    for (const bool has_feature : {true, false}) {
        device.context().traits.has_extended_storage_formats = has_feature;
        for (const VkFormat intermediate : {half_format, packed_format}) {
            Composer composer(device);
            fill(composer);
            const auto plan =
                composer.compile({.max_extent = {40, 33},
                                  .color = {packed_format, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                                  .intermediate = intermediate});
            EXPECT_TRUE(plan) << plan.error().text;
        }
    }
}

/// A picture of 32 bits, with depth of 32 bits, on a larger target.
ReferenceImage ComposeFormat::enlarged() {
    test::Host host(picture(), whole_format, whole_format, device);
    const gpu::test::Picture depth = gpu::test::upload(
        device.context(),
        gpu::test::make_pixels(40, 33,
                               [](std::uint32_t x, std::uint32_t y) {
                                   return std::array{0.5F + static_cast<float>(x * y % 7), 0.0F, 0.0F, 0.0F};
                               }),
        single_format, VK_IMAGE_LAYOUT_GENERAL);
    Composer composer(device, {.frames_in_flight = 1});
    if (find_effect("ssao") != nullptr) test::add(composer, "ssao");
    if (find_effect("god_rays") != nullptr) test::add(composer, "god_rays");
    fill(composer);
    CompileDesc desc = host.compile_desc();
    desc.color.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    desc.depth = {single_format};
    desc.target_extent = {80, 50};
    const gpu::test::Picture large = gpu::test::blank(device.context(), desc.target_extent, whole_format);
    test::must(composer.compile(desc));
    Frame frame = host.frame();
    frame.depth = test::image_ref(depth);
    frame.camera = test::look_at({0, 0, 0}, {0, 0, -1}, 1, 1);
    frame.target = test::image_ref(large);
    test::must(host.record(composer, frame));
    return test::image_of(gpu::test::download(device.context(), large));
}

TEST_F(ComposeFormat, WhatCannotBeFilteredTheKernelsFilter) {
    const ReferenceImage expected = enlarged();
    EXPECT_TRUE(fake.filtered.contains(whole_format));
    renew();
    fake.missing[whole_format] = fake.missing[single_format] = filter;
    // The blur keeps light up to 4 in halves between its passes: a place that is rounded may end in the next one.
    EXPECT_LE(test::worst_difference(enlarged(), expected), 0x1p-9 + 2 * gpu::test::filter_step());
    EXPECT_TRUE(fake.sampled.contains(whole_format) && fake.sampled.contains(single_format));
    EXPECT_FALSE(fake.filtered.contains(whole_format));
    EXPECT_FALSE(fake.filtered.contains(single_format));
    EXPECT_TRUE(fake.filtered.contains(half_format)) << "what can be filtered is";
}

TEST_F(ComposeFormat, DepthIsNeverFiltered) {
    const auto find = find_effect("ssao");
    if (find == nullptr) GTEST_SKIP() << "this build has no effect that reads depth";
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,
                                  VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32}) {
        if (!device.context().supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) continue;
        const test::Host host(picture(), half_format, whole_format, device);
        gpu::Context& context = device.context();
        const gpu::Image depth = test::must(
            gpu::Image::create(context, {.name = "depth",
                                         .format = format,
                                         .extent = {40, 33, 1},
                                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
        Composer composer(device, {.frames_in_flight = 1});
        test::add(composer, "ssao");
        CompileDesc desc = host.compile_desc();
        desc.depth = {format};
        test::must(composer.compile(desc));
        Frame frame = host.frame();
        frame.camera = test::look_at({0, 0, 0}, {0, 0, -1}, 1, 1);
        frame.camera.depth = DepthKind::Standard;
        frame.depth = {.image = depth.handle,
                       .view = depth.mip_views[0],
                       .format = format,
                       .extent = {40, 33},
                       .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        test::must(gpu::submit_and_wait(context, "readying the depth", [&](VkCommandBuffer commands) {
            const bool has_stencil = format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
            VkImageAspectFlags aspects = VK_IMAGE_ASPECT_DEPTH_BIT;
            if (has_stencil) aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
            const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                                .newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                .image = depth.handle,
                                                .subresourceRange = {aspects, 0, 1, 0, 1}};
            const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                              .imageMemoryBarrierCount = 1,
                                              .pImageMemoryBarriers = &barrier};
            context.vk.CmdPipelineBarrier2(commands, &dependency);
        }));
        test::must(host.record(composer, frame));
        EXPECT_TRUE(fake.sampled.contains(format)) << format;
        EXPECT_FALSE(fake.filtered.contains(format)) << format;
    }
}

}  // namespace
}  // namespace darkroom
