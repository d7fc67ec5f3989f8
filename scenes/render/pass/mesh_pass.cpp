// SPDX-License-Identifier: MIT
#include "render/pass/mesh_pass.hpp"

#include "render/pass/mesh_pass_pipelines.hpp"

namespace darkroom::render {

namespace {

/// What surfaces are drawn as.
MeshKind surface_kind(const MeshLook& look) {
    return look.debug == DebugView::Wireframe ? MeshKind::Edges : MeshKind::Surface;
}

MeshVariant variant_of(const MeshDraw& draw, const Batch& batch, const GpuScene& scene, MeshKind kind) {
    const scene::SnapshotMaterial& material = draw.snapshot->materials[batch.material];
    const scene::ModelMaterial& surface = material.surface;
    const DebugView debug = draw.look.debug;
    MeshVariant variant{.kind = kind, .is_skinned = batch.is_skinned};
    variant.is_debug_view = debug != DebugView::None && kind != MeshKind::NormalArrows;
    variant.is_morphed = scene.mesh(batch.mesh).morph_targets > 0;
    if (kind != MeshKind::Surface) return variant;
    variant.is_mirrored = batch.is_mirrored;
    variant.is_double_sided = surface.is_double_sided;
    variant.writes_alpha_only = material.writes == scene::Writes::Alpha;
    variant.has_textures =
        material.entity_texture != scene::no_index ||
        std::ranges::any_of(scene::textures_of(surface), [](const auto& use) { return use.texture->is_given(); });
    variant.layers = variant.is_debug_view ? 0 : shader_layers(surface);
    variant.blend = surface.blend;
    // Views of one property show what is nearest; only the unlit one still is a picture.
    if (variant.is_debug_view && debug != DebugView::Unlit && is_blend(surface.blend))
        variant.blend = scene::SurfaceBlend::Opaque;
    return variant;
}

}  // namespace

struct MeshPass::State {
    gpu::Context* context = nullptr;
    MeshPipelines pipelines;
    std::uint64_t draw_calls = 0;

    Result<const gpu::Pipeline*> bind(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene,
                                      const Batch& batch, MeshKind kind);
    Result<> record(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene, const std::vector<Batch>& batches,
                    MeshKind kind);
    Result<> record_normal_arrows(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene);

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
    DARKROOM_TRY_VALUE(auto* pipeline, pipelines.find(variant_of(draw, batch, scene, kind)));
    DARKROOM_TRY_VALUE(VkDescriptorSet textures, scene.textures(draw.snapshot->materials[batch.material]));
    const bool is_new_pipeline = pipeline->handle != bound_pipeline;
    if (is_new_pipeline) vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->handle);
    if (bound_pipeline == VK_NULL_HANDLE) {
        // All layouts of this pass are compatible, so it outlives a change of pipeline.
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout, 0, 1, &draw.frame_set, 0,
                                 nullptr);
    }
    if (textures != bound_textures)
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout, 1, 1, &textures, 0,
                                 nullptr);
    bound_pipeline = pipeline->handle;
    bound_textures = textures;
    return pipeline;
}

Result<> MeshPass::State::record(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene,
                                 const std::vector<Batch>& batches, MeshKind kind) {
    forget_bindings();
    for (const Batch& batch : batches) {
        DARKROOM_TRY(bind(commands, draw, scene, batch, kind));
        if (kind == MeshKind::RoomEdges) {
            scene.draw_box_edges(commands, draw.first_instance + batch.first, batch.count);
        } else {
            scene.draw(commands, batch.mesh, draw.first_instance + batch.first, batch.count);
        }
        ++draw_calls;
    }
    return {};
}

Result<> MeshPass::State::record_normal_arrows(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) {
    const gpu::Dispatch& vk = context->vk;
    forget_bindings();
    for (const std::vector<Batch>* batches : {&draw.list->opaque, &draw.list->transparent}) {
        for (const Batch& batch : *batches) {
            DARKROOM_TRY_VALUE(auto* pipeline, bind(commands, draw, scene, batch, MeshKind::NormalArrows));
            const GpuMesh& mesh = scene.mesh(batch.mesh);
            scene.bind_vertices(commands, mesh);
            for (std::uint32_t i = 0; i < batch.count; ++i) {
                const std::uint32_t instance = draw.first_instance + batch.first + i;
                vk.CmdPushConstants(commands, pipeline->layout,
                                    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof instance,
                                    &instance);
                vk.CmdDraw(commands, 2, mesh.vertex_count, 0, 0);
                ++draw_calls;
            }
        }
    }
    return {};
}

MeshPass MeshPass::create(gpu::Context& context, const PassSetup& setup, const GpuScene& scene) {
    MeshPass out;
    out.state_ = std::make_shared<State>();
    out.state_->context = &context;
    out.state_->pipelines.create(context, setup, scene.material_layout.handle);
    return out;
}

Result<> MeshPass::prepare(const MeshDraw& draw, const GpuScene& scene) {
    const auto make = [&](const std::vector<Batch>& batches, MeshKind kind) -> Result<> {
        for (const Batch& batch : batches) {
            DARKROOM_TRY(state_->pipelines.find(variant_of(draw, batch, scene, kind)));
        }
        return {};
    };
    std::vector<MeshKind> kinds{surface_kind(draw.look)};
    if (draw.look.has_edges) kinds.push_back(MeshKind::Overlay);
    if (draw.look.has_normal_arrows) kinds.push_back(MeshKind::NormalArrows);
    for (const MeshKind kind : kinds)
        for (const std::vector<Batch>* batches : {&draw.list->opaque, &draw.list->transparent})
            DARKROOM_TRY(make(*batches, kind));
    return make(draw.list->wireframe, MeshKind::RoomEdges);
}

Result<> MeshPass::record_opaque(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    return state_->record(commands, draw, scene, draw.list->opaque, surface_kind(draw.look));
}

Result<> MeshPass::record_transparent(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    DARKROOM_TRY(state_->record(commands, draw, scene, draw.list->wireframe, MeshKind::RoomEdges));
    return state_->record(commands, draw, scene, draw.list->transparent, surface_kind(draw.look));
}

Result<> MeshPass::record_overlays(VkCommandBuffer commands, const MeshDraw& draw, GpuScene& scene) const {
    if (draw.look.has_edges) {
        for (const std::vector<Batch>* batches : {&draw.list->opaque, &draw.list->transparent}) {
            DARKROOM_TRY(state_->record(commands, draw, scene, *batches, MeshKind::Overlay));
        }
    }
    if (!draw.look.has_normal_arrows) return {};
    return state_->record_normal_arrows(commands, draw, scene);
}

std::uint64_t MeshPass::draw_calls() const { return state_->draw_calls; }

}  // namespace darkroom::render
