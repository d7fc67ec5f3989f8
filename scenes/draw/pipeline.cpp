// SPDX-License-Identifier: MIT
#include "draw/pipeline.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "gpu/device/cleared.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {

namespace {

/// Lives until the pipeline is made.
class Module {
  public:
    explicit Module(Context& context) : context_(context) {}
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;
    ~Module() { context_.vk.DestroyShaderModule(context_.device, handle, context_.allocator); }

    Result<> compile(const std::string& name, const std::string& text, ShaderStage stage) {
        DARKROOM_TRY_VALUE(const std::vector<std::uint32_t> words,
                           context_.shaders->compile({.name = name, .text = text, .stage = stage}));
        const VkShaderModuleCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = words.size() * 4, .pCode = words.data()};
        return context_.check(
            cleared_on_failure(context_.vk.CreateShaderModule(context_.device, &info, context_.allocator, &handle),
                               handle),
            fmt::format("creating the shader \"{}\"", name));
    }
    VkShaderModule handle = VK_NULL_HANDLE;

  private:
    Context& context_;
};

Result<VkPipelineLayout> create_layout(Context& context, const PipelineDesc& desc) {
    const VkPushConstantRange range{.stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                                    .size = desc.push_constant_size};
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = static_cast<std::uint32_t>(desc.sets.size()),
                                          .pSetLayouts = desc.sets.data(),
                                          .pushConstantRangeCount = desc.push_constant_size > 0 ? 1U : 0U,
                                          .pPushConstantRanges = &range};
    // No exception comes between the layout and its owner, here and below.
    const std::string what = fmt::format("creating the layout of the pipeline \"{}\"", desc.name);
    VkPipelineLayout layout = VK_NULL_HANDLE;
    DARKROOM_TRY(
        context.check(context.vk.CreatePipelineLayout(context.device, &info, context.allocator, &layout), what));
    return layout;
}

VkPipelineColorBlendAttachmentState blend_state(const ColorTarget& target) {
    return {.blendEnable = target.is_blended ? VK_TRUE : VK_FALSE,
            .srcColorBlendFactor = target.source,
            .dstColorBlendFactor = target.destination,
            .colorBlendOp = VK_BLEND_OP_ADD,
            .srcAlphaBlendFactor = target.source_alpha,
            .dstAlphaBlendFactor = target.destination_alpha,
            .alphaBlendOp = VK_BLEND_OP_ADD,
            .colorWriteMask = target.writes};
}

