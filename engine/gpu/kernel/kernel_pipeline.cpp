// SPDX-License-Identifier: MIT
#include "gpu/kernel/kernel_pipeline.hpp"

#include <fmt/format.h>

#include <mutex>

#include "gpu/device/cleared.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

namespace {

// Three vertices make a triangle that covers the viewport: (-1, -1), (3, -1), (-1, 3).
constexpr std::string_view full_screen_source = R"(#version 460
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

/// Deleted as soon as the pipeline is made.
class ShaderModule {
  public:
    static Result<ShaderModule> create(Context& context, std::span<const std::uint32_t> words, std::string_view name) {
        const VkShaderModuleCreateInfo create_info{
            .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
            .codeSize = words.size_bytes(),
            .pCode = words.data(),
        };
        ShaderModule module(context);
        const VkResult result = cleared_on_failure(
            context.vk.CreateShaderModule(context.device, &create_info, context.allocator, &module.handle_),
            module.handle_);
        DARKROOM_TRY(context.check(result, fmt::format("creating the shader module of \"{}\"", name)));
        return module;
    }
    ShaderModule(ShaderModule&& other) noexcept : context_(other.context_), handle_(other.handle_) {
        other.handle_ = VK_NULL_HANDLE;
    }
    ShaderModule& operator=(ShaderModule&&) = delete;
    ~ShaderModule() {
        if (handle_ != VK_NULL_HANDLE) context_.vk.DestroyShaderModule(context_.device, handle_, context_.allocator);
    }
    [[nodiscard]] VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits flag) const {
        return {
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = flag,
            .module = handle_,
            .pName = "main",
        };
    }

  private:
    explicit ShaderModule(Context& context) : context_(context) {}
    Context& context_;
    VkShaderModule handle_ = VK_NULL_HANDLE;
};

Result<std::vector<std::uint32_t>> full_screen_vertex(Context& context) {
    const std::lock_guard lock(context.full_screen_mutex);
    if (!context.full_screen_vertex.empty()) return context.full_screen_vertex;
    Result<std::vector<std::uint32_t>> words = context.shaders->compile(vertex_shader());
    if (words) context.full_screen_vertex = *words;
    return words;
}

VkPipelineCreateFlags flags_of(const Context& context) {
    if (!context.compiles_only) return 0;
    return VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR | VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
}

Result<VkPipeline> create_compute_pipeline(Context& context, const KernelSpec& spec, VkPipelineLayout layout,
                                           const ShaderModule& module) {
    const VkComputePipelineCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = flags_of(context),
        .stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT),
        .layout = layout,
    };
    // No exception comes between the pipeline and its owner, here and below.
    const std::string what = fmt::format("creating the compute pipeline of \"{}\"", spec.name);
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateComputePipelines(context.device, context.pipeline_cache, 1, &create_info,
                                                              context.allocator, &pipeline);
    DARKROOM_TRY(context.check(result, what));
    return pipeline;
}

Result<VkPipeline> create_raster_pipeline(Context& context, const KernelSpec& spec, VkPipelineLayout layout,
                                          const ShaderModule& fragment) {
    DARKROOM_TRY_VALUE(const std::vector<std::uint32_t> words, full_screen_vertex(context));
    DARKROOM_TRY_VALUE(const ShaderModule vertex, ShaderModule::create(context, words, "full-screen triangle"));
    const std::array stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT), fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT)};
    const VkPipelineVertexInputStateCreateInfo vertex_input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo input_assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo rasterization{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .cullMode = VK_CULL_MODE_NONE,
        .lineWidth = 1.0F,
    };
    const VkPipelineMultisampleStateCreateInfo multisample{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    constexpr VkColorComponentFlags all_components =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    std::array<VkPipelineColorBlendAttachmentState, max_outputs> blends{};
    blends.fill({
        .blendEnable = spec.is_additive ? VK_TRUE : VK_FALSE,
        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .colorBlendOp = VK_BLEND_OP_ADD,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .alphaBlendOp = VK_BLEND_OP_ADD,
        .colorWriteMask = all_components,
    });
    const auto output_count = static_cast<std::uint32_t>(spec.outputs.size());
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = output_count,
        .pAttachments = blends.data(),
    };
    constexpr std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size()),
        .pDynamicStates = dynamic_states.data(),
    };
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = output_count,
        .pColorAttachmentFormats = spec.outputs.data(),
    };
    const VkGraphicsPipelineCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .flags = flags_of(context),
        .stageCount = static_cast<std::uint32_t>(stages.size()),
        .pStages = stages.data(),
        .pVertexInputState = &vertex_input,
        .pInputAssemblyState = &input_assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &rasterization,
        .pMultisampleState = &multisample,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = layout,
    };
    const std::string what = fmt::format("creating the raster pipeline of \"{}\"", spec.name);
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateGraphicsPipelines(context.device, context.pipeline_cache, 1, &create_info,
                                                               context.allocator, &pipeline);
    DARKROOM_TRY(context.check(result, what));
    return pipeline;
}

}  // namespace

ShaderSource kernel_shader(std::string_view name, Stage stage, const KernelText& text) {
    const bool is_compute = stage == Stage::Compute;
    return {.name = fmt::format("{} ({})", name, is_compute ? "compute" : "raster"),
            .text = text.source,
            .stage = is_compute ? ShaderStage::Compute : ShaderStage::Fragment,
            .digest = text.digest};
}

ShaderSource vertex_shader() {
    return {.name = "full-screen triangle", .text = std::string(full_screen_source), .stage = ShaderStage::Vertex};
}

Result<VkPipeline> create_kernel_pipeline(Context& context, const KernelSpec& spec, Stage stage, const KernelText& text,
                                          VkPipelineLayout layout) {
    const bool is_compute = stage == Stage::Compute;
    DARKROOM_TRY_VALUE(const std::vector<std::uint32_t> words,
                       context.shaders->compile(kernel_shader(spec.name, stage, text)));
    DARKROOM_TRY_VALUE(const ShaderModule module, ShaderModule::create(context, words, spec.name));
    DARKROOM_TRY_VALUE(VkPipeline made, is_compute ? create_compute_pipeline(context, spec, layout, module)
                                                   : create_raster_pipeline(context, spec, layout, module));
    ++context.pipelines_created;
    name_object(context, VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(made), spec.name);
    return made;
}

}  // namespace darkroom::gpu
