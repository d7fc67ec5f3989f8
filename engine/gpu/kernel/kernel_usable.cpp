// SPDX-License-Identifier: MIT
// Which stage can run a kernel on a device, and which does best.
#include <fmt/format.h>

#include <algorithm>

#include "gpu/device/context.hpp"
#include "gpu/kernel/kernel.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom::gpu {

namespace {

std::string_view stage_name(Stage stage) { return stage == Stage::Compute ? "compute" : "raster"; }

/// The text of every refusal: kernel, stage, thing, format, reason.
Failure refusal(const KernelSpec& spec, Stage stage, std::string_view thing, VkFormat format, std::string_view reason) {
    return user_error(fmt::format("kernel \"{}\" ({}): {} of format {} ({}): {}", spec.name, stage_name(stage), thing,
                                  format_name(format), static_cast<int>(format), reason));
}

/// Of a feature that is not enabled. What is there the host can enable.
std::string without(const Context& context, VkBool32 VkPhysicalDeviceFeatures::*feature, std::string_view name) {
    VkPhysicalDeviceFeatures2 there{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    if (!context.is_assumed) context.vk.GetPhysicalDeviceFeatures2(context.physical_device, &there);
    return there.features.*feature == VK_TRUE ? fmt::format("{} is not enabled", name)
                                              : fmt::format("the device has no {}", name);
}

std::string without_extended_formats(const Context& context) {
    return without(context, &VkPhysicalDeviceFeatures::shaderStorageImageExtendedFormats,
                   "shaderStorageImageExtendedFormats");
}

Result<> can_load(const Context& context, const KernelSpec& spec, Stage stage, const KernelImage& image) {
    const FormatTraits traits = format_traits(image.storage_format);
    const std::string thing = fmt::format("storage image \"{}\"", image.name);
    if (traits.glsl_qualifier.empty()) {
        return refusal(spec, stage, thing, image.storage_format, "GLSL has no storage format of this name");
    }
    if (traits.needs_extended && !context.traits.has_extended_storage_formats) {
        return refusal(spec, stage, thing, image.storage_format, without_extended_formats(context));
    }
    if (!context.supports(image.storage_format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
        return refusal(spec, stage, thing, image.storage_format, "the device cannot use it as a storage image");
    }
    return {};
}

Result<> can_store(const Context& context, const KernelSpec& spec, std::size_t index) {
    const VkFormat format = spec.outputs[index];
    const FormatTraits traits = format_traits(format);
    const std::string thing = fmt::format("output {}", index);
    const bool is_additive = spec.is_additive && index == 0;
    if (traits.glsl_qualifier.empty() && is_additive) {
        return refusal(spec, Stage::Compute, thing, format, "GLSL cannot read back a storage image without a format");
    }
    if (traits.glsl_qualifier.empty() && !context.traits.has_storage_write_without_format) {
        return refusal(spec, Stage::Compute, thing, format,
                       without(context, &VkPhysicalDeviceFeatures::shaderStorageImageWriteWithoutFormat,
                               "shaderStorageImageWriteWithoutFormat"));
    }
    if (traits.glsl_qualifier.empty() && !context.writes_without_format(format)) {
        return refusal(spec, Stage::Compute, thing, format,
                       "the device writes it by no storage image without a format");
    }
    if (traits.needs_extended && !context.traits.has_extended_storage_formats) {
        return refusal(spec, Stage::Compute, thing, format, without_extended_formats(context));
    }
    if (!context.supports(format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
        return refusal(spec, Stage::Compute, thing, format, "the device cannot use it as a storage image");
    }
    return {};
}

Result<> can_render(const Context& context, const KernelSpec& spec, std::size_t index) {
    const VkFormat format = spec.outputs[index];
    const std::string thing = fmt::format("output {}", index);
    if (!context.supports(format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) {
        return refusal(spec, Stage::Raster, thing, format, "the device cannot use it as a colour attachment");
    }
    if (spec.is_additive && !context.supports(format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {
        return refusal(spec, Stage::Raster, thing, format, "the device cannot blend it");
    }
    return {};
}

Result<> can_run(const Context& context, const KernelSpec& spec, Stage stage) {
    const auto refuse = [&](const std::string& why) -> Result<> {
        return user_error(fmt::format("kernel \"{}\" ({}): {}", spec.name, stage_name(stage), why));
    };
    const bool is_raster = stage == Stage::Raster;
    if (is_raster && !context.traits.has_graphics) return refuse("the device's queue family has no graphics");
    const bool is_written = std::ranges::any_of(spec.buffers, &KernelBuffer::is_written);
    if (is_raster && (spec.compute || is_written)) return refuse("a compute pass runs in compute alone");
    if (!spec.compute) return {};
    const Traits& traits = context.traits;
    const auto [width, height] = spec.workgroup;
    if (width * height > traits.max_workgroup_invocations || width > traits.max_workgroup_size[0] ||
        height > traits.max_workgroup_size[1])
        return refuse(fmt::format("a workgroup of {} x {}; the device has at most {} x {}, {} together", width, height,
                                  traits.max_workgroup_size[0], traits.max_workgroup_size[1],
                                  traits.max_workgroup_invocations));
    if (spec.compute->shared_bytes > traits.max_shared_bytes)
        return refuse(fmt::format("{} bytes of shared memory; the device has {}", spec.compute->shared_bytes,
                                  traits.max_shared_bytes));
    return {};
}

}  // namespace

Result<> usable(const Context& context, const KernelSpec& spec, Stage stage) {
    if (spec.is_additive && spec.outputs.size() != 1) {
        return user_error(
            fmt::format("kernel \"{}\": {} outputs, but an additive kernel has 1", spec.name, spec.outputs.size()));
    }
    DARKROOM_TRY(can_run(context, spec, stage));
    for (const KernelImage& image : spec.images) {
        if (image.storage_format == VK_FORMAT_UNDEFINED) continue;
        DARKROOM_TRY(can_load(context, spec, stage, image));
    }
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        const bool is_compute = stage == Stage::Compute;
        DARKROOM_TRY(is_compute ? can_store(context, spec, index) : can_render(context, spec, index));
    }
    return {};
}

std::array<std::uint32_t, 2> usual_workgroup(const Context& context) {
    const Traits& traits = context.traits;
    if (traits.max_workgroup_invocations < 256) return {16, 8};
    return traits.is_software ? std::array{64U, 4U} : std::array{16U, 16U};
}

Stage preferred_stage(const Context& context, const KernelSpec& spec) {
    if (!usable(context, spec, Stage::Raster)) return Stage::Compute;
    if (!usable(context, spec, Stage::Compute)) return Stage::Raster;
    if (!context.traits.is_software) return Stage::Compute;
    return Stage::Raster;
}

}  // namespace darkroom::gpu
