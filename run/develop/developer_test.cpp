// SPDX-License-Identifier: MIT
#include "develop/developer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <darkroom/effects.hpp>
#include <fstream>
#include <limits>

#include "core/srgb.hpp"
#include "gpu/test_run.hpp"
#include "plan/text/half.hpp"

namespace darkroom {
namespace {

namespace support = gpu::test;

TEST(ComposeHalf, EveryHalfComesBackAndNothingElseIsOne) {
    for (std::uint32_t bits = 0; bits <= 0xffffU; ++bits) {
        const auto half = static_cast<std::uint16_t>(bits);
        const float value = half_to_float(half);
        if (!std::isfinite(value)) {
            EXPECT_EQ(bits & 0x7c00U, 0x7c00U);
            continue;
        }
        ASSERT_EQ(exact_half(value), half) << value;
        const float above = std::nextafter(value, std::numeric_limits<float>::infinity());
        ASSERT_FALSE(exact_half(above)) << value;
    }
    EXPECT_EQ(half_to_float(0x0001), std::ldexp(1.0F, -24));
    EXPECT_EQ(half_to_float(0xc000), -2.0F);
    for (const float none : {65520.0F, 1e30F, 0.1F, std::numeric_limits<float>::infinity(), std::nanf("")})
        EXPECT_FALSE(exact_half(none)) << none;
}

/// Every effect of the flat table that is on, and those that depend on the frame's number; but not what gathers frames,
/// since the same one comes several times.
void fill(Composer& composer) {
    for (const EffectInfo* const effect : all_effects())
        if (effect->flat.documented >= 0 && !effect->output_scale.is_of_output)
            composer.add(*effect, nullptr, {.source = scene_color});
}

ImageRef reference_to(const support::Picture& picture) {
    return {.image = picture.image.handle,
            .view = picture.image.mip_views[0],
            .format = picture.image.info.format,
            .extent = {picture.image.info.extent.width, picture.image.info.extent.height},
            .layout = picture.layout};
}

support::Pixels scene(std::uint32_t width, std::uint32_t height) {
    return support::make_pixels(width, height, [](std::uint32_t x, std::uint32_t y) {
        // All of them halves.
        const float red = x == 5 && y == 3 ? 300.0F : static_cast<float>(x) / 16;
        return std::array{red, static_cast<float>(y) / 8, 0.25F, 0.5F};
    });
}

TEST(ComposeDeveloper, ImagesOfTheDeviceAndOfMainMemoryGiveTheSameBytes) {
    Device& device = support::device();
    gpu::Context& context = device.context();
    const support::Pixels pixels = scene(33, 17);
    const support::Pixels depth = support::make_pixels(33, 17, [](std::uint32_t x, std::uint32_t) {
        return std::array{1.0F + static_cast<float>(x) / 3, 0.0F, 0.0F, 1.0F};
    });
    const support::Picture color = support::upload(context, pixels, VK_FORMAT_R16G16B16A16_SFLOAT);
    const support::Picture planar = support::upload(context, depth, VK_FORMAT_R32_SFLOAT);
    for (const DevelopTarget target :
         {DevelopTarget::Encoded8, DevelopTarget::EncodedFloat, DevelopTarget::SceneLinear}) {
        Composer composer(device, {.frames_in_flight = 1});
        fill(composer);
        Developer developer(device, {.target = target});
        const DeviceFrame on_device{.frame = {.color = reference_to(color),
                                              .depth = reference_to(planar),
                                              .camera = {.depth = DepthKind::Planar},
                                              .time = 2,
                                              .frame_index = 3},
                                    .color_usage = color.image.info.usage};
        FrameLayers layers;
        const Result<DevelopedPicture> first = developer.develop(composer, on_device, &layers);
        ASSERT_TRUE(first) << first.error().text;
        EXPECT_EQ(layers.color, pixels.rgba);
        ASSERT_EQ(layers.depth.size(), 33U * 17U);
        EXPECT_EQ(layers.depth[4], 1.0F + 4.0F / 3);
        EXPECT_TRUE(layers.normals.empty());

        const DevelopInput in_memory{
            .extent = {33, 17}, .color = layers.color, .depth = layers.depth, .time = 2, .frame_index = 3};
        EXPECT_EQ(compile_desc_for(device, in_memory, {}).color.format, VK_FORMAT_R16G16B16A16_SFLOAT);
        const Result<DevelopedPicture> second = developer.develop(composer, in_memory);
        ASSERT_TRUE(second) << second.error().text;
        EXPECT_EQ(first->bytes, second->bytes);
        EXPECT_EQ(first->pixels, second->pixels);
        // And back again: nothing of the other way is left over.
        const Result<DevelopedPicture> third = developer.develop(composer, on_device);
        ASSERT_TRUE(third) << third.error().text;
        EXPECT_EQ(first->bytes, third->bytes);
        EXPECT_EQ(first->pixels, third->pixels);
    }
}

TEST(ComposeDeveloper, ColoursWithoutAlphaAndCodesAreThoseOfFloats) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "this build has no effect exposure";
    constexpr std::size_t count = std::size_t{19} * 7;
    std::vector<float> four, three, light;
    std::vector<std::uint16_t> halves;
    std::vector<std::uint8_t> codes;
    for (std::size_t i = 0; i < count * 3; ++i) {
        const float value = static_cast<float>(i % 64) / 16;
        codes.push_back(static_cast<std::uint8_t>(i * 7 % 256));
        three.push_back(value);
        halves.push_back(*exact_half(value));
        four.push_back(value);
        light.push_back(static_cast<float>(srgb_decode(codes.back() / 255.0)));
        if (i % 3 != 2) continue;
        four.push_back(1);
        light.push_back(1);
    }
    Composer composer(support::device(), {.frames_in_flight = 1});
    composer.add(*find_effect("exposure"), nullptr);
    Developer developer(support::device(), {.target = DevelopTarget::EncodedFloat});
    const auto picture = [&](DevelopInput input) {
        input.extent = {19, 7};
        return support::must(developer.develop(composer, input)).pixels;
    };
    const std::vector<float> expected = picture({.color = four});
    EXPECT_EQ(picture({.color = three, .color_channels = 3}), expected);
    EXPECT_EQ(picture({.color_channels = 3, .color_halves = halves}), expected);
    EXPECT_EQ(picture({.color_codes = codes, .color_channels = 3}), picture({.color = light}));
    codes.pop_back();
    const auto wrong = developer.develop(composer, {.extent = {19, 7}, .color_codes = codes, .color_channels = 3});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().text, "color: 398 codes, 19x7 pixels need 399");
}

