// SPDX-License-Identifier: MIT
#include "gpu/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "core/assert.hpp"
#include "gpu/context.hpp"
#include "gpu/formats.hpp"
#include "gpu/resources.hpp"
#include "gpu/shader.hpp"

namespace darkroom::gpu {

namespace {

// record() works in arrays of these sizes, on the stack. Vulkan promises 16 samplers a stage and 4 attachments.
constexpr std::size_t max_images = most_images;
constexpr std::size_t max_outputs = 8;
constexpr std::uint32_t first_image_binding = 2;
// Stores of at least this size cost the software driver more in compute (docs/architecture.md).

// Three vertices make a triangle that covers the viewport: (-1, -1), (3, -1), (-1, 3).
constexpr std::string_view full_screen_source = R"(#version 460
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

std::string_view stage_name(Stage stage) { return stage == Stage::Compute ? "compute" : "raster"; }

/// The text of every refusal: kernel, stage, thing, format, reason.
Failure refusal(const KernelSpec& spec, Stage stage, std::string_view thing, VkFormat format, std::string_view reason) {
    return user_error(fmt::format("kernel \"{}\" ({}): {} of format {} ({}): {}", spec.name, stage_name(stage), thing,
                                  format_name(format), static_cast<int>(format), reason));
}

Result<> can_load(const Context& context, const KernelSpec& spec, Stage stage, const KernelImage& image) {
    const FormatTraits traits = format_traits(image.storage_format);
    const std::string thing = fmt::format("storage image \"{}\"", image.name);
    if (traits.glsl_qualifier.empty()) {
        return refusal(spec, stage, thing, image.storage_format, "GLSL has no storage format of this name");
    }
    if (traits.needs_extended && !context.traits.has_extended_storage_formats) {
        return refusal(spec, stage, thing, image.storage_format, "shaderStorageImageExtendedFormats is not enabled");
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
        return refusal(spec, Stage::Compute, thing, format, "shaderStorageImageWriteWithoutFormat is not enabled");
    }
    if (traits.needs_extended && !context.traits.has_extended_storage_formats) {
        return refusal(spec, Stage::Compute, thing, format, "shaderStorageImageExtendedFormats is not enabled");
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

VkShaderStageFlagBits stage_flag(Stage stage) {
    return stage == Stage::Compute ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
}

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
        const VkResult result =
            context.vk.CreateShaderModule(context.device, &create_info, context.allocator, &module.handle_);
        Result<> checked = context.check(result, fmt::format("creating the shader module of \"{}\"", name));
        if (!checked) return failure(std::move(checked));
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
    Result<std::vector<std::uint32_t>> words = context.shaders->compile(
        {.name = "full-screen triangle", .text = std::string(full_screen_source), .stage = ShaderStage::Vertex});
    if (words) context.full_screen_vertex = *words;
    return words;
}

Result<VkPipeline> create_compute_pipeline(Context& context, const KernelSpec& spec, VkPipelineLayout layout,
                                           const ShaderModule& module) {
    const VkComputePipelineCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT),
        .layout = layout,
    };
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateComputePipelines(context.device, context.pipeline_cache, 1, &create_info,
                                                              context.allocator, &pipeline);
    Result<> checked = context.check(result, fmt::format("creating the compute pipeline of \"{}\"", spec.name));
    if (!checked) return failure(std::move(checked));
    return pipeline;
}

Result<VkPipeline> create_raster_pipeline(Context& context, const KernelSpec& spec, VkPipelineLayout layout,
                                          const ShaderModule& fragment) {
    const Result<std::vector<std::uint32_t>> words = full_screen_vertex(context);
    if (!words) return failure(words.error());
    const Result<ShaderModule> vertex = ShaderModule::create(context, *words, "full-screen triangle");
    if (!vertex) return failure(vertex.error());
    const std::array stages{vertex->stage(VK_SHADER_STAGE_VERTEX_BIT), fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT)};
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
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateGraphicsPipelines(context.device, context.pipeline_cache, 1, &create_info,
                                                               context.allocator, &pipeline);
    Result<> checked = context.check(result, fmt::format("creating the raster pipeline of \"{}\"", spec.name));
    if (!checked) return failure(std::move(checked));
    return pipeline;
}

