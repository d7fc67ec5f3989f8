// SPDX-License-Identifier: MIT
#include "render/pass/mesh_pass_pipelines.hpp"

#include "render/shader_text.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

namespace {

using scene::SurfaceBlend;

constexpr VkColorComponentFlags rgb = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;

/// Numbers of the constants in mesh_place.glsl; those of the fragment stage come before.
constexpr std::size_t skinned_constant = 10, morphed_constant = 11, constants = 14;

std::uint32_t word(bool value) { return value ? 1 : 0; }

}  // namespace

bool is_blend(SurfaceBlend blend) { return blend != SurfaceBlend::Opaque && blend != SurfaceBlend::Mask; }

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

}  // namespace darkroom::render
