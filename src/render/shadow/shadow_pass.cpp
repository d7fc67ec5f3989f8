// SPDX-License-Identifier: MIT
#include "render/shadow/shadow_pass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "core/assert.hpp"
#include "gpu/kernel/pipeline.hpp"
#include "gpu/resource/resources.hpp"
#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

constexpr VkFormat map_format = VK_FORMAT_D32_SFLOAT;
/// Texels of slope that casters lie deeper than they are. A wall of one texel is lost beyond 1 - sqrt(1/2), where a
/// point beside it still has to be dark in the nearest texel; shaders/light/shadow.glsl does the rest.
constexpr float bias_slope = 0.28F;
/// Inputs of shaders/mesh/mesh_place.glsl.
constexpr std::uint32_t normal_location = 1, tangent_location = 2;
/// How many times the depth range casters are looked for in front of it, where clamping lets them cast from there.
constexpr float clamped_reach = 1e4F;

/// What tells pipelines apart.
struct Variant {
    bool is_skinned = false, is_morphed = false, is_masked = false, is_mirrored = false, is_double_sided = false;
    friend auto operator<=>(const Variant&, const Variant&) = default;
};

Variant variant_of(const scene::Snapshot& snapshot, const DrawList& list, const Batch& batch) {
    const scene::ModelMaterial& surface = snapshot.materials[batch.material].surface;
    return {.is_skinned = batch.is_skinned,
            .is_morphed = snapshot.instances[list.order[batch.first]].weight_count > 0,
            .is_masked = surface.blend == scene::SurfaceBlend::Mask,
            .is_mirrored = batch.is_mirrored && !surface.is_double_sided,
            .is_double_sided = surface.is_double_sided};
}

/// A view of an array even where it has a single layer, as the shader's sampler wants it.
Result<> view_as_array(gpu::Context& context, gpu::Image& image) {
    if (image.info.array_layers > 1) return {};
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image.handle,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                     .format = image.info.format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    VkImageView view = VK_NULL_HANDLE;
    Result<> made = context.check(context.vk.CreateImageView(context.device, &info, context.allocator, &view),
                                  fmt::format("creating a view of the image \"{}\"", image.info.name));
    if (!made) return made;
    context.vk.DestroyImageView(context.device, image.view, context.allocator);
    image.view = view;
    return {};
}

Result<gpu::Image> create_map(gpu::Context& context, std::string name, std::uint32_t size, std::uint32_t layers,
                              VkImageUsageFlags usage) {
    Result<gpu::Image> image = gpu::Image::create(context, {.name = std::move(name),
                                                            .format = map_format,
                                                            .extent = {size, size, 1},
                                                            .array_layers = layers,
                                                            .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT});
    if (!image) return image;
    if (Result<> viewed = view_as_array(context, *image); !viewed) return failure(std::move(viewed));
    return image;
}

/// One texel that no light is stopped by.
Result<gpu::Image> create_lit_map(gpu::Context& context) {
    Result<gpu::Image> image = create_map(context, "no shadow", 1, 1, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    if (!image) return image;
    Result<> cleared = gpu::submit_and_wait(context, "clearing the empty shadow map", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, *image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkClearDepthStencilValue lit{.depth = 1};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        context.vk.CmdClearDepthStencilImage(commands, image->handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &lit, 1,
                                             &range);
        gpu::transition(context, commands, *image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    if (!cleared) return failure(std::move(cleared));
    return image;
}

Result<VkSampler> create_sampler(gpu::Context& context) {
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_NEAREST,
                                   .minFilter = VK_FILTER_NEAREST,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .maxLod = VK_LOD_CLAMP_NONE,
                                   .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE};
    VkSampler sampler = VK_NULL_HANDLE;
    Result<> made = context.check(context.vk.CreateSampler(context.device, &info, context.allocator, &sampler),
                                  "creating the sampler of shadow maps");
    if (!made) return failure(std::move(made));
    return sampler;
}

/// The matrix with its near plane moved toward the light.
scene::mat4 reaching_matrix(scene::mat4 world_to_cascade) {
    for (int column = 0; column < 4; ++column) {
        const float w = world_to_cascade[column][3];
        world_to_cascade[column][2] = (world_to_cascade[column][2] + clamped_reach * w) / (1 + clamped_reach);
    }
    return world_to_cascade;
}

CascadeScene cascade_scene(const scene::Snapshot& snapshot, bool has_depth_clamp) {
    CascadeScene out{.bounds = {}, .holds_casters = !has_depth_clamp};
    for (const scene::Instance& instance : snapshot.instances)
        if (!instance.is_wireframe && !instance.bounds.is_empty()) out.bounds.add(instance.bounds);
    return out;
}

VkImageMemoryBarrier2 map_barrier(const gpu::Image& map) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = map.handle,
            .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, map.info.array_layers}};
}

constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 reading_stages =
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

void record_barriers(const gpu::Context& context, VkCommandBuffer commands,
                     std::span<const VkImageMemoryBarrier2> barriers) {
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size()),
                                      .pImageMemoryBarriers = barriers.data()};
    context.vk.CmdPipelineBarrier2(commands, &dependency);
}

/// What recording a list needs.
struct Recording {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkDescriptorSet frame_set = VK_NULL_HANDLE;
    const scene::Snapshot* snapshot = nullptr;
    GpuScene* scene = nullptr;
    std::uint32_t cascade = 0;  ///< as in ShadowBlock
};

}  // namespace

struct ShadowPass::State {
    gpu::Context* context = nullptr;
    VkDescriptorSetLayout frame_layout = VK_NULL_HANDLE, material_layout = VK_NULL_HANDLE;
    CascadeDesc desc;
    std::uint32_t most_lights = 0;
    std::vector<gpu::Image> maps;  ///< of the lights that have cast so far
    gpu::Image lit_map;
    VkSampler sampler = VK_NULL_HANDLE;
    std::map<Variant, gpu::Pipeline> pipelines;
    std::optional<Error> error;  ///< of a map or a pipeline
    std::vector<Cascades> cascades;
    std::vector<DrawList> lists;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (sampler != VK_NULL_HANDLE) context->vk.DestroySampler(context->device, sampler, context->allocator);
    }

    [[nodiscard]] Result<gpu::Pipeline> create_pipeline(const Variant& variant) const {
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
            .sets = {frame_layout},
            .push_constant_size = sizeof(std::uint32_t),
            .depth = map_format,
            .cull = static_cast<VkCullModeFlags>(variant.is_double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT),
            .front = variant.is_mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE,
            .depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL,
            .clamps_depth = context->traits.has_depth_clamp,
            .depth_bias_slope = bias_slope};
        if (variant.is_masked) pipeline.sets.push_back(material_layout);
        // has_textures, is_skinned, is_morphed; see the shaders.
        pipeline.specialization.assign(12, 0);
        pipeline.specialization[0] = 1;
        pipeline.specialization[10] = variant.is_skinned ? 1 : 0;
        pipeline.specialization[11] = variant.is_morphed ? 1 : 0;
        return gpu::Pipeline::create(*context, pipeline);
    }

    void require_map(std::size_t light) {
        if (error || light < maps.size()) return;
        Result<gpu::Image> map =
            create_map(*context, fmt::format("shadow map {}", light), desc.resolution, desc.count,
                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        if (!map) {
            error = std::move(map).error();
            return;
        }
        maps.push_back(std::move(*map));
    }

    void require_pipeline(const Variant& variant) {
        if (error || pipelines.contains(variant)) return;
        Result<gpu::Pipeline> made = create_pipeline(variant);
        if (!made) {
            error = std::move(made).error();
            return;
        }
        pipelines.emplace(variant, std::move(*made));
    }

    void require_pipelines(const scene::Snapshot& snapshot, const DrawList& list) {
        for (const std::vector<Batch>* batches : {&list.opaque, &list.transparent})
            for (const Batch& batch : *batches) require_pipeline(variant_of(snapshot, list, batch));
    }

    Result<> record_batch(const Recording& recording, const DrawList& list, const Batch& batch,
                          std::uint32_t first_instance) const {
        const Variant variant = variant_of(*recording.snapshot, list, batch);
        const auto found = pipelines.find(variant);
        DARKROOM_ASSERT(found != pipelines.end());
        const gpu::Pipeline& pipeline = found->second;
        const VkCommandBuffer commands = recording.commands;
        std::array sets{recording.frame_set, recording.frame_set};
        if (variant.is_masked) {
            Result<VkDescriptorSet> textures = recording.scene->textures(recording.snapshot->materials[batch.material]);
            if (!textures) return failure(std::move(textures));
            sets[1] = *textures;
        }
        context->vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
        context->vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0,
                                          variant.is_masked ? 2 : 1, sets.data(), 0, nullptr);
        context->vk.CmdPushConstants(commands, pipeline.layout,
                                     VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                     sizeof recording.cascade, &recording.cascade);
        recording.scene->draw(commands, batch.mesh, first_instance + batch.first, batch.count);
        return {};
    }

    Result<> record_list(const Recording& recording, const DrawList& list, std::uint32_t first_instance) const {
        for (const std::vector<Batch>* batches : {&list.opaque, &list.transparent}) {
            for (const Batch& batch : *batches) {
                Result<> recorded = record_batch(recording, list, batch, first_instance);
                if (!recorded) return recorded;
            }
        }
        return {};
    }

    void begin_rendering(VkCommandBuffer commands, VkImageView layer) const {
        const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = layer,
                                              .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                              .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                              .clearValue = {.depthStencil = {.depth = 1}}};
        const VkRect2D area{.extent = {desc.resolution, desc.resolution}};
        const VkRenderingInfo info{
            .sType = VK_STRUCTURE_TYPE_RENDERING_INFO, .renderArea = area, .layerCount = 1, .pDepthAttachment = &depth};
        const auto side = static_cast<float>(desc.resolution);
        const VkViewport viewport{.width = side, .height = side, .maxDepth = 1};
        context->vk.CmdBeginRendering(commands, &info);
        context->vk.CmdSetViewport(commands, 0, 1, &viewport);
        context->vk.CmdSetScissor(commands, 0, 1, &area);
    }

    /// What earlier frames read is read; their depths are not needed.
    void begin_writing(VkCommandBuffer commands) const {
        std::vector<VkImageMemoryBarrier2> barriers;
        for (std::size_t light = 0; light < cascades.size(); ++light) {
            VkImageMemoryBarrier2& barrier = barriers.emplace_back(map_barrier(maps[light]));
            barrier.srcStageMask = reading_stages;
            barrier.dstStageMask = depth_stages;
            barrier.dstAccessMask =
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
            barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
            barrier.newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        }
        record_barriers(*context, commands, barriers);
    }

    void begin_reading(VkCommandBuffer commands) const {
        std::vector<VkImageMemoryBarrier2> barriers;
        for (std::size_t light = 0; light < cascades.size(); ++light) {
            VkImageMemoryBarrier2& barrier = barriers.emplace_back(map_barrier(maps[light]));
            barrier.srcStageMask = depth_stages;
            barrier.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
            barrier.dstStageMask = reading_stages;
            barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
            barrier.oldLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
            barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        }
        record_barriers(*context, commands, barriers);
    }
};

