// SPDX-License-Identifier: MIT
#include "develop/readback.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/assert.hpp"
#include "gpu/resource/formats.hpp"
#include "plan/text/half.hpp"

namespace darkroom {

namespace {

struct Layout {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t channels = 0;
    std::uint32_t bytes = 0;  ///< of one channel
};
constexpr std::array layouts{
    Layout{VK_FORMAT_R8G8B8A8_UNORM, 4, 1},      Layout{VK_FORMAT_R16_SFLOAT, 1, 2},
    Layout{VK_FORMAT_R16G16_SFLOAT, 2, 2},       Layout{VK_FORMAT_R16G16B16A16_SFLOAT, 4, 2},
    Layout{VK_FORMAT_R32_SFLOAT, 1, 4},          Layout{VK_FORMAT_R32G32_SFLOAT, 2, 4},
    Layout{VK_FORMAT_R32G32B32A32_SFLOAT, 4, 4}, Layout{VK_FORMAT_D32_SFLOAT, 1, 4},
    Layout{VK_FORMAT_B8G8R8A8_UNORM, 4, 1},
};

const Layout* layout_of(VkFormat format) {
    for (const Layout& layout : layouts)
        if (layout.format == format) return &layout;
    return nullptr;
}

std::size_t texel_count(const ImageRef& image) {
    const VkExtent2D extent = image.used_region().extent;
    return std::size_t{extent.width} * extent.height * image.layer_count;
}

void barrier(const gpu::Context& context, VkCommandBuffer commands, const ImageRef& image, VkImageLayout from,
             VkImageLayout to) {
    const VkImageMemoryBarrier2 of_image{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image.image,
        .subresourceRange = {gpu::format_traits(image.format).aspects, image.mip_level, 1, image.array_layer,
                             image.layer_count},
    };
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &of_image};
    context.vk.CmdPipelineBarrier2(commands, &dependency);
}

void barrier_to_host(const gpu::Context& context, VkCommandBuffer commands) {
    const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    context.vk.CmdPipelineBarrier2(commands, &dependency);
}

float number(const std::byte* at, std::uint32_t bytes) {
    if (bytes == 1) return static_cast<float>(std::to_integer<int>(*at)) / 255.0F;
    if (bytes == 2) {
        std::uint16_t half = 0;
        std::memcpy(&half, at, sizeof half);
        return half_to_float(half);
    }
    float value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// `body` records into a buffer that is submitted and waited for.
Result<> submit(gpu::Context& context, const RecordBefore& before, const std::function<void(VkCommandBuffer)>& body) {
    Result<> recorded{};
    Result<> submitted = gpu::submit_and_wait(context, "reading a picture", [&](VkCommandBuffer commands) {
        if (before) recorded = before(commands);
        if (recorded) body(commands);
    });
    return recorded ? submitted : recorded;
}

}  // namespace

Result<Readback> Readback::create(gpu::Context& context, const ImageRef& image) {
    const Layout* const layout = layout_of(image.format);
    if (layout == nullptr)
        return user_error(fmt::format(
            "an image of VkFormat {} cannot be read back, only RGBA8, floats of 16 or 32 bits, 32-bit depth",
            static_cast<int>(image.format)));
    const VkDeviceSize bytes = VkDeviceSize{texel_count(image)} * layout->channels * layout->bytes;
    DARKROOM_TRY_VALUE(gpu::Buffer buffer, gpu::Buffer::create(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                               gpu::Memory::Kind::Readback, "read-back picture"));
    Readback out;
    out.context_ = &context;
    out.image_ = image;
    out.buffer_ = std::move(buffer);
    return out;
}

void Readback::record(VkCommandBuffer commands) const {
    const VkRect2D region = image_.used_region();
    const VkBufferImageCopy copy{.imageSubresource = {gpu::sampled_aspect(image_.format), image_.mip_level,
                                                      image_.array_layer, image_.layer_count},
                                 .imageOffset = {region.offset.x, region.offset.y, 0},
                                 .imageExtent = {region.extent.width, region.extent.height, 1}};
    barrier(*context_, commands, image_, image_.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    context_->vk.CmdCopyImageToBuffer(commands, image_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer_.handle, 1,
                                      &copy);
    barrier(*context_, commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image_.layout);
    barrier_to_host(*context_, commands);
}

std::vector<float> Readback::floats(std::uint32_t channels) const {
    const Layout& layout = *layout_of(image_.format);
    DARKROOM_ASSERT(channels <= layout.channels);
    const std::size_t pixels = texel_count(image_);
    std::vector<float> out(pixels * channels);
    const std::byte* at = buffer_.memory.mapped;
    if (layout.bytes == sizeof(float) && layout.channels == channels) {
        std::memcpy(out.data(), at, out.size() * sizeof(float));
        return out;
    }
    for (std::size_t pixel = 0; pixel < pixels; ++pixel, at += std::size_t{layout.channels} * layout.bytes)
        for (std::uint32_t c = 0; c < channels; ++c)
            out[pixel * channels + c] = number(at + std::size_t{c} * layout.bytes, layout.bytes);
    return out;
}

std::vector<std::uint8_t> Readback::bytes() const {
    const bool is_blue_first = image_.format == VK_FORMAT_B8G8R8A8_UNORM;
    DARKROOM_ASSERT(is_blue_first || image_.format == VK_FORMAT_R8G8B8A8_UNORM);
    std::vector<std::uint8_t> out(texel_count(image_) * 4);
    std::memcpy(out.data(), buffer_.memory.mapped, out.size());
    if (is_blue_first)
        for (std::size_t i = 0; i < out.size(); i += 4) std::swap(out[i], out[i + 2]);
    return out;
}

Result<FrameReadback> FrameReadback::create(gpu::Context& context, const Frame& frame) {
    FrameReadback out;
    out.extent_ = frame.color.used_region().extent;
    const auto add = [&](const ImageRef& image, std::optional<Readback>& slot) -> Result<> {
        if (!image.is_given()) return {};
        DARKROOM_TRY_VALUE(slot, Readback::create(context, image));
        return {};
    };
    DARKROOM_TRY(add(frame.color, out.color_));
    DARKROOM_TRY(add(frame.depth, out.depth_));
    DARKROOM_TRY(add(frame.normals, out.normals_));
    DARKROOM_TRY(add(frame.velocity, out.velocity_));
    DARKROOM_TRY(add(frame.transparency, out.transparency_));
    for (const Light& light : frame.lights) {
        out.lights_.push_back(light);
        ImageRef cascades = light.cascades;
        cascades.layer_count = light.cascade_count;
        if (light.cascade_count == 0) cascades = {};
        DARKROOM_TRY(add(cascades, out.cascades_.emplace_back()));
    }
    return out;
}

void FrameReadback::record(VkCommandBuffer commands) const {
    for (const std::optional<Readback>* const layer : {&color_, &depth_, &normals_, &velocity_, &transparency_})
        if (*layer) (*layer)->record(commands);
    for (const std::optional<Readback>& cascades : cascades_)
        if (cascades) cascades->record(commands);
}

FrameLayers FrameReadback::layers() const {
    FrameLayers out{.extent = extent_};
    if (color_) out.color = color_->floats(4);
    if (depth_) out.depth = depth_->floats(1);
    if (normals_) out.normals = normals_->floats(3);
    if (velocity_) out.velocity = velocity_->floats(2);
    if (transparency_) out.transparency = transparency_->floats(3);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        ReferenceLight& light = out.lights.emplace_back(ReferenceLight{.light = lights_[i]});
        light.light.cascades = {};  // the image is the host's
        if (!cascades_[i]) continue;
        light.resolution = lights_[i].cascades.used_region().extent.width;
        const std::vector<float> depths = cascades_[i]->floats(1);
        const auto texels = static_cast<std::ptrdiff_t>(depths.size() / lights_[i].cascade_count);
        for (auto first = depths.begin(); first != depths.end(); first += texels)
            light.cascades.emplace_back(first, first + texels);
    }
    return out;
}

Result<FrameLayers> read_layers(Device& device, const Frame& frame, const RecordBefore& before) {
    DARKROOM_TRY_VALUE(FrameReadback readback, FrameReadback::create(device.context(), frame));
    DARKROOM_TRY(submit(device.context(), before, [&](VkCommandBuffer c) { readback.record(c); }));
    return readback.layers();
}

Result<DevelopedPicture> read_picture(Device& device, const ImageRef& image, const RecordBefore& before) {
    DARKROOM_TRY_VALUE(Readback readback, Readback::create(device.context(), image));
    DARKROOM_TRY(submit(device.context(), before, [&](VkCommandBuffer c) { readback.record(c); }));
    DevelopedPicture out{.extent = image.used_region().extent};
    if (image.format == VK_FORMAT_R8G8B8A8_UNORM)
        out.bytes = readback.bytes();
    else
        out.pixels = readback.floats(4);
    return out;
}

}  // namespace darkroom
