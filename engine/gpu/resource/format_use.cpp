// SPDX-License-Identifier: MIT
#include "gpu/resource/format_use.hpp"

#include "gpu/device/context.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom::gpu {

bool can_load(const Context& context, VkFormat format) {
    const FormatTraits traits = format_traits(format);
    if (traits.glsl_qualifier.empty()) return false;
    if (traits.needs_extended && !context.traits.has_extended_storage_formats) return false;
    return context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
}

bool can_filter(const Context& context, VkFormat format) {
    return context.supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT);
}

}  // namespace darkroom::gpu
