// SPDX-License-Identifier: MIT
#pragma once
// Bytes to device-local buffers and images through staging memory, many of them in one submission. It waits for the
// device, so it is for loading and not for frames.

#include <cstddef>
#include <span>
#include <vector>

#include "gpu/resource/resources.hpp"

namespace darkroom::render {

class Uploader {
  public:
    explicit Uploader(gpu::Context& context) : context_(&context) {}

    /// A device-local buffer with these bytes once flush() has returned; not smaller than `least_size`, where it is
    /// zero beyond the bytes.
    [[nodiscard]] Result<gpu::Buffer> buffer(std::span<const std::byte> bytes, VkBufferUsageFlags usage,
                                             std::size_t least_size, std::string_view name);
    /// A sampled RGBA image of 8 or 16 bits a sample with these levels, as `format` has them, in
    /// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL once flush() has returned. The levels halve (rounding down, not below
    /// 1). The image must stay where it is until flush().
    struct Level {
        std::uint32_t width = 0, height = 0;
        std::span<const std::byte> bytes;
    };
    Result<> image(gpu::Image& out, VkFormat format, std::span<const Level> levels, std::string_view name);
    /// Submits what was asked for and waits.
    Result<> flush();

  private:
    struct BufferCopy {
        VkBuffer source, target;
        VkDeviceSize size;
    };
    struct ImageCopy {
        VkBuffer source;
        const gpu::Image* target;
        std::vector<VkBufferImageCopy> regions;
    };
    Result<VkBuffer> stage(std::size_t size, std::byte*& mapped);

    gpu::Context* context_;
    std::vector<gpu::Buffer> staging_;
    std::size_t staged_bytes_ = 0;
    std::vector<BufferCopy> buffer_copies_;
    std::vector<ImageCopy> image_copies_;
};

}  // namespace darkroom::render