std::vector<VkDescriptorSetLayoutBinding> layout_bindings(const KernelSpec& spec, Stage stage) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const auto add = [&](std::uint32_t binding, VkDescriptorType type) {
        bindings.push_back({.binding = binding,
                            .descriptorType = type,
                            .descriptorCount = 1,
                            .stageFlags = static_cast<VkShaderStageFlags>(stage_flag(stage))});
    };
    if (!spec.constants.empty()) add(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    add(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    std::uint32_t binding = first_image_binding;
    for (const KernelImage& image : spec.images) {
        const bool is_sampled = image.storage_format == VK_FORMAT_UNDEFINED;
        add(binding++, is_sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    }
    if (stage == Stage::Raster) return bindings;
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        add(binding++, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    }
    return bindings;
}

std::uint32_t group_count(std::uint32_t extent, std::uint32_t workgroup) {
    return (extent + workgroup - 1) / workgroup;
}

}  // namespace

struct Kernel::State {
    explicit State(Context& owner) : context(owner) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        context.vk.DestroyPipeline(context.device, pipeline, context.allocator);
        context.vk.DestroyPipelineLayout(context.device, pipeline_layout, context.allocator);
        context.vk.DestroyDescriptorSetLayout(context.device, set_layout, context.allocator);
    }
    Result<> create_layouts();
    Result<> create_pipeline();
    void update_set(const Invocation& invocation) const;
    void dispatch(VkCommandBuffer commands, const Invocation& invocation) const;
    void draw(VkCommandBuffer commands, const Invocation& invocation) const;

    Context& context;
    KernelSpec spec;
    Stage stage = Stage::Compute;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout pipeline_layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
};

Result<> Kernel::State::create_layouts() {
    const std::vector<VkDescriptorSetLayoutBinding> bindings = layout_bindings(spec, stage);
    const VkDescriptorSetLayoutCreateInfo set_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = static_cast<std::uint32_t>(bindings.size()),
        .pBindings = bindings.data(),
    };
    const VkResult set_result =
        context.vk.CreateDescriptorSetLayout(context.device, &set_info, context.allocator, &set_layout);
    Result<> checked = context.check(set_result, fmt::format("creating the set layout of \"{}\"", spec.name));
    if (!checked) return checked;
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &set_layout};
    return context.check(
        context.vk.CreatePipelineLayout(context.device, &layout_info, context.allocator, &pipeline_layout),
        fmt::format("creating the pipeline layout of \"{}\"", spec.name));
}

Result<> Kernel::State::create_pipeline() {
    const bool is_compute = stage == Stage::Compute;
    const Result<std::vector<std::uint32_t>> words =
        context.shaders->compile({.name = fmt::format("{} ({})", spec.name, stage_name(stage)),
                                  .text = kernel_source(spec, stage),
                                  .stage = is_compute ? ShaderStage::Compute : ShaderStage::Fragment});
    if (!words) return failure(words.error());
    const Result<ShaderModule> module = ShaderModule::create(context, *words, spec.name);
    if (!module) return failure(module.error());
    Result<VkPipeline> made = is_compute ? create_compute_pipeline(context, spec, pipeline_layout, *module)
                                         : create_raster_pipeline(context, spec, pipeline_layout, *module);
    if (!made) return failure(std::move(made));
    pipeline = *made;
    ++context.pipelines_created;
    name_object(context, VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), spec.name);
    return {};
}

