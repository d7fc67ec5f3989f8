// SPDX-License-Identifier: MIT
#include "render/pass/resolve.hpp"

#include <fmt/format.h>

#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

/// shader_text() begins with a version line, which kernels have of their own.
std::string body_of(std::string_view name) {
    const std::string text = shader_text(name);
    return text.substr(text.find("#line"));
}

gpu::KernelSpec spec_of(const TargetFormats& formats, std::array<std::uint32_t, 2> workgroup) {
    gpu::KernelSpec spec{.name = "scene resolve",
                         .images = {},
                         .outputs = {VK_FORMAT_R32_SFLOAT},
                         .is_whole = true,
                         .frame = {},
                         .members = {},
                         .custom_vectors = 1,
                         .body = body_of("resolve.glsl")};
    spec.workgroup = workgroup;
    if (formats.samples == VK_SAMPLE_COUNT_1_BIT) {
        spec.images = {{.name = "drawn_depth"}};
        spec.body += body_of("resolve_one.glsl");
        return spec;
    }
    for (const char* name : {"drawn_color", "drawn_normals", "drawn_velocity", "drawn_depth"})
        spec.images.push_back({.name = name, .sampler_type = "sampler2DMS"});
    spec.outputs = {formats.color, formats.normals, formats.velocity, VK_FORMAT_R32_SFLOAT};
    spec.body += fmt::format("const int samples = {};\n", static_cast<int>(formats.samples));
    spec.body += body_of("resolve_many.glsl");
    return spec;
}

gpu::Region whole(const Targets& targets) {
    const VkExtent3D size = targets.color.info.extent;
    return {.extent = {size.width, size.height}, .image = {size.width, size.height}};
}

std::vector<gpu::Binding> inputs_of(const Targets& targets) {
    std::vector<const gpu::Image*> images{&targets.depth};
    if (targets.is_multi_sampled())
        images = {&targets.many_color, &targets.many_normals, &targets.many_velocity, &targets.depth};
    std::vector<gpu::Binding> out;
    for (const gpu::Image* image : images)
        out.push_back({.view = image->view, .region = whole(targets), .is_nearest = true});
    return out;
}

std::vector<gpu::Binding> outputs_of(const Targets& targets) {
    std::vector<const gpu::Image*> images{&targets.planar_depth};
    if (targets.is_multi_sampled())
        images = {&targets.color, &targets.normals, &targets.velocity, &targets.planar_depth};
    std::vector<gpu::Binding> out;
    for (const gpu::Image* image : images) out.push_back({.view = image->view, .region = whole(targets)});
    return out;
}

}  // namespace

Result<Resolve> Resolve::create(gpu::Context& context, const TargetFormats& formats, std::uint32_t slots) {
    Resolve out;
    out.context_ = &context;
    const gpu::KernelSpec spec = spec_of(formats, gpu::usual_workgroup(context));
    DARKROOM_TRY_VALUE(out.kernel_, gpu::Kernel::create(context, spec, gpu::preferred_stage(context, spec)));
    const std::vector<VkDescriptorSetLayout> layouts(slots, out.kernel_->set_layout());
    DARKROOM_TRY_VALUE(out.sets_, gpu::DescriptorSets::create(context, layouts));
    const VkDeviceSize alignment = context.traits.uniform_alignment;
    out.block_stride_ = (gpu::own_block_size(spec) + alignment - 1) / alignment * alignment;
    DARKROOM_TRY_VALUE(out.blocks_, gpu::Buffer::create(context, out.block_stride_ * slots, gpu::block_usage,
                                                        gpu::Memory::Kind::Constants, "blocks of the scene's resolve"));
    return out;
}

ResolveUse Resolve::use() const { return use_of(*kernel_); }

void Resolve::prepare(const scene::CameraState& camera, const Targets& targets, std::uint32_t slot) {
    const std::array<std::array<float, 4>, 1> custom{std::array{
        camera.near_distance, camera.far_distance, camera.kind == scene::Projection::Perspective ? 1.0F : 0.0F,
        camera.near_distance / camera.far_distance}};
    const std::vector<gpu::Binding> inputs = inputs_of(targets), outputs = outputs_of(targets);
    const gpu::Kernel::Block own{blocks_.handle, slot * block_stride_, gpu::own_block_size(kernel_->spec())};
    gpu::write_own_block(kernel_->spec(), whole(targets), inputs, custom, {},
                         {blocks_.memory.mapped + own.offset, own.size});
    kernel_->write_set({.set = sets_.sets[slot], .own = own, .images = inputs, .outputs = outputs});
}

void Resolve::record(VkCommandBuffer commands, const Targets& targets, std::uint32_t slot) const {
    kernel_->record(commands, sets_.sets[slot], outputs_of(targets));
}

}  // namespace darkroom::render
