// SPDX-License-Identifier: MIT
#include "render/pass/mesh_pass.hpp"

#include <map>

#include "render/frame_set.hpp"
#include "render/shader_text.hpp"
#include "render/upload/gpu_scene.hpp"
#include "scene/model.hpp"

namespace darkroom::render {

using scene::SurfaceBlend;

namespace {

// The pipelines of MeshPass, one for each combination of what a pipeline fixes, made when it is first asked for.

enum class MeshKind : std::uint8_t {
    Surface,
    Edges,         ///< of triangles, instead of surfaces
    RoomEdges,     ///< of a room's box
    Overlay,       ///< edges of triangles over the picture
    NormalArrows,  ///< a line a vertex
};

struct MeshVariant {
    MeshKind kind = MeshKind::Surface;
    bool is_debug_view = false;
    bool is_skinned = false, is_morphed = false;
    // Of surfaces:
    bool is_mirrored = false, is_double_sided = false, writes_alpha_only = false, has_textures = false;
    scene::SurfaceBlend blend = scene::SurfaceBlend::Opaque;
    std::uint32_t layers = 0;  ///< shader_layers()
    friend auto operator<=>(const MeshVariant&, const MeshVariant&) = default;
};

class MeshPipelines {
  public:
    void create(gpu::Context& context, const PassSetup& setup, VkDescriptorSetLayout textures);
    [[nodiscard]] Result<const gpu::Pipeline*> find(const MeshVariant& variant);

  private:
    [[nodiscard]] gpu::PipelineDesc describe(const MeshVariant& variant) const;
    void describe_surface(gpu::PipelineDesc& desc, const MeshVariant& variant) const;
    void describe_lines(gpu::PipelineDesc& desc, const MeshVariant& variant) const;

