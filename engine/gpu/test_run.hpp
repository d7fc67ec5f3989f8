// SPDX-License-Identifier: MIT
#pragma once
// For tests only: pictures from floats and back to floats, and one kernel run on its own with its own buffers. It waits
// for the device after every step.

#include <algorithm>
#include <string>

#include "gpu/test_support.hpp"

namespace darkroom::gpu::test {

inline std::vector<std::byte> encode_pixels(const Pixels& pixels, VkFormat format) {
    const TestFormat layout = test_format(format);
    const std::size_t count = static_cast<std::size_t>(pixels.width) * pixels.height;
    std::vector<std::byte> bytes(count * layout.channels * layout.bytes);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        for (std::uint32_t channel = 0; channel < layout.channels; ++channel) {
            const std::size_t place = (pixel * layout.channels + stored_channel(layout, channel)) * layout.bytes;
            encode(layout, pixels.rgba[pixel * 4 + channel], bytes.data() + place);
        }
    }
    return bytes;
}

inline Pixels decode_pixels(std::span<const std::byte> bytes, VkExtent2D extent, VkFormat format) {
    const TestFormat layout = test_format(format);
    Pixels pixels = make_pixels(extent.width, extent.height, [](std::uint32_t, std::uint32_t) {
        return std::array{0.0F, 0.0F, 0.0F, 1.0F};
    });
    const std::size_t count = static_cast<std::size_t>(extent.width) * extent.height;
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        for (std::uint32_t channel = 0; channel < layout.channels; ++channel) {
            const std::size_t place = (pixel * layout.channels + stored_channel(layout, channel)) * layout.bytes;
            pixels.rgba[pixel * 4 + channel] = decode(layout, bytes.data() + place);
        }
    }
    return pixels;
}

inline VkBufferImageCopy whole_copy(const Image& image) {
    return {
        .imageSubresource = {.aspectMask = aspect_of(image.info.format), .layerCount = 1},
        .imageExtent = image.info.extent,
    };
}

/// A picture with every usage that its format has here, left in `layout`.
inline Picture upload(Context& context, const Pixels& pixels, VkFormat format,
                      VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL) {
    Picture picture{.image = must(Image::create(context, {.name = "test picture",
                                                          .format = format,
                                                          .extent = {pixels.width, pixels.height, 1},
                                                          .usage = all_usage(context, format)})),
                    .layout = layout};
    const std::vector<std::byte> bytes = encode_pixels(pixels, format);
    const Buffer staging = must(
        Buffer::create(context, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::Kind::Upload, "test upload"));
    std::ranges::copy(bytes, staging.memory.mapped);
    must(submit_and_wait(context, "uploading a test picture", [&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy = whole_copy(picture.image);
        transition(context, commands, picture.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, staging.handle, picture.image.handle,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        transition(context, commands, picture.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    }));
    return picture;
}

/// A picture of zeros.
inline Picture blank(Context& context, VkExtent2D extent, VkFormat format) {
    const auto zero = [](std::uint32_t, std::uint32_t) { return std::array<float, 4>{}; };
    return upload(context, make_pixels(extent.width, extent.height, zero), format, VK_IMAGE_LAYOUT_GENERAL);
}

/// The bytes of mip level 0, rows without padding.
inline std::vector<std::byte> download_bytes(Context& context, const Picture& picture) {
    const Image& image = picture.image;
    const TestFormat format = test_format(image.info.format);
    const std::size_t size =
        static_cast<std::size_t>(image.info.extent.width) * image.info.extent.height * format.channels * format.bytes;
    const Buffer staging =
        must(Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Kind::Readback, "test download"));
    must(submit_and_wait(context, "downloading a test picture", [&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy = whole_copy(image);
        transition(context, commands, image, picture.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        context.vk.CmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle, 1,
                                        &copy);
        transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, picture.layout);
    }));
    return {staging.memory.mapped, staging.memory.mapped + size};
}

inline Pixels download(Context& context, const Picture& picture) {
    const VkExtent3D extent = picture.image.info.extent;
    return decode_pixels(download_bytes(context, picture), {extent.width, extent.height}, picture.image.info.format);
}

struct Run {
    std::vector<Picture*> inputs;
    std::vector<Picture*> outputs;
    std::vector<Region> input_regions;  ///< empty: the whole pictures
    Region output_region{};             ///< extent 0: the whole picture
    std::vector<std::array<float, 4>> custom;
    std::vector<std::uint32_t> words;  ///< of spec.members
};

/// Runs the kernel once and leaves every picture in the layout in which it was used.
inline void run_kernel(Context& context, const Kernel& kernel, const Run& run) {
    const KernelSpec& spec = kernel.spec();
    const bool is_compute = kernel.stage() == Stage::Compute;
    std::vector<Binding> images;
    for (std::size_t index = 0; index < run.inputs.size(); ++index) {
        const Picture& picture = *run.inputs[index];
        const VkFormat format = picture.image.info.format;
        images.push_back({.view = picture.image.mip_views[0],
                          .region = run.input_regions.empty() ? picture.whole() : run.input_regions[index],
                          .is_nearest = !context.supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT)});
    }
    const bool is_whole = run.output_region.extent.width == 0;
    const Region region = is_whole ? run.outputs.front()->whole() : run.output_region;
    std::vector<Binding> outputs;
    for (const Picture* picture : run.outputs) {
        outputs.push_back({.view = picture->image.mip_views[0], .region = region});
    }
    const std::size_t own_size = own_block_size(spec);
    const Buffer own = must(Buffer::create(context, own_size, block_usage, Memory::Kind::Upload, "test block"));
    write_own_block(spec, region, images, run.custom, run.words, {own.memory.mapped, own_size});
    const VkDescriptorSetLayout layout = kernel.set_layout();
    const DescriptorSets sets = must(DescriptorSets::create(context, {&layout, 1}));
    kernel.write_set({.set = sets.sets[0], .own = {own.handle, 0, own_size}, .images = images, .outputs = outputs});
    must(submit_and_wait(context, "running " + spec.name, [&](VkCommandBuffer commands) {
        const auto use = [&](Picture& picture, VkImageLayout wanted) {
            transition(context, commands, picture.image, picture.layout, wanted);
            picture.layout = wanted;
        };
        for (std::size_t index = 0; index < run.inputs.size(); ++index) {
            const bool is_sampled = spec.images[index].storage_format == VK_FORMAT_UNDEFINED;
            use(*run.inputs[index], is_sampled ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL);
        }
        for (Picture* picture : run.outputs) {
            use(*picture, is_compute ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        }
        kernel.record(commands, sets.sets[0], outputs);
    }));
}

}  // namespace darkroom::gpu::test
