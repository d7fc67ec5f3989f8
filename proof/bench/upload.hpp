// SPDX-License-Identifier: MIT
#pragma once
// Images made from bytes of the CPU, once, before anything is measured.

#include <darkroom/effect.hpp>
#include <span>

#include "gpu/resource/resources.hpp"

namespace darkroom::bench {

/// Of a number that is normal in half precision, rounded toward zero.
[[nodiscard]] std::uint16_t half_bits(float value);
/// All layers, one after the other, rows without padding; left in `layout`.
[[nodiscard]] Result<gpu::Image> upload(gpu::Context& context, gpu::ImageInfo info, std::span<const std::byte> bytes,
                                        VkImageLayout layout);
/// A table of an effect, to be loaded from; in VK_IMAGE_LAYOUT_GENERAL.
[[nodiscard]] Result<gpu::Image> upload_table(gpu::Context& context, const TableDesc& table);

}  // namespace darkroom::bench