    gpu::Context* context_ = nullptr;
    PassSetup setup_;
    VkDescriptorSetLayout textures_ = VK_NULL_HANDLE;
    std::map<MeshVariant, gpu::Pipeline> pipelines_;  ///< nodes stay where they are
};

constexpr VkColorComponentFlags rgb = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;

/// Numbers of the constants in mesh_place.glsl; those of the fragment stage come before.
constexpr std::size_t skinned_constant = 10, morphed_constant = 11, constants = 14;

std::uint32_t word(bool value) { return value ? 1 : 0; }

/// Whether what is behind shows through, for some alphas.
bool is_blend(SurfaceBlend blend) { return blend != SurfaceBlend::Opaque && blend != SurfaceBlend::Mask; }

/// How a material's colour goes into the colour target. What is blended keeps the alpha that is there.
gpu::ColorTarget blended_target(SurfaceBlend blend, bool has_alpha_layer) {
    gpu::ColorTarget target;
    if (has_alpha_layer) target.writes = rgb;
    if (!is_blend(blend)) return target;
    target.is_blended = true;
    target.source_alpha = VK_BLEND_FACTOR_ZERO;
    target.destination_alpha = VK_BLEND_FACTOR_ONE;
    target.source = blend == SurfaceBlend::Multiply ? VK_BLEND_FACTOR_DST_COLOR : VK_BLEND_FACTOR_SRC_ALPHA;
    target.destination = blend == SurfaceBlend::Additive ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    return target;
}

void MeshPipelines::create(gpu::Context& context, const PassSetup& setup, VkDescriptorSetLayout textures) {
    context_ = &context;
    setup_ = setup;
    textures_ = textures;
}

Result<const gpu::Pipeline*> MeshPipelines::find(const MeshVariant& variant) {
    if (const auto found = pipelines_.find(variant); found != pipelines_.end()) return &found->second;
    DARKROOM_TRY_VALUE(gpu::Pipeline made, gpu::Pipeline::create(*context_, describe(variant)));
    return &pipelines_.emplace(variant, std::move(made)).first->second;
}

gpu::PipelineDesc MeshPipelines::describe(const MeshVariant& variant) const {
    MeshInput input =
        mesh_input(variant.is_skinned, variant.kind == MeshKind::NormalArrows ? VK_VERTEX_INPUT_RATE_INSTANCE
                                                                              : VK_VERTEX_INPUT_RATE_VERTEX);
    gpu::PipelineDesc desc{.bindings = std::move(input.bindings),
                           .attributes = std::move(input.attributes),
                           .sets = {setup_.frame_layout, textures_},
                           .push_constant_size = sizeof(std::uint32_t),
                           .specialization = std::vector<std::uint32_t>(constants),
                           .depth = setup_.formats.depth,
                           .samples = setup_.formats.samples};
    desc.specialization[skinned_constant] = word(variant.is_skinned);
    desc.specialization[morphed_constant] = word(variant.is_morphed);
    if (variant.kind == MeshKind::Surface) {
        describe_surface(desc, variant);
    } else {
        describe_lines(desc, variant);
    }
    return desc;
}

void MeshPipelines::describe_surface(gpu::PipelineDesc& desc, const MeshVariant& variant) const {
    const bool is_transparent = is_blend(variant.blend);
    desc.name = "mesh";
    desc.vertex = shader_text("mesh/mesh_vertex.glsl");
    desc.fragment = shader_text("mesh/mesh_fragment.glsl");
    // As shaders/mesh/mesh_fragment.glsl numbers them.
    desc.specialization[0] = word(variant.has_textures);
    desc.specialization[1] = word(setup_.shadow_maps > 0);
    desc.specialization[2] = word(setup_.has_environment);
    desc.specialization[3] = word(variant.blend == SurfaceBlend::Mask);
    desc.specialization[4] = static_cast<std::uint32_t>(setup_.output);
    desc.specialization[5] = word(variant.is_debug_view);
    desc.specialization[6] = word(setup_.is_tone_mapped);
    desc.specialization[7] = word(is_transparent || variant.writes_alpha_only);
    desc.specialization[8] = setup_.shadow_maps;
    desc.specialization[9] = word(setup_.has_soft_shadows);
    desc.specialization[12] = word(setup_.has_lamp_shadows);
    desc.specialization[13] = variant.layers;
    desc.cull = variant.is_double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    desc.front = variant.is_mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
    gpu::ColorTarget color = blended_target(variant.blend, setup_.formats.has_alpha_layer);
    if (variant.writes_alpha_only) color = {.writes = VK_COLOR_COMPONENT_A_BIT};
    const bool is_laid_over = is_transparent || variant.writes_alpha_only;
    desc.writes_depth = !is_laid_over;
    // A surface that lies where another does is not shaded again. What is cut out may lie on one, as a label does.
    if (!is_laid_over && variant.blend == SurfaceBlend::Opaque) desc.depth_compare = VK_COMPARE_OP_GREATER;
    desc.colors =
        setup_.formats.colors(color, is_laid_over ? TargetFormats::Layers::Kept : TargetFormats::Layers::Written);
}

void MeshPipelines::describe_lines(gpu::PipelineDesc& desc, const MeshVariant& variant) const {
    const bool are_arrows = variant.kind == MeshKind::NormalArrows, are_all = variant.kind == MeshKind::Edges;
    desc.name = are_arrows ? "normal arrows" : "edges of meshes";
    desc.vertex = shader_text(are_arrows ? "mesh/normal_arrows_vertex.glsl" : "mesh/wireframe_vertex.glsl");
    desc.fragment = shader_text("line_fragment.glsl");
    // Lines need no texture coordinates, and edges no normals.
    std::erase_if(desc.attributes, [&](const VkVertexInputAttributeDescription& attribute) {
        const bool is_normal = attribute.location == 1;
        return attribute.binding == 0 && attribute.location != 0 && !(are_arrows && is_normal);
    });
    desc.colors =
        setup_.formats.colors(blended_target(are_arrows || are_all ? SurfaceBlend::Opaque : SurfaceBlend::Alpha,
                                             setup_.formats.has_alpha_layer),
                              TargetFormats::Layers::Kept);
    desc.writes_depth = are_all;
    if (are_arrows || variant.kind == MeshKind::RoomEdges) desc.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    if (are_arrows) return;
    desc.specialization[0] = word(variant.kind == MeshKind::Overlay);
    desc.specialization[1] = word(setup_.output == Output::Display && !variant.is_debug_view);
    desc.specialization[2] = word(are_all);
    if (variant.kind == MeshKind::RoomEdges) return;
    desc.polygon_mode = VK_POLYGON_MODE_LINE;
    if (variant.kind == MeshKind::Overlay) {
        // Toward the eye (depth is reversed), so that surfaces do not break their own edges.
        desc.depth_bias = 16;
        desc.depth_bias_slope = 1;
    }
}

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
