// SPDX-License-Identifier: MIT
#pragma once
// The device that a plan is made for where none was asked for, and kernels are baked for: what an ordinary one of a
// kind does, written down, so that no driver is needed. Only what planning asks is answered. No call of Vulkan may be
// made on its context, whose dispatch table is empty. A device whose kernels were baked answers as this one, as far as
// it can.

#include <vulkan/vulkan.h>

#include <memory>
#include <string_view>

#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

/// The sentence that a plan for it says.
[[nodiscard]] std::string_view assumed_device_remark(DeviceProfile profile);

[[nodiscard]] std::shared_ptr<Context> assumed_context(DeviceProfile profile = DeviceProfile::Gpu);
/// Traits of a real device for which kernels of this profile were baked: plans for it ask for no others.
[[nodiscard]] Traits planned_traits(const Traits& own, DeviceProfile profile);
/// The same of a format: `own` without what kernels of a profile do not count on.
[[nodiscard]] VkFormatFeatureFlags planned_features(VkFormat format, VkFormatFeatureFlags own);
/// As VkFormatProperties::optimalTilingFeatures; none for formats that formats.hpp does not list.
[[nodiscard]] VkFormatFeatureFlags assumed_features(VkFormat format);
/// The bytes of the texels of all mip levels and layers; of any memory type.
[[nodiscard]] VkMemoryRequirements assumed_requirements(const ImageInfo& info);

}  // namespace darkroom::gpu