Result<VkPipeline> create_pipeline(Context& context, const PipelineDesc& desc, VkPipelineLayout layout,
                                   const Module& vertex, const Module& fragment) {
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < desc.specialization.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
                                              .pMapEntries = entries.data(),
                                              .dataSize = desc.specialization.size() * 4,
                                              .pData = desc.specialization.data()};
    const auto stage = [&](VkShaderStageFlagBits bit, const Module& module) {
        return VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                               .stage = bit,
                                               .module = module.handle,
                                               .pName = "main",
                                               .pSpecializationInfo = &specialization};
    };
    const std::array stages{stage(VK_SHADER_STAGE_VERTEX_BIT, vertex), stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const VkPipelineVertexInputStateCreateInfo input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = static_cast<std::uint32_t>(desc.bindings.size()),
        .pVertexBindingDescriptions = desc.bindings.data(),
        .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(desc.attributes.size()),
        .pVertexAttributeDescriptions = desc.attributes.data()};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, .topology = desc.topology};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
    const bool has_bias = desc.depth_bias != 0 || desc.depth_bias_slope != 0;
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthClampEnable = desc.clamps_depth ? VK_TRUE : VK_FALSE,
        .polygonMode = desc.polygon_mode,
        .cullMode = desc.cull,
        .frontFace = desc.front,
        .depthBiasEnable = has_bias ? VK_TRUE : VK_FALSE,
        .depthBiasConstantFactor = desc.depth_bias,
        .depthBiasSlopeFactor = desc.depth_bias_slope,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo multisample{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = desc.samples};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = desc.tests_depth ? VK_TRUE : VK_FALSE,
        .depthWriteEnable = desc.writes_depth ? VK_TRUE : VK_FALSE,
        .depthCompareOp = desc.depth_compare};
    std::vector<VkPipelineColorBlendAttachmentState> blends;
    std::vector<VkFormat> formats;
    for (const ColorTarget& target : desc.colors) {
        blends.push_back(blend_state(target));
        formats.push_back(target.format);
    }
    const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                    .attachmentCount = static_cast<std::uint32_t>(blends.size()),
                                                    .pAttachments = blends.data()};
    constexpr std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size()),
        .pDynamicStates = dynamic_states.data()};
    const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                  .colorAttachmentCount = static_cast<std::uint32_t>(formats.size()),
                                                  .pColorAttachmentFormats = formats.data(),
                                                  .depthAttachmentFormat = desc.depth};
    const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = fragment.handle == VK_NULL_HANDLE ? 1U : 2U,
                                            .pStages = stages.data(),
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &multisample,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .pDynamicState = &dynamic,
                                            .layout = layout};
    const std::string what = fmt::format("creating the pipeline \"{}\"", desc.name);
    VkPipeline pipeline = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateGraphicsPipelines(context.device, context.pipeline_cache, 1, &info,
                                                                  context.allocator, &pipeline),
                               what));
    return pipeline;
}

}  // namespace

Result<SetLayout> SetLayout::create(Context& context, std::span<const Binding> bindings) {
    std::vector<VkDescriptorSetLayoutBinding> list;
    for (const Binding& binding : bindings)
        list.push_back({.binding = static_cast<std::uint32_t>(list.size()),
                        .descriptorType = binding.type,
                        .descriptorCount = binding.count,
                        .stageFlags = binding.stages});
    const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                               .bindingCount = static_cast<std::uint32_t>(list.size()),
                                               .pBindings = list.data()};
    SetLayout layout;
    layout.context = &context;
    DARKROOM_TRY(context.check(cleared_on_failure(context.vk.CreateDescriptorSetLayout(
                                                      context.device, &info, context.allocator, &layout.handle),
                                                  layout.handle),
                               "creating a descriptor set layout"));
    return layout;
}

SetLayout::SetLayout(SetLayout&& other) noexcept { *this = std::move(other); }
SetLayout& SetLayout::operator=(SetLayout&& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(context, other.context);
    return *this;
}
SetLayout::~SetLayout() {
    if (handle != VK_NULL_HANDLE) context->vk.DestroyDescriptorSetLayout(context->device, handle, context->allocator);
}

Result<Pipeline> Pipeline::create(Context& context, const PipelineDesc& desc) {
    Module vertex(context), fragment(context);
    DARKROOM_TRY(vertex.compile(desc.name + " (vertex)", desc.vertex, ShaderStage::Vertex));
    if (!desc.fragment.empty())
        DARKROOM_TRY(fragment.compile(desc.name + " (fragment)", desc.fragment, ShaderStage::Fragment));
    Pipeline pipeline;
    pipeline.context = &context;
    DARKROOM_TRY_VALUE(VkPipelineLayout layout, create_layout(context, desc));
    pipeline.layout = layout;
    DARKROOM_TRY_VALUE(pipeline.handle, create_pipeline(context, desc, layout, vertex, fragment));
    ++context.pipelines_created;
    name_object(context, VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline.handle), desc.name);
    return pipeline;
}

Pipeline::Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(layout, other.layout);
    std::swap(context, other.context);
    return *this;
}
Pipeline::~Pipeline() {
    if (context == nullptr) return;
    context->vk.DestroyPipeline(context->device, handle, context->allocator);
    context->vk.DestroyPipelineLayout(context->device, layout, context->allocator);
}

}  // namespace darkroom::gpu
