// SPDX-License-Identifier: MIT
#pragma once
// Bytes to device-local buffers and images through staging memory, many of them in one submission. It waits for the
// device, so it is for loading and not for frames.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "scene/model.hpp"

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

// Mip levels of pictures, each a box-filtered half of the one before, in linear light where the picture is
// sRGB-encoded. On the CPU, so that every device shows the same textures.

/// What alpha does to the colour beside it: nothing; it weighs it; or it also cuts out what is below the cutoff.
struct AlphaUse {
    bool weighs = false;
    float cutoff = 0;  ///< of the texture's own alpha, (0, 1]; 0: none
    friend auto operator<=>(const AlphaUse&, const AlphaUse&) = default;
};

struct MipLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Levels 1, 2, ... down to 1x1 of level 0 in `rgba`, four bytes a pixel; alpha is linear always. Odd sizes are
/// filtered by three taps (Guthe and Heckbert, "Non-Power-of-Two Mipmapping", 2005). Where alpha weighs, colour is the
/// mean of what is seen, what is not seen has its neighbours' colour, since samplers filter it too, and level 0 comes
/// first. With a cutoff, alpha of each level is scaled so that as large a share of it reaches the cutoff, once
/// filtered, as of level 0, else what is cut out thins out far away (Ignacio Castano, "Computing Alpha Mipmaps", 2010).
[[nodiscard]] std::vector<MipLevel> mip_levels(std::uint32_t width, std::uint32_t height,
                                               std::span<const std::uint8_t> rgba, bool is_srgb, AlphaUse alpha = {});

/// A level whose samples are codes of 16 bits or halves.
struct WideMipLevel {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint16_t> rgba;
};

/// All levels of a picture of 16 bits or of halves, level 0 included, as linear numbers: codes if `as_codes`, which
/// only linear codes can be, else halves, into which sRGB codes are decoded (as there is no sRGB format of 16 bits).
[[nodiscard]] std::vector<WideMipLevel> wide_mip_levels(const scene::Image& image, bool is_srgb, bool as_codes,
                                                        AlphaUse alpha = {});

}  // namespace darkroom::render