void Kernel::State::update_set(const Invocation& invocation) const {
    std::array<VkWriteDescriptorSet, 2 + max_images + max_outputs> writes;
    std::array<VkDescriptorImageInfo, max_images + max_outputs> images;
    std::uint32_t write_count = 0;
    const auto add_write = [&](std::uint32_t binding, VkDescriptorType type) -> VkWriteDescriptorSet& {
        VkWriteDescriptorSet& write = writes[write_count++];
        write = {
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = invocation.set,
            .dstBinding = binding,
            .descriptorCount = 1,
            .descriptorType = type,
        };
        return write;
    };
    const VkDescriptorBufferInfo constants{invocation.constants, invocation.constants_offset,
                                           invocation.constants_size};
    const VkDescriptorBufferInfo pass{invocation.pass_block, invocation.pass_block_offset, pass_block_size(spec)};
    if (!spec.constants.empty()) add_write(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo = &constants;
    add_write(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo = &pass;

    std::uint32_t image_count = 0;
    const auto add_storage = [&](const Binding& binding) {
        images[image_count] = {.imageView = binding.view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
        add_write(first_image_binding + image_count, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE).pImageInfo =
            &images[image_count];
        ++image_count;
    };
    for (std::size_t index = 0; index < spec.images.size(); ++index) {
        const Binding& binding = invocation.images[index];
        if (spec.images[index].storage_format != VK_FORMAT_UNDEFINED) {
            add_storage(binding);
            continue;
        }
        const VkSampler own_sampler = binding.is_nearest ? context.nearest_sampler : context.linear_sampler;
        images[image_count] = {
            .sampler = binding.sampler != VK_NULL_HANDLE ? binding.sampler : own_sampler,
            .imageView = binding.view,
            .imageLayout = binding.layout,
        };
        add_write(first_image_binding + image_count, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER).pImageInfo =
            &images[image_count];
        ++image_count;
    }
    if (stage == Stage::Compute) std::ranges::for_each(invocation.outputs, add_storage);
    context.vk.UpdateDescriptorSets(context.device, write_count, writes.data(), 0, nullptr);
}

void Kernel::State::dispatch(VkCommandBuffer commands, const Invocation& invocation) const {
    const VkExtent2D extent = invocation.outputs.front().region.extent;
    const bool has_groups = invocation.groups[0] != 0;
    const std::uint32_t columns = has_groups ? invocation.groups[0] : group_count(extent.width, spec.workgroup[0]);
    const std::uint32_t rows = has_groups ? invocation.groups[1] : group_count(extent.height, spec.workgroup[1]);
    context.vk.CmdDispatch(commands, columns, rows, 1);
}

void Kernel::State::draw(VkCommandBuffer commands, const Invocation& invocation) const {
    const Dispatch& vk = context.vk;
    const Region& region = invocation.outputs.front().region;
    const VkRect2D area{region.offset, region.extent};
    std::array<VkRenderingAttachmentInfo, max_outputs> attachments;
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        attachments[index] = {
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = invocation.outputs[index].view,
            .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            .loadOp = spec.is_additive ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        };
    }
    const VkRenderingInfo rendering{
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = area,
        .layerCount = 1,
        .colorAttachmentCount = static_cast<std::uint32_t>(spec.outputs.size()),
        .pColorAttachments = attachments.data(),
    };
    const VkViewport viewport{
        .x = static_cast<float>(area.offset.x),
        .y = static_cast<float>(area.offset.y),
        .width = static_cast<float>(area.extent.width),
        .height = static_cast<float>(area.extent.height),
        .maxDepth = 1.0F,
    };
    vk.CmdBeginRendering(commands, &rendering);
    vk.CmdSetViewport(commands, 0, 1, &viewport);
    vk.CmdSetScissor(commands, 0, 1, &area);
    vk.CmdDraw(commands, 3, 1, 0, 0);
    vk.CmdEndRendering(commands);
}

Kernel::Kernel() = default;
Kernel::~Kernel() = default;

Result<std::unique_ptr<Kernel>> Kernel::create(Context& context, const KernelSpec& spec, Stage stage) {
    DARKROOM_ASSERT(!spec.outputs.empty() && spec.outputs.size() <= max_outputs && spec.images.size() <= max_images);
    if (Result<> checked = usable(context, spec, stage); !checked) return failure(std::move(checked));
    std::unique_ptr<Kernel> kernel(new Kernel);
    kernel->state_ = std::make_unique<State>(context);
    kernel->state_->spec = spec;
    kernel->state_->stage = stage;
    if (Result<> created = kernel->state_->create_layouts(); !created) return failure(std::move(created));
    if (Result<> created = kernel->state_->create_pipeline(); !created) return failure(std::move(created));
    return kernel;
}

const KernelSpec& Kernel::spec() const { return state_->spec; }
Stage Kernel::stage() const { return state_->stage; }
VkDescriptorSetLayout Kernel::set_layout() const { return state_->set_layout; }

void Kernel::record(VkCommandBuffer commands, const Invocation& invocation) const {
    const State& state = *state_;
    const Context& context = state.context;
    DARKROOM_ASSERT(invocation.images.size() == state.spec.images.size());
    DARKROOM_ASSERT(invocation.outputs.size() == state.spec.outputs.size());
    state.update_set(invocation);
    const bool is_compute = state.stage == Stage::Compute;
    const VkPipelineBindPoint point = is_compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
    begin_label(context, commands, state.spec.name.c_str());
    context.vk.CmdBindPipeline(commands, point, state.pipeline);
    context.vk.CmdBindDescriptorSets(commands, point, state.pipeline_layout, 0, 1, &invocation.set, 0, nullptr);
    if (is_compute) {
        state.dispatch(commands, invocation);
    } else {
        state.draw(commands, invocation);
    }
    end_label(context, commands);
}

Result<> usable(const Context& context, const KernelSpec& spec, Stage stage) {
    if (stage == Stage::Raster && spec.is_compute_only) {
        return user_error(fmt::format("kernel \"{}\" (raster): it is written for compute only", spec.name));
    }
    if (spec.is_additive && spec.outputs.size() != 1) {
        return user_error(
            fmt::format("kernel \"{}\": {} outputs, but an additive kernel has 1", spec.name, spec.outputs.size()));
    }
    for (const KernelImage& image : spec.images) {
        if (image.storage_format == VK_FORMAT_UNDEFINED) continue;
        if (Result<> checked = can_load(context, spec, stage, image); !checked) return checked;
    }
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        const bool is_compute = stage == Stage::Compute;
        Result<> checked = is_compute ? can_store(context, spec, index) : can_render(context, spec, index);
        if (!checked) return checked;
    }
    return {};
}

Stage preferred_stage(const Context& context, const KernelSpec& spec) {
    if (spec.is_compute_only || !usable(context, spec, Stage::Raster)) return Stage::Compute;
    if (!usable(context, spec, Stage::Compute)) return Stage::Raster;
    if (!context.traits.is_software) return Stage::Compute;
    return Stage::Raster;
}

}  // namespace darkroom::gpu
