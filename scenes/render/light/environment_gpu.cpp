// SPDX-License-Identifier: MIT
#include "render/light/environment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace darkroom::render {

namespace {

constexpr float largest_half = 65504;

Result<VkSampler> create_sampler(gpu::Context& context) {
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_LINEAR,
                                   .minFilter = VK_FILTER_LINEAR,
                                   .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateSampler(context.device, &info, context.allocator, &sampler),
                               "creating the sampler of the environment"));
    return sampler;
}

/// Half where it holds every number, else float where the device filters it, else half with what is brighter cut.
VkFormat format_for(const gpu::Context& context, const Picture& picture) {
    const bool fits = std::ranges::all_of(picture.pixels, [](float value) { return std::abs(value) <= largest_half; });
    const bool is_filtered =
        context.supports(VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
    return fits || !is_filtered ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

void write_pixels(const Picture& picture, VkFormat format, std::byte* out) {
    if (format == VK_FORMAT_R32G32B32A32_SFLOAT) {
        std::memcpy(out, picture.pixels.data(), picture.pixels.size() * sizeof(float));
        return;
    }
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::uint16 half = glm::packHalf1x16(std::clamp(picture.pixels[i], -largest_half, largest_half));
        std::memcpy(out + i * sizeof half, &half, sizeof half);
    }
}

Result<gpu::Image> upload(gpu::Context& context, std::span<const Picture> levels, const char* name) {
    const VkFormat format = format_for(context, levels[0]);
    const VkDeviceSize texel = format == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8;
    DARKROOM_TRY_VALUE(
        gpu::Image image,
        gpu::Image::create(context, {.name = name,
                                     .format = format,
                                     .extent = {levels[0].width, levels[0].height, 1},
                                     .mip_levels = static_cast<std::uint32_t>(levels.size()),
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    VkDeviceSize size = 0;
    std::vector<VkBufferImageCopy> copies;
    for (const Picture& level : levels) {
        copies.push_back({.bufferOffset = size,
                          .imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                                               .mipLevel = static_cast<std::uint32_t>(copies.size()),
                                               .layerCount = 1},
                          .imageExtent = {level.width, level.height, 1}});
        size += VkDeviceSize{level.width} * level.height * texel;
    }
    DARKROOM_TRY_VALUE(gpu::Buffer staging, gpu::Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                                gpu::Memory::Kind::Upload, "environment upload"));
    for (std::size_t i = 0; i < levels.size(); ++i)
        write_pixels(levels[i], format, staging.memory.mapped + copies[i].bufferOffset);
    Result<> uploaded = gpu::submit_and_wait(context, "uploading the environment", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                        static_cast<std::uint32_t>(copies.size()), copies.data());
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    if (!uploaded) return failure(std::move(uploaded));
    return image;
}

}  // namespace

Result<GpuEnvironment> GpuEnvironment::create(gpu::Context& context, const std::optional<Picture>& skybox) {
    constexpr std::uint32_t table_size = 64, level_count = 6, min_width = 64, max_width = 256;
    GpuEnvironment out;
    out.context = &context;
    DARKROOM_TRY_VALUE(out.sampler, create_sampler(context));
    out.is_given = skybox && !skybox->empty();

    std::vector<Picture> sky(1, Picture(1, 1)), table(1, Picture(1, 1)), mirror(1, Picture(1, 1));
    if (out.is_given) {
        const std::uint32_t most = context.traits.max_image_dimension;
        const bool fits = skybox->width <= most && skybox->height <= most;
        sky[0] = fits ? *skybox : resampled(*skybox, std::min(skybox->width, most), std::min(skybox->height, most));
        out.irradiance = irradiance_harmonics(*skybox);
        mirror = prefilter(*skybox, std::clamp(std::bit_floor(skybox->width), min_width, max_width), level_count);
        table[0] = split_sum_table(table_size);
        out.levels = level_count;
    }
    Result<gpu::Image> image = upload(context, sky, "skybox");
    if (!image) return failure(std::move(image));
    out.skybox = std::move(*image);
    image = upload(context, mirror, "prefiltered environment");
    if (!image) return failure(std::move(image));
    out.prefiltered = std::move(*image);
    image = upload(context, table, "split-sum table");
    if (!image) return failure(std::move(image));
    out.split_sum = std::move(*image);
    return out;
}

GpuEnvironment::GpuEnvironment(GpuEnvironment&& other) noexcept { *this = std::move(other); }
GpuEnvironment& GpuEnvironment::operator=(GpuEnvironment&& other) noexcept {
    std::swap(prefiltered, other.prefiltered);
    std::swap(skybox, other.skybox);
    std::swap(split_sum, other.split_sum);
    std::swap(sampler, other.sampler);
    std::swap(irradiance, other.irradiance);
    std::swap(levels, other.levels);
    std::swap(is_given, other.is_given);
    std::swap(context, other.context);
    return *this;
}
GpuEnvironment::~GpuEnvironment() {
    if (sampler != VK_NULL_HANDLE) context->vk.DestroySampler(context->device, sampler, context->allocator);
}

}  // namespace darkroom::render
