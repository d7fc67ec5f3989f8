// SPDX-License-Identifier: MIT
#include "render/mesh_pass.hpp"

#include "render/mesh_pass_pipelines.hpp"

namespace darkroom::render {

namespace {

MeshVariant variant_of(const scene::Snapshot& snapshot, const Batch& batch, const GpuScene& scene, MeshKind kind) {
    const scene::SnapshotMaterial& material = snapshot.materials[batch.material];
    const scene::ModelMaterial& surface = material.surface;
    MeshVariant variant{.kind = kind, .is_skinned = batch.is_skinned};
    variant.is_morphed = scene.mesh(batch.mesh).morph_targets > 0;
    if (kind != MeshKind::Surface) return variant;
    variant.is_mirrored = batch.is_mirrored;
    variant.is_double_sided = surface.is_double_sided;
    variant.writes_alpha_only = material.writes == scene::Writes::Alpha;
    variant.has_textures = material.entity_texture != scene::no_index || surface.base_color_texture.is_given() ||
                           surface.metallic_roughness_texture.is_given() || surface.normal_texture.is_given() ||
                           surface.occlusion_texture.is_given() || surface.emissive_texture.is_given();
    variant.blend = surface.blend;
    return variant;
}

}  // namespace

struct MeshPass::State {
    gpu::Context* context = nullptr;
    MeshPipelines pipelines;
    DebugView debug = DebugView::None;
    std::uint64_t draw_calls = 0;

    /// What surfaces are drawn as.
    [[nodiscard]] MeshKind surface_kind() const {
        return debug == DebugView::Wireframe ? MeshKind::Edges : MeshKind::Surface;
    }
    Result<const gpu::Pipeline*> bind(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene,
                                      const Batch& batch, MeshKind kind);
    Result<> record(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene, const std::vector<Batch>& batches,
                    MeshKind kind);

    // Of the recording that is going on.
    VkPipeline bound_pipeline = VK_NULL_HANDLE;
    VkDescriptorSet bound_textures = VK_NULL_HANDLE;
    /// Nothing is known of what other passes bound since.
    void forget_bindings() {
        bound_pipeline = VK_NULL_HANDLE;
        bound_textures = VK_NULL_HANDLE;
    }
};

Result<const gpu::Pipeline*> MeshPass::State::bind(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene,
                                                   const Batch& batch, MeshKind kind) {
    const gpu::Dispatch& vk = context->vk;
    Result<const gpu::Pipeline*> pipeline = pipelines.find(variant_of(*draw.snapshot, batch, scene, kind));
    if (!pipeline) return pipeline;
    Result<VkDescriptorSet> textures = scene.textures(draw.snapshot->materials[batch.material]);
    if (!textures) return failure(std::move(textures));
    const bool is_new_pipeline = (*pipeline)->handle != bound_pipeline;
    if (is_new_pipeline) vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, (*pipeline)->handle);
    if (bound_pipeline == VK_NULL_HANDLE) {
        // All layouts of this pass are compatible, so it outlives a change of pipeline.
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, (*pipeline)->layout, 0, 1, &draw.frame_set,
                                 0, nullptr);
    }
    if (*textures != bound_textures)
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, (*pipeline)->layout, 1, 1, &*textures, 0,
                                 nullptr);
    bound_pipeline = (*pipeline)->handle;
    bound_textures = *textures;
    return pipeline;
}

Result<> MeshPass::State::record(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene,
                                 const std::vector<Batch>& batches, MeshKind kind) {
    forget_bindings();
    for (const Batch& batch : batches) {
        Result<const gpu::Pipeline*> pipeline = bind(commands, draw, scene, batch, kind);
        if (!pipeline) return failure(std::move(pipeline));
        if (kind == MeshKind::RoomEdges) {
            scene.draw_box_edges(commands, draw.first_instance + batch.first, batch.count);
        } else {
            scene.draw(commands, batch.mesh, draw.first_instance + batch.first, batch.count);
        }
        ++draw_calls;
    }
    return {};
}

Result<MeshPass> MeshPass::create(gpu::Context& context, const PassSetup& setup, GpuScene& scene, DebugView debug) {
    if (debug == DebugView::Wireframe && !context.traits.has_wireframe)
        return user_error("debug view wireframe: " + context.info.name + " cannot draw the edges of triangles");
    MeshPass out;
    out.state_ = std::make_shared<State>();
    out.state_->context = &context;
    out.state_->debug = debug;
    out.state_->pipelines.create(context, setup, scene.material_layout.handle, debug);
    return out;
}

Result<> MeshPass::prepare(const scene::Snapshot& snapshot, const DrawList& list, GpuScene& scene) {
    const auto make = [&](const std::vector<Batch>& batches, MeshKind kind) -> Result<> {
        for (const Batch& batch : batches) {
            Result<const gpu::Pipeline*> made = state_->pipelines.find(variant_of(snapshot, batch, scene, kind));
            if (!made) return failure(std::move(made));
        }
        return {};
    };
    if (Result<> made = make(list.opaque, state_->surface_kind()); !made) return made;
    if (Result<> made = make(list.transparent, state_->surface_kind()); !made) return made;
    return make(list.wireframe, MeshKind::RoomEdges);
}

Result<> MeshPass::record_opaque(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    return state_->record(commands, draw, scene, draw.list->opaque, state_->surface_kind());
}

Result<> MeshPass::record_transparent(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    Result<> rooms = state_->record(commands, draw, scene, draw.list->wireframe, MeshKind::RoomEdges);
    if (!rooms) return rooms;
    return state_->record(commands, draw, scene, draw.list->transparent, state_->surface_kind());
}

Result<> MeshPass::record_wireframe_overlay(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    if (!state_->context->traits.has_wireframe)
        return user_error("wireframe overlay: " + state_->context->info.name + " cannot draw the edges of triangles");
    for (const std::vector<Batch>* batches : {&draw.list->opaque, &draw.list->transparent}) {
        Result<> done = state_->record(commands, draw, scene, *batches, MeshKind::Overlay);
        if (!done) return done;
    }
    return {};
}

Result<> MeshPass::record_normal_arrows(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    const gpu::Dispatch& vk = state_->context->vk;
    state_->forget_bindings();
    for (const std::vector<Batch>* batches : {&draw.list->opaque, &draw.list->transparent}) {
        for (const Batch& batch : *batches) {
            Result<const gpu::Pipeline*> pipeline = state_->bind(commands, draw, scene, batch, MeshKind::NormalArrows);
            if (!pipeline) return failure(std::move(pipeline));
            const GpuMesh& mesh = scene.mesh(batch.mesh);
            scene.bind_vertices(commands, mesh);
            for (std::uint32_t i = 0; i < batch.count; ++i) {
                const std::uint32_t instance = draw.first_instance + batch.first + i;
                vk.CmdPushConstants(commands, (*pipeline)->layout,
                                    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof instance,
                                    &instance);
                vk.CmdDraw(commands, 2, mesh.vertex_count, 0, 0);
                ++state_->draw_calls;
            }
        }
    }
    return {};
}

std::uint64_t MeshPass::draw_calls() const { return state_->draw_calls; }

}  // namespace darkroom::render
