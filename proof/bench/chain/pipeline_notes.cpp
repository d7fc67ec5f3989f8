// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <mutex>

#include "bench/program/bare_start.hpp"
#include "core/files.hpp"

namespace darkroom::bench {

namespace {

struct Noted {
    std::vector<std::uint32_t> shader, vertex;
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    VkFormat output = VK_FORMAT_UNDEFINED;
    VkPipelineColorBlendAttachmentState blend{};
};

/// Functions of Vulkan carry no pointer of the caller's, so what they note is global.
struct Notes {
    std::mutex mutex;
    gpu::Dispatch vk;
    std::map<VkShaderModule, std::vector<std::uint32_t>> modules;
    std::map<VkDescriptorSetLayout, std::vector<VkDescriptorSetLayoutBinding>> sets;
    std::map<VkPipelineLayout, VkDescriptorSetLayout> layouts;
    std::vector<Noted> pipelines;
};
Notes& notes() {
    static Notes instance;
    return instance;
}

VkResult create_module(VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* allocator,
                       VkShaderModule* out) {
    const std::lock_guard lock(notes().mutex);
    const VkResult result = notes().vk.CreateShaderModule(device, info, allocator, out);
    if (result == VK_SUCCESS) notes().modules[*out].assign(info->pCode, info->pCode + info->codeSize / 4);
    return result;
}

VkResult create_set_layout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* info,
                           const VkAllocationCallbacks* allocator, VkDescriptorSetLayout* out) {
    const std::lock_guard lock(notes().mutex);
    const VkResult result = notes().vk.CreateDescriptorSetLayout(device, info, allocator, out);
    if (result == VK_SUCCESS) notes().sets[*out].assign(info->pBindings, info->pBindings + info->bindingCount);
    return result;
}

VkResult create_layout(VkDevice device, const VkPipelineLayoutCreateInfo* info, const VkAllocationCallbacks* allocator,
                       VkPipelineLayout* out) {
    const std::lock_guard lock(notes().mutex);
    const VkResult result = notes().vk.CreatePipelineLayout(device, info, allocator, out);
    if (result == VK_SUCCESS) notes().layouts[*out] = info->pSetLayouts[0];
    return result;
}

VkResult create_compute(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                        const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* allocator,
                        VkPipeline* out) {
    {
        const std::lock_guard lock(notes().mutex);
        for (std::uint32_t i = 0; i < count; ++i)
            notes().pipelines.push_back({.shader = notes().modules[infos[i].stage.module],
                                         .bindings = notes().sets[notes().layouts[infos[i].layout]]});
    }
    return notes().vk.CreateComputePipelines(device, cache, count, infos, allocator, out);
}

VkResult create_raster(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                       const VkGraphicsPipelineCreateInfo* infos, const VkAllocationCallbacks* allocator,
                       VkPipeline* out) {
    {
        const std::lock_guard lock(notes().mutex);
        for (std::uint32_t i = 0; i < count; ++i) {
            const void* const next = infos[i].pNext;
            const auto& rendering = *static_cast<const VkPipelineRenderingCreateInfo*>(next);
            notes().pipelines.push_back({.shader = notes().modules[infos[i].pStages[1].module],
                                         .vertex = notes().modules[infos[i].pStages[0].module],
                                         .bindings = notes().sets[notes().layouts[infos[i].layout]],
                                         .output = rendering.pColorAttachmentFormats[0],
                                         .blend = infos[i].pColorBlendState->pAttachments[0]});
        }
    }
    return notes().vk.CreateGraphicsPipelines(device, cache, count, infos, allocator, out);
}

}  // namespace

PipelineNotes::PipelineNotes(gpu::Context& context, std::filesystem::path folder)
    : context_(context), before_(context.vk), folder_(std::move(folder)) {
    notes().vk = before_;
    notes().pipelines.clear();
    context.vk.CreateShaderModule = create_module;
    context.vk.CreateDescriptorSetLayout = create_set_layout;
    context.vk.CreatePipelineLayout = create_layout;
    context.vk.CreateComputePipelines = create_compute;
    context.vk.CreateGraphicsPipelines = create_raster;
}

PipelineNotes::~PipelineNotes() { context_.vk = before_; }

Result<std::vector<BarePipeline>> PipelineNotes::take() {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    std::vector<BarePipeline> out;
    const auto save = [&](const std::vector<std::uint32_t>& words,
                          std::string_view stage) -> Result<std::filesystem::path> {
        const std::filesystem::path path = folder_ / fmt::format("{}.{}.spv", out.size(), stage);
        DARKROOM_TRY(write_file(path, std::as_bytes(std::span(words))));
        return path;
    };
    for (const Noted& noted : notes().pipelines) {
        BarePipeline pipeline{.bindings = noted.bindings, .output = noted.output, .blend = noted.blend};
        DARKROOM_TRY_VALUE(pipeline.shader, save(noted.shader, "shader"));
        if (!noted.vertex.empty()) {
            DARKROOM_TRY_VALUE(pipeline.vertex, save(noted.vertex, "vertex"));
        }
        out.push_back(std::move(pipeline));
    }
    return out;
}

}  // namespace darkroom::bench
