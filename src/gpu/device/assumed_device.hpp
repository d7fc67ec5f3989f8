// SPDX-License-Identifier: MIT
#pragma once
// The device that a plan is made for where none was asked for: what an ordinary GPU does, written down, so that no
// driver is needed. Only what planning asks is answered. No call of Vulkan may be made on its context, whose dispatch
// table is empty.

#include <vulkan/vulkan.h>

#include <memory>
#include <string_view>

#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

/// The sentence that a plan for it says.
inline constexpr std::string_view assumed_device_remark =
    "planned without a device: a GPU is assumed that prefers compute, takes all formats and pads no memory.";

[[nodiscard]] std::shared_ptr<Context> assumed_context();
/// As VkFormatProperties::optimalTilingFeatures; none for formats that formats.hpp does not list.
[[nodiscard]] VkFormatFeatureFlags assumed_features(VkFormat format);
/// The bytes of the texels of all mip levels and layers; of any memory type.
[[nodiscard]] VkMemoryRequirements assumed_requirements(const ImageInfo& info);

}  // namespace darkroom::gpu
