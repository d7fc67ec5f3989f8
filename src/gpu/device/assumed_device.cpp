// SPDX-License-Identifier: MIT
#include "gpu/device/assumed_device.hpp"

#include <algorithm>

#include "gpu/resource/formats.hpp"

namespace darkroom::gpu {

// No GPU of a desktop allows less.
std::shared_ptr<Context> assumed_context() {
    auto context = std::make_shared<Context>();
    context->is_assumed = true;
    context->info = {.name = "an assumed device", .reason = "it is none: stacks are planned for it, and nothing else"};
    Traits& traits = context->traits;
    traits.has_extended_storage_formats = true;
    traits.has_storage_write_without_format = true;
    traits.has_robust_images = true;
    traits.max_image_dimension = 16384;
    traits.max_workgroup_invocations = 1024;
    traits.max_workgroup_size = {1024, 1024, 64};
    traits.max_shared_bytes = 32768;
    traits.max_storage_images = 16;
    traits.sub_texel_bits = 8;
    return context;
}

VkFormatFeatureFlags assumed_features(VkFormat format) {
    const FormatTraits traits = format_traits(format);
    if (traits.bits == 0) return 0;
    VkFormatFeatureFlags features = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    if (traits.aspects != VK_IMAGE_ASPECT_COLOR_BIT) return features | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (!traits.glsl_qualifier.empty()) features |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    const bool is_float = traits.numeric == Numeric::Float;  // for shaders: UNORM, too
    if (is_float) features |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    // Three components, and a shared exponent, are rarely rendered to.
    if (traits.bits == 96 || format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return features;
    features |= VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
    return is_float ? features | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT : features;
}

VkMemoryRequirements assumed_requirements(const ImageInfo& info) {
    VkDeviceSize texels = 0;
    for (std::uint32_t level = 0; level < info.mip_levels; ++level) {
        const auto side = [level](std::uint32_t whole) { return VkDeviceSize{std::max(whole >> level, 1U)}; };
        texels += side(info.extent.width) * side(info.extent.height) * side(info.extent.depth);
    }
    return {.size = texels * info.array_layers * format_traits(info.format).bits / 8,
            .alignment = 256,
            .memoryTypeBits = 1};
}

}  // namespace darkroom::gpu
