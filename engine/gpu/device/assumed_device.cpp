// SPDX-License-Identifier: MIT
#include "gpu/device/assumed_device.hpp"

#include <algorithm>

#include "gpu/resource/formats.hpp"

namespace darkroom::gpu {

namespace {

// No GPU of a desktop allows less, and no software driver. Loads outside of images are promised to no host that has not
// asked for them, so no kernel counts on them.
Traits assumed_traits(DeviceProfile profile) {
    Traits traits;
    traits.is_software = profile == DeviceProfile::Software;
    traits.has_extended_storage_formats = true;
    traits.has_storage_write_without_format = true;
    traits.max_image_dimension = 16384;
    traits.max_workgroup_invocations = 1024;
    traits.max_workgroup_size = {1024, 1024, 64};
    traits.max_shared_bytes = 32768;
    traits.max_storage_images = traits.is_software ? 8 : 16;
    traits.sub_texel_bits = 8;
    return traits;
}

}  // namespace

std::string_view assumed_device_remark(DeviceProfile profile) {
    if (profile == DeviceProfile::Software)
        return "planned without a device: a software driver is assumed that takes all formats and pads no memory.";
    return "planned without a device: a GPU is assumed that prefers compute, takes all formats and pads no memory.";
}

std::shared_ptr<Context> assumed_context(DeviceProfile profile) {
    auto context = std::make_shared<Context>();
    context->is_assumed = true;
    context->profile = profile;
    context->info = {.name = "an assumed device", .reason = "it is none: stacks are planned for it, and nothing else"};
    context->traits = assumed_traits(profile);
    return context;
}

Traits planned_traits(const Traits& own, DeviceProfile profile) {
    const Traits assumed = assumed_traits(profile);
    Traits out = own;
    out.is_software = assumed.is_software;
    out.has_robust_images = own.has_robust_images && assumed.has_robust_images;
    out.max_workgroup_invocations = std::min(own.max_workgroup_invocations, assumed.max_workgroup_invocations);
    out.max_storage_images = std::min(own.max_storage_images, assumed.max_storage_images);
    out.max_shared_bytes = std::min(own.max_shared_bytes, assumed.max_shared_bytes);
    return out;
}

VkFormatFeatureFlags planned_features(VkFormat format, VkFormatFeatureFlags own) {
    // What else a format can do is none of a plan's questions, and a format that is not listed has no place in a plan.
    constexpr VkFormatFeatureFlags asked =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
        VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT |
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    if (format_traits(format).bits == 0) return own;
    return own & (assumed_features(format) | ~asked);
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