std::vector<std::uint32_t> lights_with_shadows(const scene::Snapshot& snapshot) {
    std::vector<std::uint32_t> places;
    std::uint32_t directional = 0;
    for (std::uint32_t i = 0; i < snapshot.lights.size() && directional < most_directional_lights; ++i) {
        const scene::Light& light = snapshot.lights[i].light;
        if (light.type != scene::LightType::Directional) continue;
        ++directional;
        if (light.casts_shadow && light.intensity > 0) places.push_back(i);
    }
    return places;
}

Result<ShadowPass> ShadowPass::create(gpu::Context& context, VkDescriptorSetLayout frame_layout, GpuScene& scene,
                                      const CascadeDesc& desc, std::uint32_t lights) {
    DARKROOM_ASSERT(lights <= most_directional_lights);
    if (desc.count < 1 || desc.count > most_cascades)
        return user_error(fmt::format("shadow cascades: {}, [1, {}] are allowed", desc.count, most_cascades));
    const std::uint32_t most = context.traits.max_image_dimension;
    if (desc.resolution < 1 || desc.resolution > most)
        return user_error(
            fmt::format("shadow resolution: {}, [1, {}] are allowed on this device", desc.resolution, most));

    ShadowPass pass;
    pass.state_ = std::make_shared<State>();
    State& state = *pass.state_;
    state.context = &context;
    state.frame_layout = frame_layout;
    state.material_layout = scene.material_layout.handle;
    state.desc = desc;
    state.most_lights = lights;
    Result<gpu::Image> lit_map = create_lit_map(context);
    if (!lit_map) return failure(std::move(lit_map));
    state.lit_map = std::move(*lit_map);
    Result<VkSampler> sampler = create_sampler(context);
    if (!sampler) return failure(std::move(sampler));
    state.sampler = *sampler;
    return pass;
}

