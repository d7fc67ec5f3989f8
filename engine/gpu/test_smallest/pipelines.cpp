// SPDX-License-Identifier: MIT
// Shaders, layouts and pipelines of the smallest device.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/resource/formats.hpp"
#include "gpu/test_smallest/shader.hpp"
#include "gpu/test_smallest/state.hpp"

namespace darkroom::gpu::test {

namespace {

VkResult create_shader(VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* allocator,
                       VkShaderModule* module) {
    SmallestState& state = smallest();
    const std::span<const std::uint32_t> words(info->pCode, info->codeSize / sizeof(std::uint32_t));
    for (const std::uint32_t capability : read_shader(words).capabilities) {
        if (is_smallest_capability(capability)) continue;
        refuse(fmt::format("SPIR-V with capability {}", capability));
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    const VkResult result = state.real.CreateShaderModule(device, info, allocator, module);
    const std::lock_guard lock(state.mutex);
    if (result == VK_SUCCESS) state.shaders[*module] = {words.begin(), words.end()};
    return result;
}

/// Descriptors of a stage or of a set, by what limits them.
struct Counts {
    std::uint32_t samplers = 0, uniform_buffers = 0, storage_buffers = 0, sampled_images = 0, storage_images = 0;
    std::uint32_t input_attachments = 0, dynamic_uniform_buffers = 0, dynamic_storage_buffers = 0;

    [[nodiscard]] std::uint32_t all() const {
        return samplers + uniform_buffers + storage_buffers + sampled_images + storage_images + input_attachments;
    }
    void add(VkDescriptorType type, std::uint32_t count) {
        switch (type) {
            case VK_DESCRIPTOR_TYPE_SAMPLER:
                samplers += count;
                break;
            case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
                samplers += count;
                sampled_images += count;
                break;
            case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
            case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
                sampled_images += count;
                break;
            case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
            case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
                storage_images += count;
                break;
            case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
                dynamic_uniform_buffers += count;
                [[fallthrough]];
            case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
                uniform_buffers += count;
                break;
            case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
                dynamic_storage_buffers += count;
                [[fallthrough]];
            case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
                storage_buffers += count;
                break;
            case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
                input_attachments += count;
                break;
            default:
                break;
        }
    }
};

struct Bound {
    const char* what;
    std::uint32_t count, most;
};

/// The first that is beyond its bound; empty if none is.
std::string beyond(std::span<const Bound> bounds, const char* where) {
    const auto found = std::ranges::find_if(bounds, [](const Bound& bound) { return bound.count > bound.most; });
    if (found == bounds.end()) return {};
    return fmt::format("{} {} of a {}, beyond {}", found->count, found->what, where, found->most);
}

std::string beyond_stage(const Counts& counts, const VkPhysicalDeviceLimits& limits) {
    return beyond(
        std::array{Bound{"samplers", counts.samplers, limits.maxPerStageDescriptorSamplers},
                   Bound{"uniform buffers", counts.uniform_buffers, limits.maxPerStageDescriptorUniformBuffers},
                   Bound{"storage buffers", counts.storage_buffers, limits.maxPerStageDescriptorStorageBuffers},
                   Bound{"sampled images", counts.sampled_images, limits.maxPerStageDescriptorSampledImages},
                   Bound{"storage images", counts.storage_images, limits.maxPerStageDescriptorStorageImages},
                   Bound{"input attachments", counts.input_attachments, limits.maxPerStageDescriptorInputAttachments},
                   Bound{"resources", counts.all(), limits.maxPerStageResources}},
        "stage");
}

/// The specification's limits of a set are those of all sets of a pipeline layout together.
std::string beyond_layout(const Counts& counts, const VkPhysicalDeviceLimits& limits) {
    return beyond(
        std::array{Bound{"samplers", counts.samplers, limits.maxDescriptorSetSamplers},
                   Bound{"uniform buffers", counts.uniform_buffers, limits.maxDescriptorSetUniformBuffers},
                   Bound{"dynamic uniform buffers", counts.dynamic_uniform_buffers,
                         limits.maxDescriptorSetUniformBuffersDynamic},
                   Bound{"storage buffers", counts.storage_buffers, limits.maxDescriptorSetStorageBuffers},
                   Bound{"dynamic storage buffers", counts.dynamic_storage_buffers,
                         limits.maxDescriptorSetStorageBuffersDynamic},
                   Bound{"sampled images", counts.sampled_images, limits.maxDescriptorSetSampledImages},
                   Bound{"storage images", counts.storage_images, limits.maxDescriptorSetStorageImages},
                   Bound{"input attachments", counts.input_attachments, limits.maxDescriptorSetInputAttachments}},
        "pipeline layout");
}

VkResult create_set_layout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* info,
                           const VkAllocationCallbacks* allocator, VkDescriptorSetLayout* layout) {
    SmallestState& state = smallest();
    const std::vector<VkDescriptorSetLayoutBinding> bindings(info->pBindings, info->pBindings + info->bindingCount);
    std::uint32_t descriptors = 0;
    for (const VkDescriptorSetLayoutBinding& binding : bindings) descriptors += binding.descriptorCount;
    std::string text;
    if (descriptors > smallest_set_descriptors) text = fmt::format("{} descriptors of a set", descriptors);
    if (info->flags != 0) text = "a descriptor set layout with flags";
    if (!text.empty()) {
        refuse(text);
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    const VkResult result = state.real.CreateDescriptorSetLayout(device, info, allocator, layout);
    const std::lock_guard lock(state.mutex);
    if (result == VK_SUCCESS) state.set_layouts[*layout] = bindings;
    return result;
}

std::string beyond(const VkPipelineLayoutCreateInfo& info) {
    SmallestState& state = smallest();
    const VkPhysicalDeviceLimits& limits = state.limits;
    if (info.setLayoutCount > limits.maxBoundDescriptorSets)
        return fmt::format("{} sets of a pipeline layout, beyond {}", info.setLayoutCount,
                           limits.maxBoundDescriptorSets);
    for (const VkPushConstantRange& range : std::span(info.pPushConstantRanges, info.pushConstantRangeCount)) {
        if (range.offset + range.size > limits.maxPushConstantsSize)
            return fmt::format("{} bytes of push constants, beyond {}", range.offset + range.size,
                               limits.maxPushConstantsSize);
    }
    const std::lock_guard lock(state.mutex);
    Counts all;
    std::map<VkShaderStageFlags, Counts> stages;
    for (const VkDescriptorSetLayout layout : std::span(info.pSetLayouts, info.setLayoutCount)) {
        for (const VkDescriptorSetLayoutBinding& binding : state.set_layouts[layout]) {
            all.add(binding.descriptorType, binding.descriptorCount);
            for (const VkShaderStageFlagBits stage :
                 {VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_FRAGMENT_BIT, VK_SHADER_STAGE_COMPUTE_BIT}) {
                if ((binding.stageFlags & stage) != 0)
                    stages[stage].add(binding.descriptorType, binding.descriptorCount);
            }
        }
    }
    for (const auto& [stage, counts] : stages) {
        if (std::string text = beyond_stage(counts, limits); !text.empty()) return text;
    }
    return beyond_layout(all, limits);
}

VkResult create_pipeline_layout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                const VkAllocationCallbacks* allocator, VkPipelineLayout* layout) {
    if (const std::string text = beyond(*info); !text.empty()) {
        refuse(text);
        return VK_ERROR_TOO_MANY_OBJECTS;
    }
    return smallest().real.CreatePipelineLayout(device, info, allocator, layout);
}

ShaderFacts facts_of(const VkPipelineShaderStageCreateInfo& stage) {
    std::map<std::uint32_t, std::uint32_t> values;
    if (const VkSpecializationInfo* const given = stage.pSpecializationInfo; given != nullptr) {
        for (const VkSpecializationMapEntry& entry : std::span(given->pMapEntries, given->mapEntryCount)) {
            const auto* const data = static_cast<const std::byte*>(given->pData) + entry.offset;
            std::copy_n(data, std::min(entry.size, sizeof(std::uint32_t)),
                        reinterpret_cast<std::byte*>(&values[entry.constantID]));
        }
    }
    SmallestState& state = smallest();
    const std::lock_guard lock(state.mutex);
    return read_shader(state.shaders[stage.module], values);
}

std::string beyond(const VkComputePipelineCreateInfo& info) {
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    const ShaderFacts facts = facts_of(info.stage);
    const auto [x, y, z] = facts.workgroup;
    if (x > limits.maxComputeWorkGroupSize[0] || y > limits.maxComputeWorkGroupSize[1] ||
        z > limits.maxComputeWorkGroupSize[2] || x * y * z > limits.maxComputeWorkGroupInvocations)
        return fmt::format("a workgroup of {} x {} x {}", x, y, z);
    if (facts.shared_bytes > limits.maxComputeSharedMemorySize)
        return fmt::format("{} bytes of shared memory, beyond {}", facts.shared_bytes,
                           limits.maxComputeSharedMemorySize);
    return {};
}

std::string beyond(const VkPipelineVertexInputStateCreateInfo& input) {
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    if (input.vertexAttributeDescriptionCount > limits.maxVertexInputAttributes ||
        input.vertexBindingDescriptionCount > limits.maxVertexInputBindings)
        return "too many attributes or bindings of vertices";
    for (const auto& attribute : std::span(input.pVertexAttributeDescriptions, input.vertexAttributeDescriptionCount)) {
        if (attribute.offset > limits.maxVertexInputAttributeOffset) return "an attribute too far into a vertex";
        if (smallest_buffer_features(attribute.format) == 0)
            return fmt::format("vertices of format {}", format_name(attribute.format));
    }
    for (const auto& binding : std::span(input.pVertexBindingDescriptions, input.vertexBindingDescriptionCount)) {
        if (binding.stride > limits.maxVertexInputBindingStride)
            return fmt::format("vertices of {} bytes", binding.stride);
    }
    return {};
}

bool is_same(const VkPipelineColorBlendAttachmentState& a, const VkPipelineColorBlendAttachmentState& b) {
    return a.blendEnable == b.blendEnable && a.srcColorBlendFactor == b.srcColorBlendFactor &&
           a.dstColorBlendFactor == b.dstColorBlendFactor && a.colorBlendOp == b.colorBlendOp &&
           a.srcAlphaBlendFactor == b.srcAlphaBlendFactor && a.dstAlphaBlendFactor == b.dstAlphaBlendFactor &&
           a.alphaBlendOp == b.alphaBlendOp && a.colorWriteMask == b.colorWriteMask;
}

std::string beyond(const VkPipelineColorBlendStateCreateInfo& blend, const VkPipelineRenderingCreateInfo& rendering) {
    if (blend.logicOpEnable == VK_TRUE) return "logical operations";
    const std::span attachments(blend.pAttachments, blend.attachmentCount);
    for (std::size_t index = 0; index < attachments.size(); ++index) {
        const VkFormat format = rendering.pColorAttachmentFormats[index];
        const VkFormatFeatureFlags there = smallest_image_features(format);
        if (format == VK_FORMAT_UNDEFINED) continue;
        if ((there & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) == 0)
            return fmt::format("rendering to format {}", format_name(format));
        if (attachments[index].blendEnable == VK_TRUE && (there & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) == 0)
            return fmt::format("blending in format {}", format_name(format));
        if (!is_same(attachments[index], attachments[0])) return "attachments that blend differently";
    }
    return {};
}

const VkPipelineRenderingCreateInfo* rendering_of(const VkGraphicsPipelineCreateInfo& info) {
    const auto* link = static_cast<const VkBaseInStructure*>(info.pNext);
    while (link != nullptr && link->sType != VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO) link = link->pNext;
    const void* const structure = link;
    return static_cast<const VkPipelineRenderingCreateInfo*>(structure);
}

std::string beyond(const VkPipelineRasterizationStateCreateInfo& state) {
    if (state.depthClampEnable == VK_TRUE) return "clamping of depth";
    if (state.polygonMode != VK_POLYGON_MODE_FILL) return "polygons that are not filled";
    if (state.depthBiasEnable == VK_TRUE && state.depthBiasClamp != 0) return "clamping of the bias of depth";
    if (state.lineWidth != 1) return "wide lines";
    return {};
}

std::string beyond(const VkGraphicsPipelineCreateInfo& info) {
    const VkPhysicalDeviceLimits& limits = smallest().limits;
    const VkPipelineRenderingCreateInfo* const rendering = rendering_of(info);
    const std::uint32_t colors = rendering == nullptr ? 0 : rendering->colorAttachmentCount;
    if (colors > limits.maxColorAttachments) return fmt::format("rendering to {} images", colors);
    for (const VkPipelineShaderStageCreateInfo& stage : std::span(info.pStages, info.stageCount)) {
        const ShaderFacts facts = facts_of(stage);
        if (stage.stage != VK_SHADER_STAGE_VERTEX_BIT && stage.stage != VK_SHADER_STAGE_FRAGMENT_BIT)
            return "a geometry or tessellation shader";
        if (facts.written > 0) return "images or buffers that a vertex or fragment shader may write";
        const std::uint32_t resources = facts.storage_images + facts.storage_buffers + colors;
        if (stage.stage == VK_SHADER_STAGE_FRAGMENT_BIT && resources > limits.maxFragmentCombinedOutputResources)
            return fmt::format("{} storage images, storage buffers and outputs of a fragment shader, beyond {}",
                               resources, limits.maxFragmentCombinedOutputResources);
    }
    if (info.pViewportState != nullptr && info.pViewportState->viewportCount > limits.maxViewports)
        return fmt::format("{} viewports", info.pViewportState->viewportCount);
    if (info.pMultisampleState != nullptr) {
        const VkPipelineMultisampleStateCreateInfo& samples = *info.pMultisampleState;
        if (samples.sampleShadingEnable == VK_TRUE || samples.alphaToOneEnable == VK_TRUE)
            return "shading of samples, or an alpha of one";
        if ((samples.rasterizationSamples & limits.framebufferColorSampleCounts) == 0)
            return fmt::format("rendering with {} samples", static_cast<int>(samples.rasterizationSamples));
    }
    if (info.pDepthStencilState != nullptr && info.pDepthStencilState->depthBoundsTestEnable == VK_TRUE)
        return "bounds of depth";
    std::string text = info.pRasterizationState != nullptr ? beyond(*info.pRasterizationState) : std::string();
    if (text.empty() && info.pVertexInputState != nullptr) text = beyond(*info.pVertexInputState);
    if (text.empty() && info.pColorBlendState != nullptr && rendering != nullptr)
        text = beyond(*info.pColorBlendState, *rendering);
    return text;
}

/// Of both kinds of pipelines.
template <auto Create, class Info>
VkResult create_pipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count, const Info* infos,
                          const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
    for (const Info& info : std::span(infos, count)) {
        const std::string text = beyond(info);
        if (text.empty()) continue;
        refuse(text);
        std::fill_n(pipelines, count, VK_NULL_HANDLE);
        return VK_ERROR_FEATURE_NOT_PRESENT;
    }
    return (smallest().real.*Create)(device, cache, count, infos, allocator, pipelines);
}

}  // namespace

void replace_pipelines(Replacements& functions) {
    functions["vkCreateShaderModule"] = as_void(create_shader);
    functions["vkDestroyShaderModule"] =
        as_void(forget<&SmallestState::shaders, &Dispatch::DestroyShaderModule, VkShaderModule>);
    functions["vkCreateDescriptorSetLayout"] = as_void(create_set_layout);
    functions["vkDestroyDescriptorSetLayout"] =
        as_void(forget<&SmallestState::set_layouts, &Dispatch::DestroyDescriptorSetLayout, VkDescriptorSetLayout>);
    functions["vkCreatePipelineLayout"] = as_void(create_pipeline_layout);
    functions["vkCreateComputePipelines"] =
        as_void(create_pipelines<&Dispatch::CreateComputePipelines, VkComputePipelineCreateInfo>);
    functions["vkCreateGraphicsPipelines"] =
        as_void(create_pipelines<&Dispatch::CreateGraphicsPipelines, VkGraphicsPipelineCreateInfo>);
}

}  // namespace darkroom::gpu::test
