// SPDX-License-Identifier: MIT
#include "render/shadow/casters.hpp"

#include <array>

#include "core/assert.hpp"
#include "draw/pipeline.hpp"
#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

/// Texels of slope that casters lie deeper than they are. A wall of one texel is lost beyond 1 - sqrt(1/2), where a
/// point beside it still has to be dark in the nearest texel; shaders/light/shadow.glsl does the rest.
constexpr float bias_slope = 0.28F;
/// Inputs of shaders/mesh/mesh_place.glsl.
constexpr std::uint32_t normal_location = 1, tangent_location = 2;

}  // namespace

Casters::Casters(gpu::Context& context, VkDescriptorSetLayout frame_layout, VkDescriptorSetLayout material_layout)
    : context_(&context), frame_layout_(frame_layout), material_layout_(material_layout) {}

Casters::Variant Casters::variant_of(const scene::Snapshot& snapshot, const DrawList& list, const Batch& batch,
                                     NearCasters near_casters) {
    const scene::ModelMaterial& surface = snapshot.materials[batch.material].surface;
    return {.is_skinned = batch.is_skinned,
            .is_morphed = snapshot.instances[list.order[batch.first]].weight_count > 0,
            .is_masked = surface.blend == scene::SurfaceBlend::Mask,
            .is_mirrored = batch.is_mirrored && !surface.is_double_sided,
            .is_double_sided = surface.is_double_sided,
            .near_casters = near_casters};
}

Result<gpu::Pipeline> Casters::create_pipeline(const Variant& variant) const {
    MeshInput input = mesh_input(variant.is_skinned);
    // Depths have no use for normals and tangents, and the compiler takes out what places them.
    std::erase_if(input.attributes, [](const auto& attribute) {
        return attribute.location == normal_location || attribute.location == tangent_location;
    });
    gpu::PipelineDesc pipeline{
        .name = "shadow map",
        .vertex = shader_text("mesh/depth_vertex.glsl"),
        .fragment = variant.is_masked ? shader_text("mesh/masked_depth_fragment.glsl") : std::string(),
        .bindings = input.bindings,
        .attributes = input.attributes,
        .sets = {frame_layout_},
        .push_constant_size = sizeof(std::uint32_t),
        .colors = {{.format = VK_FORMAT_UNDEFINED}},  // see ShadowPass, begin_rendering()
        .depth = shadow_map_format,
        .cull = static_cast<VkCullModeFlags>(variant.is_double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT),
        .front = variant.is_mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL,
        .clamps_depth = context_->traits.has_depth_clamp && variant.near_casters == NearCasters::Flattened,
        .depth_bias_slope = bias_slope};
    if (variant.is_masked) pipeline.sets.push_back(material_layout_);
    // has_textures, is_skinned, is_morphed; see the shaders.
    pipeline.specialization.assign(12, 0);
    pipeline.specialization[0] = 1;
    pipeline.specialization[10] = variant.is_skinned ? 1 : 0;
    pipeline.specialization[11] = variant.is_morphed ? 1 : 0;
    return gpu::Pipeline::create(*context_, pipeline);
}

Result<> Casters::require(const scene::Snapshot& snapshot, const DrawList& list, NearCasters near_casters) {
    for (const std::vector<Batch>* batches : {&list.opaque, &list.transparent}) {
        for (const Batch& batch : *batches) {
            const Variant variant = variant_of(snapshot, list, batch, near_casters);
            if (pipelines_.contains(variant)) continue;
            DARKROOM_TRY_VALUE(gpu::Pipeline made, create_pipeline(variant));
            pipelines_.emplace(variant, std::move(made));
        }
    }
    return {};
}

Result<> Casters::record_batch(const Recording& recording, const DrawList& list, const Batch& batch,
                               std::uint32_t first_instance) const {
    const Variant variant = variant_of(*recording.snapshot, list, batch, recording.near_casters);
    const auto found = pipelines_.find(variant);
    DARKROOM_ASSERT(found != pipelines_.end());
    const gpu::Pipeline& pipeline = found->second;
    const VkCommandBuffer commands = recording.commands;
    std::array sets{recording.frame_set, recording.frame_set};
    if (variant.is_masked) {
        DARKROOM_TRY_VALUE(VkDescriptorSet textures,
                           recording.scene->textures(recording.snapshot->materials[batch.material]));
        sets[1] = textures;
    }
    context_->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    context_->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0,
                                       variant.is_masked ? 2 : 1, sets.data(), 0, nullptr);
    context_->vk.CmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                                  0, sizeof recording.map, &recording.map);
    recording.scene->draw(commands, batch.mesh, first_instance + batch.first, batch.count);
    return {};
}

Result<> Casters::record(const Recording& recording, const DrawList& list, std::uint32_t first_instance) const {
    for (const std::vector<Batch>* batches : {&list.opaque, &list.transparent}) {
        for (const Batch& batch : *batches) {
            DARKROOM_TRY(record_batch(recording, list, batch, first_instance));
        }
    }
    return {};
}

}  // namespace darkroom::render