TEST(ComposeDeveloper, PicturesHaveAnExtentOfTheirOwn) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "this build has no effect exposure";
    const support::Pixels pixels = scene(33, 17);
    const VkExtent2D large{66, 34};
    Composer composer(support::device(), {.frames_in_flight = 1});
    composer.add(*find_effect("exposure"), nullptr);
    Developer developer(support::device(), {.target = DevelopTarget::SceneLinear, .target_extent = large});
    DevelopInput input{.extent = {33, 17}, .color = pixels.rgba};
    const Result<DevelopedPicture> made = developer.develop(composer, input);
    ASSERT_TRUE(made) << made.error().text;
    ASSERT_EQ(made->extent.width, large.width);
    ASSERT_EQ(made->extent.height, large.height);
    // Between four pixels, below the bright one.
    for (std::uint32_t y = 12; y < large.height - 1; ++y)
        for (std::uint32_t x = 1; x < large.width - 1; ++x) {
            const float* const found = &made->pixels[4 * (std::size_t{y} * large.width + x)];
            EXPECT_NEAR(found[0], ((static_cast<float>(x) + 0.5F) / 2 - 0.5F) / 16, 2e-3F) << x << ", " << y;
            EXPECT_NEAR(found[1], ((static_cast<float>(y) + 0.5F) / 2 - 0.5F) / 8, 2e-3F) << x << ", " << y;
        }
    // The interface is as large as the picture.
    const std::vector<std::uint8_t> small(std::size_t{33} * 17 * 4), right(std::size_t{66} * 34 * 4);
    input.ui = small;
    const Result<DevelopedPicture> refused = developer.develop(composer, input);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "ui: 2244 bytes, 66x34 pixels need 8976");
    input.ui = right;
    EXPECT_TRUE(developer.develop(composer, input));
}

// With the frame's size as its target's it would be refused.
TEST(ComposeDeveloper, APictureIsAsLargeAsTheLastEntryMakesIt) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "this build has no effect exposure";
    const support::Pixels pixels = scene(33, 17);
    const support::Picture color = support::upload(support::device().context(), pixels, VK_FORMAT_R16G16B16A16_SFLOAT);
    for (const auto& [scale, extent] :
         {std::pair(OutputScale{1, 2}, VkExtent2D{16, 8}), std::pair(OutputScale{2, 1}, VkExtent2D{66, 34})}) {
        Composer composer(support::device(), {.frames_in_flight = 1});
        composer.add(*find_effect("exposure"), nullptr, {.scale = scale});
        Developer developer(support::device(), {.target = DevelopTarget::SceneLinear});
        const Result<DevelopedPicture> of_memory =
            developer.develop(composer, DevelopInput{.extent = {33, 17}, .color = pixels.rgba});
        ASSERT_TRUE(of_memory) << of_memory.error().text;
        EXPECT_EQ(of_memory->extent.width, extent.width);
        EXPECT_EQ(of_memory->extent.height, extent.height);
        EXPECT_EQ(of_memory->pixels.size(), std::size_t{extent.width} * extent.height * 4);
        const Result<DevelopedPicture> of_device = developer.develop(
            composer, DeviceFrame{.frame = {.color = reference_to(color)}, .color_usage = color.image.info.usage});
        ASSERT_TRUE(of_device) << of_device.error().text;
        EXPECT_EQ(of_device->pixels, of_memory->pixels);
    }
}