void ShadowPass::clear() {
    state_->error.reset();
    state_->cascades.clear();
    state_->lists.clear();
}

void ShadowPass::prepare(const scene::Snapshot& snapshot) {
    clear();
    State& state = *state_;
    const bool has_depth_clamp = state.context->traits.has_depth_clamp;
    const CascadeScene fitted = cascade_scene(snapshot, has_depth_clamp);
    for (const std::uint32_t place : lights_with_shadows(snapshot)) {
        if (state.cascades.size() == state.most_lights) break;
        state.require_map(state.cascades.size());
        if (state.error) return;
        const Cascades& cascades = state.cascades.emplace_back(
            fit_cascades(snapshot.camera, snapshot.lights[place].direction, state.desc, fitted));
        for (std::uint32_t i = 0; i < cascades.count; ++i) {
            const scene::mat4& matrix = cascades.world_to_cascade[i];
            const DrawList& list =
                state.lists.emplace_back(caster_list(snapshot, has_depth_clamp ? reaching_matrix(matrix) : matrix));
            state.require_pipelines(snapshot, list);
        }
    }
}

Result<> ShadowPass::make_pipelines(const scene::Snapshot& snapshot) {
    if (state_->most_lights == 0) return {};
    state_->error.reset();
    // Nothing lies outside the planes of a matrix of zeros.
    state_->require_pipelines(snapshot, caster_list(snapshot, scene::mat4(0)));
    return state_->error ? failure(*state_->error) : Result<>();
}

std::span<const DrawList> ShadowPass::caster_lists() const { return state_->lists; }

Result<> ShadowPass::record(VkCommandBuffer commands, VkDescriptorSet frame_set, const scene::Snapshot& snapshot,
                            GpuScene& scene, std::uint32_t first_instance) const {
    const State& state = *state_;
    if (state.error) return failure(*state.error);
    if (state.cascades.empty()) return {};
    const gpu::Context& context = *state.context;
    gpu::begin_label(context, commands, "shadows");
    state.begin_writing(commands);
    Result<> recorded;
    for (std::uint32_t i = 0; i < state.lists.size() && recorded; ++i) {
        const std::uint32_t light = i / state.desc.count, cascade = i % state.desc.count;
        const gpu::Image& map = state.maps[light];
        state.begin_rendering(commands, map.layer_views.empty() ? map.mip_views[0] : map.layer_views[cascade]);
        recorded = state.record_list({.commands = commands,
                                      .frame_set = frame_set,
                                      .snapshot = &snapshot,
                                      .scene = &scene,
                                      .cascade = light * most_cascades + cascade},
                                     state.lists[i], first_instance);
        context.vk.CmdEndRendering(commands);
        first_instance += static_cast<std::uint32_t>(state.lists[i].order.size());
    }
    state.begin_reading(commands);
    gpu::end_label(context, commands);
    return recorded;
}

std::uint32_t ShadowPass::casting_lights() const { return static_cast<std::uint32_t>(state_->cascades.size()); }

const Cascades& ShadowPass::cascades(std::uint32_t light) const {
    DARKROOM_ASSERT(light < casting_lights());
    return state_->cascades[light];
}

const gpu::Image& ShadowPass::map(std::uint32_t light) const {
    return light < casting_lights() ? state_->maps[light] : state_->lit_map;
}

VkSampler ShadowPass::sampler() const { return state_->sampler; }

void ShadowPass::fill(blocks::Shadows& block) const {
    block = {};
    const CascadeDesc& desc = state_->desc;
    const auto resolution = static_cast<float>(desc.resolution);
    block.shadow_settings = {static_cast<float>(desc.count), resolution, 1 / resolution, desc.far_distance};
    for (std::uint32_t light = 0; light < casting_lights(); ++light) {
        const Cascades& cascades = state_->cascades[light];
        for (std::uint32_t i = 0; i < cascades.count; ++i) {
            block.world_to_cascade[light * most_cascades + i] = cascades.world_to_cascade[i];
            block.cascade_splits[light][static_cast<int>(i)] = cascades.splits[i];
            block.cascade_texels[light][static_cast<int>(i)] = cascades.texel[i];
        }
    }
}

}  // namespace darkroom::render
