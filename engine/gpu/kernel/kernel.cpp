// SPDX-License-Identifier: MIT
#include "gpu/kernel/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/assert.hpp"
#include "gpu/device/cleared.hpp"
#include "gpu/device/context.hpp"
#include "gpu/kernel/kernel_pipeline.hpp"
#include "gpu/kernel/pipeline_statistics.hpp"

namespace darkroom::gpu {

namespace {

VkShaderStageFlagBits stage_flag(Stage stage) {
    return stage == Stage::Compute ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
}

/// Its sampler belongs to the layout: what Vulkan is over another interface may know no other one that compares
/// (VkPhysicalDevicePortabilitySubsetFeaturesKHR::mutableComparisonSamplers).
bool is_compared(const KernelImage& image) { return image.sampler_type.ends_with("Shadow"); }

std::vector<VkDescriptorSetLayoutBinding> layout_bindings(const Context& context, const KernelSpec& spec, Stage stage) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const auto add = [&](std::uint32_t binding, VkDescriptorType type, const VkSampler* sampler = nullptr) {
        bindings.push_back({.binding = binding,
                            .descriptorType = type,
                            .descriptorCount = 1,
                            .stageFlags = stage_flag(stage),
                            .pImmutableSamplers = sampler});
    };
    if (!spec.frame.empty()) add(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    add(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    std::uint32_t binding = first_image_binding;
    for (const KernelImage& image : spec.images) {
        const bool is_sampled = image.storage_format == VK_FORMAT_UNDEFINED;
        add(binding++, is_sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
            is_compared(image) ? &context.shadow_sampler : nullptr);
    }
    for (std::size_t index = 0; stage == Stage::Compute && index < spec.outputs.size(); ++index) {
        add(binding++, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    }
    for (std::size_t index = 0; index < spec.buffers.size(); ++index) add(binding++, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
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
    void update_set(const Invocation& invocation) const;
    void bind(VkCommandBuffer commands, VkDescriptorSet set) const;
    void draw(VkCommandBuffer commands, std::span<const Binding> outputs) const;

    Context& context;
    KernelSpec spec;
    Stage stage = Stage::Compute;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout pipeline_layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
};

Result<> Kernel::State::create_layouts() {
    const std::vector<VkDescriptorSetLayoutBinding> bindings = layout_bindings(context, spec, stage);
    const VkDescriptorSetLayoutCreateInfo set_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = static_cast<std::uint32_t>(bindings.size()),
        .pBindings = bindings.data(),
    };
    const VkResult set_result = cleared_on_failure(
        context.vk.CreateDescriptorSetLayout(context.device, &set_info, context.allocator, &set_layout), set_layout);
    DARKROOM_TRY(context.check(set_result, fmt::format("creating the set layout of \"{}\"", spec.name)));
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &set_layout};
    return context.check(cleared_on_failure(context.vk.CreatePipelineLayout(context.device, &layout_info,
                                                                            context.allocator, &pipeline_layout),
                                            pipeline_layout),
                         fmt::format("creating the pipeline layout of \"{}\"", spec.name));
}

void Kernel::State::update_set(const Invocation& invocation) const {
    std::array<VkWriteDescriptorSet, 2 + max_images + max_outputs + max_buffers> writes;
    std::array<VkDescriptorBufferInfo, max_buffers> buffers;
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
    const auto info = [](const Block& block) { return VkDescriptorBufferInfo{block.buffer, block.offset, block.size}; };
    const VkDescriptorBufferInfo frame = info(invocation.frame), own = info(invocation.own);
    if (!spec.frame.empty()) add_write(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo = &frame;
    add_write(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).pBufferInfo = &own;

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
            .sampler = is_compared(spec.images[index]) ? VK_NULL_HANDLE : own_sampler,
            .imageView = binding.view,
            .imageLayout = binding.layout,
        };
        add_write(first_image_binding + image_count, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER).pImageInfo =
            &images[image_count];
        ++image_count;
    }
    if (stage == Stage::Compute) std::ranges::for_each(invocation.outputs, add_storage);
    for (std::uint32_t index = 0; index < invocation.buffers.size(); ++index) {
        buffers[index] = info(invocation.buffers[index]);
        add_write(first_buffer_binding(spec, stage) + index, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER).pBufferInfo =
            &buffers[index];
    }
    context.vk.UpdateDescriptorSets(context.device, write_count, writes.data(), 0, nullptr);
}

void Kernel::State::bind(VkCommandBuffer commands, VkDescriptorSet set) const {
    const bool is_compute = stage == Stage::Compute;
    const VkPipelineBindPoint point = is_compute ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
    context.vk.CmdBindPipeline(commands, point, pipeline);
    context.vk.CmdBindDescriptorSets(commands, point, pipeline_layout, 0, 1, &set, 0, nullptr);
}

void Kernel::State::draw(VkCommandBuffer commands, std::span<const Binding> outputs) const {
    const Dispatch& vk = context.vk;
    const Region& region = outputs.front().region;
    const VkRect2D area{region.offset, region.extent};
    std::array<VkRenderingAttachmentInfo, max_outputs> attachments;
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        attachments[index] = {
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = outputs[index].view,
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
    return create(context, spec, stage, KernelText(spec, stage));
}

Result<std::unique_ptr<Kernel>> Kernel::create(Context& context, const KernelSpec& spec, Stage stage,
                                               const KernelText& text) {
    DARKROOM_ASSERT((spec.compute || !spec.outputs.empty()) && spec.buffers.size() <= max_buffers);
    DARKROOM_ASSERT(spec.outputs.size() <= max_outputs && spec.images.size() <= max_images);
    DARKROOM_TRY(usable(context, spec, stage));
    std::unique_ptr<Kernel> kernel(new Kernel);
    kernel->state_ = std::make_unique<State>(context);
    State& state = *kernel->state_;
    state.spec = spec;
    state.spec.body.clear();
    state.stage = stage;
    DARKROOM_TRY(state.create_layouts());
    DARKROOM_TRY_VALUE(state.pipeline, create_kernel_pipeline(context, spec, stage, text, state.pipeline_layout));
    return kernel;
}

const KernelSpec& Kernel::spec() const { return state_->spec; }
Stage Kernel::stage() const { return state_->stage; }
VkDescriptorSetLayout Kernel::set_layout() const { return state_->set_layout; }

Result<KernelStatistics> Kernel::statistics() const {
    DARKROOM_TRY_VALUE(auto out, pipeline_statistics(state_->context, state_->pipeline, stage_flag(state_->stage)));
    out.name = state_->spec.name;
    if (state_->stage == Stage::Compute) out.workgroup = state_->spec.workgroup;
    return out;
}

void Kernel::write_set(const Invocation& invocation) const {
    DARKROOM_ASSERT(invocation.images.size() == state_->spec.images.size());
    DARKROOM_ASSERT(invocation.outputs.size() == state_->spec.outputs.size());
    DARKROOM_ASSERT(invocation.buffers.size() == state_->spec.buffers.size());
    state_->update_set(invocation);
}

void Kernel::record(VkCommandBuffer commands, VkDescriptorSet set, std::span<const Binding> outputs) const {
    const State& state = *state_;
    const VkExtent2D extent = outputs.front().region.extent;
    const auto [width, height] = state.spec.workgroup;
    if (state.stage == Stage::Compute)
        return record_groups(commands, set, {group_count(extent.width, width), group_count(extent.height, height)});
    state.bind(commands, set);
    state.draw(commands, outputs);
}

void Kernel::record_groups(VkCommandBuffer commands, VkDescriptorSet set, std::array<std::uint32_t, 2> groups) const {
    state_->bind(commands, set);
    state_->context.vk.CmdDispatch(commands, groups[0], groups[1], 1);
}

}  // namespace darkroom::gpu
