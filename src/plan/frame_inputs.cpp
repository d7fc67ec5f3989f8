// SPDX-License-Identifier: MIT
#include "plan/frame_inputs.hpp"

#include <algorithm>

#include "gpu/resource/formats.hpp"

namespace darkroom::plan {

bool can_hold_depth(VkFormat format) {
    return gpu::is_depth(format) || format == VK_FORMAT_R32_SFLOAT || format == VK_FORMAT_R16_SFLOAT ||
           format == VK_FORMAT_R16_UNORM;
}

bool can_hold_ui(VkFormat format) {
    return format != VK_FORMAT_A2B10G10R10_UNORM_PACK32 && format != VK_FORMAT_A2R10G10B10_UNORM_PACK32;
}

bool bring_the_same(const CompileDesc& a, const CompileDesc& b) {
    return a.color == b.color && a.has_shadows == b.has_shadows && a.is_depth_planar == b.is_depth_planar &&
           a.is_velocity_plain == b.is_velocity_plain &&
           std::ranges::all_of(frame_inputs, [&](const FrameInput& input) {
               return input.use == nullptr || a.*input.use == b.*input.use;
           });
}

}  // namespace darkroom::plan