TEST(ComposeDeveloper, WhatIsRecordedBeforeIsSeenAndItsErrorEndsIt) {
    Device& device = support::device();
    gpu::Context& context = device.context();
    const support::Picture color = support::blank(context, {8, 8}, VK_FORMAT_R16G16B16A16_SFLOAT);
    Composer composer(device, {.frames_in_flight = 1});
    Developer developer(device, {.target = DevelopTarget::SceneLinear});
    DeviceFrame input{.frame = {.color = reference_to(color)}, .color_usage = color.image.info.usage};
    input.record_before = [&](VkCommandBuffer commands) -> Result<> {
        const VkClearColorValue value{.float32 = {0.5F, 2, 4, 1}};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        gpu::transition(context, commands, color.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        context.vk.CmdClearColorImage(commands, color.image.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
        gpu::transition(context, commands, color.image, VK_IMAGE_LAYOUT_GENERAL, color.layout);
        return {};
    };
    for (int i = 0; i < 2; ++i) {
        FrameLayers layers;
        const Result<DevelopedPicture> picture = developer.develop(composer, input, &layers);
        ASSERT_TRUE(picture) << picture.error().text;
        EXPECT_EQ(picture->pixels[1], 2);
        EXPECT_EQ(layers.color[2], 4);
    }
    const Result<FrameLayers> layers = read_layers(device, input.frame, input.record_before);
    ASSERT_TRUE(layers) << layers.error().text;
    EXPECT_EQ(layers->color[0], 0.5F);
    input.record_before = [](VkCommandBuffer) -> Result<> { return user_error("no"); };
    const Result<DevelopedPicture> failed = developer.develop(composer, input);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().text, "no");
}

TEST(ComposeDeveloper, ReadsPicturesOfBytesAndHalves) {
    gpu::Context& context = support::device().context();
    const support::Pixels pixels = scene(3, 2);
    const support::Picture halves = support::upload(context, pixels, VK_FORMAT_R16G16B16A16_SFLOAT);
    const Result<DevelopedPicture> floats = read_picture(support::device(), reference_to(halves), {});
    ASSERT_TRUE(floats) << floats.error().text;
    EXPECT_EQ(floats->pixels, pixels.rgba);
    const support::Picture bytes = support::upload(context, pixels, VK_FORMAT_R8G8B8A8_UNORM);
    const Result<DevelopedPicture> read = read_picture(support::device(), reference_to(bytes), {});
    ASSERT_TRUE(read) << read.error().text;
    ASSERT_EQ(read->bytes.size(), 24U);
    EXPECT_EQ(read->bytes[2], 64);
    ImageRef other = reference_to(bytes);
    other.format = VK_FORMAT_R8_UNORM;
    EXPECT_FALSE(read_picture(support::device(), other, {}));
}

/// Of this process, in MiB.
double memory() {
    std::ifstream file("/proc/self/statm");
    double all = 0, resident = 0;
    file >> all >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// Mesa 22.3 makes a kernel anew, and keeps it, where a loop or a branch is decided by values of a block alone.
TEST(ComposeDeveloper, FramesOfNoEffectKeepMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "what is freed is kept to be watched";
#endif
    constexpr VkExtent2D extent{480, 270};
    std::vector<float> color(std::size_t{4} * extent.width * extent.height), depth(color.size() / 4, 8.0F);
    for (std::size_t i = 0; i < color.size(); ++i) color[i] = i % 4 == 3 ? 1.0F : static_cast<float>(i * 37 % 101) / 20;
    for (const EffectInfo* const effect : all_effects()) {
        Composer composer(support::device(), {.frames_in_flight = 1});
        composer.add(*effect, nullptr, {.second = effect->has_second() ? scene_color : Handle()});
        Developer developer(support::device(), {.target = DevelopTarget::SceneLinear});
        double before = 0;
        for (std::uint64_t frame = 0; frame < 30; ++frame) {
            if (frame == 6) before = memory();
            support::must(
                developer.develop(composer, {.extent = extent, .color = color, .depth = depth, .frame_index = frame}));
        }
        EXPECT_LE(memory() - before, 6) << effect->name;
    }
}

}  // namespace
}  // namespace darkroom
