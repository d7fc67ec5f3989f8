// SPDX-License-Identifier: MIT
#include "render/shadow/shadow_pass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/assert.hpp"
#include "gpu/resource/barriers.hpp"
#include "gpu/resource/resources.hpp"
#include "render/shadow/casters.hpp"

namespace darkroom::render {

namespace {

// The images that shadow maps are, how they are read, and what keeps drawing into them and reading them apart.

/// A view of an array even where it has a single layer, as the shader's sampler wants it.
Result<> view_as_array(gpu::Context& context, gpu::Image& image) {
    if (image.info.array_layers > 1) return {};
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image.handle,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                                     .format = image.info.format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    // No exception comes between the view and its owner.
    const std::string what = fmt::format("creating a view of the image \"{}\"", image.info.name);
    VkImageView view = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateImageView(context.device, &info, context.allocator, &view), what));
    context.vk.DestroyImageView(context.device, image.view, context.allocator);
    image.view = view;
    return {};
}

Result<gpu::Image> create_map(gpu::Context& context, std::string name, VkExtent2D extent, std::uint32_t layers,
                              VkImageUsageFlags usage) {
    DARKROOM_TRY_VALUE(gpu::Image image, gpu::Image::create(context, {.name = std::move(name),
                                                                      .format = shadow_map_format,
                                                                      .extent = {extent.width, extent.height, 1},
                                                                      .array_layers = layers,
                                                                      .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT}));
    DARKROOM_TRY(view_as_array(context, image));
    return image;
}

constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 reading_stages =
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

constexpr gpu::Use written{
    depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};

void change(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps,
            const gpu::Use& before, const gpu::Use& after) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const gpu::Image* map : maps) barriers.push_back(gpu::image_barrier(*map, before, after));
    gpu::record_barriers(context.vk, commands, barriers);
}

/// Viewed as an array, also where it has a single layer, as the shader's sampler wants it.
Result<gpu::Image> create_shadow_map(gpu::Context& context, std::string name, VkExtent2D extent, std::uint32_t layers) {
    return create_map(context, std::move(name), extent, layers,
                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

/// One texel that no light is stopped by, ready to be read.
Result<gpu::Image> create_lit_map(gpu::Context& context) {
    DARKROOM_TRY_VALUE(gpu::Image image, create_map(context, "no shadow", {1, 1}, 1, VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    Result<> cleared = gpu::submit_and_wait(context, "clearing the empty shadow map", [&](VkCommandBuffer commands) {
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkClearDepthStencilValue lit{.depth = 1};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        context.vk.CmdClearDepthStencilImage(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &lit, 1,
                                             &range);
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    if (!cleared) return failure(std::move(cleared));
    return image;
}

/// Of single texels; beyond the edge is light.
Result<VkSampler> create_shadow_sampler(gpu::Context& context) {
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_NEAREST,
                                   .minFilter = VK_FILTER_NEAREST,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .maxLod = VK_LOD_CLAMP_NONE,
                                   .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE};
    VkSampler sampler = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateSampler(context.device, &info, context.allocator, &sampler),
                               "creating the sampler of shadow maps"));
    return sampler;
}

/// What earlier frames read is read; their depths are not needed.
void begin_writing(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps) {
    change(context, commands, maps, {reading_stages}, written);
}

/// For fragment and compute shaders.
void begin_reading(const gpu::Context& context, VkCommandBuffer commands, std::span<const gpu::Image* const> maps) {
    change(context, commands, maps, written,
           {reading_stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

/// How many times the depth range casters are looked for in front of it, where clamping lets them cast from there.
constexpr float clamped_reach = 1e4F;

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

}  // namespace

struct ShadowPass::State {
    gpu::Context* context = nullptr;
    CascadeDesc desc;
    ShadowNeeds most;
    std::vector<gpu::Image> maps;  ///< of the lights that have cast so far
    gpu::Image atlas;              ///< of lamps, once one has cast
    gpu::Image lit_map;
    VkSampler sampler = VK_NULL_HANDLE;
    Casters casters;
    std::optional<Error> error;  ///< of a map or a pipeline
    std::vector<Cascades> cascades;
    LampShadows lamps;
    std::vector<DrawList> lists;  ///< of cascades, then of tiles

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (sampler != VK_NULL_HANDLE) context->vk.DestroySampler(context->device, sampler, context->allocator);
    }

    [[nodiscard]] std::uint32_t side() const { return tile_side(desc.resolution); }

    void require_map(std::size_t light) {
        if (error || light < maps.size()) return;
        Result<gpu::Image> map = create_shadow_map(*context, fmt::format("shadow map {}", light),
                                                   {desc.resolution, desc.resolution}, desc.count);
        if (!map) {
            error = std::move(map).error();
            return;
        }
        maps.push_back(std::move(*map));
    }

    /// For as many tiles as there may ever be: frames that are still drawn read it.
    void require_atlas() {
        if (error || atlas.handle != VK_NULL_HANDLE) return;
        const std::uint32_t rows = (most.tiles + tiles_a_row - 1) / tiles_a_row;
        Result<gpu::Image> made = create_shadow_map(*context, "shadow maps of lamps",
                                                    {std::min(most.tiles, tiles_a_row) * side(), rows * side()}, 1);
        if (made) {
            atlas = std::move(*made);
        } else {
            error = std::move(made).error();
        }
    }

    void require_pipelines(const scene::Snapshot& snapshot, const DrawList& list, NearCasters near_casters) {
        if (error) return;
        if (Result<> made = casters.require(snapshot, list, near_casters); !made) error = std::move(made).error();
    }

    void prepare_lamps(const scene::Snapshot& snapshot) {
        if (most.tiles == 0 || error) return;
        lamps = choose_lamps(snapshot, side());
        if (lamps.lamps.empty()) return;
        require_atlas();
        for (const LampTiles& lamp : lamps.lamps) {
            const scene::LightState& light = snapshot.lights[lamp.light];
            const Reach reach{.center = light.position, .radius = light.light.range};
            for (std::uint32_t i = 0; i < lamp.count; ++i) {
                const DrawList& list =
                    lists.emplace_back(caster_list(snapshot, lamps.world_to_tile[lamp.first + i], reach));
                require_pipelines(snapshot, list, NearCasters::LeftOut);
            }
        }
    }

    [[nodiscard]] std::vector<const gpu::Image*> written() const {
        std::vector<const gpu::Image*> out;
        for (std::size_t i = 0; i < cascades.size(); ++i) out.push_back(&maps[i]);
        if (!lamps.lamps.empty()) out.push_back(&atlas);
        return out;
    }

    // With one colour attachment, of no image: where a pipeline is bound that has none at all, Mesa's software driver
    // (lavapipe 25) forgets until the end of the command buffer that each attachment is blended and masked by itself,
    // and transparent draws would overwrite normals and velocity.
    void begin_rendering(VkCommandBuffer commands, VkImageView layer, VkExtent2D extent) const {
        const VkRenderingAttachmentInfo no_color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = layer,
                                              .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                              .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                              .clearValue = {.depthStencil = {.depth = 1}}};
        const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                   .renderArea = {.extent = extent},
                                   .layerCount = 1,
                                   .colorAttachmentCount = 1,
                                   .pColorAttachments = &no_color,
                                   .pDepthAttachment = &depth};
        context->vk.CmdBeginRendering(commands, &info);
    }

    /// Of a rendering instance: the square that is drawn into.
    void set_area(VkCommandBuffer commands, VkOffset2D offset, std::uint32_t texels) const {
        const auto size = static_cast<float>(texels);
        const VkViewport viewport{.x = static_cast<float>(offset.x),
                                  .y = static_cast<float>(offset.y),
                                  .width = size,
                                  .height = size,
                                  .maxDepth = 1};
        const VkRect2D area{offset, {texels, texels}};
        context->vk.CmdSetViewport(commands, 0, 1, &viewport);
        context->vk.CmdSetScissor(commands, 0, 1, &area);
    }

    /// All cascades of a light after those of the light before it.
    Result<> record_cascades(Casters::Recording recording, std::uint32_t& first_instance) const {
        Result<> recorded;
        for (std::uint32_t i = 0; i < cascades.size() * desc.count && recorded; ++i) {
            const std::uint32_t light = i / desc.count, cascade = i % desc.count;
            const gpu::Image& map = maps[light];
            begin_rendering(recording.commands, map.layer_views.empty() ? map.mip_views[0] : map.layer_views[cascade],
                            {desc.resolution, desc.resolution});
            set_area(recording.commands, {}, desc.resolution);
            recording.map = light * max_cascades + cascade;
            recorded = casters.record(recording, lists[i], first_instance);
            context->vk.CmdEndRendering(recording.commands);
            first_instance += static_cast<std::uint32_t>(lists[i].order.size());
        }
        return recorded;
    }

    Result<> record_lamps(Casters::Recording recording, std::uint32_t first_instance) const {
        if (lamps.lamps.empty()) return {};
        recording.near_casters = NearCasters::LeftOut;
        const VkExtent3D extent = atlas.info.extent;
        begin_rendering(recording.commands, atlas.mip_views[0], {extent.width, extent.height});
        Result<> recorded;
        for (std::uint32_t tile = 0; tile < lamps.world_to_tile.size() && recorded; ++tile) {
            const DrawList& list = lists[cascades.size() * desc.count + tile];
            set_area(recording.commands,
                     {static_cast<std::int32_t>(tile % tiles_a_row * side()),
                      static_cast<std::int32_t>(tile / tiles_a_row * side())},
                     side());
            recording.map = first_tile + tile;
            recorded = casters.record(recording, list, first_instance);
            first_instance += static_cast<std::uint32_t>(list.order.size());
        }
        context->vk.CmdEndRendering(recording.commands);
        return recorded;
    }
};

std::vector<std::uint32_t> lights_with_shadows(const scene::Snapshot& snapshot) {
    std::vector<std::uint32_t> places;
    std::uint32_t directional = 0;
    for (std::uint32_t i = 0; i < snapshot.lights.size() && directional < max_directional_lights; ++i) {
        const scene::Light& light = snapshot.lights[i].light;
        if (light.type != scene::LightType::Directional) continue;
        ++directional;
        if (light.casts_shadow && light.intensity > 0) places.push_back(i);
    }
    return places;
}

Result<ShadowPass> ShadowPass::create(gpu::Context& context, VkDescriptorSetLayout frame_layout, GpuScene& scene,
                                      const CascadeDesc& desc, const ShadowNeeds& max_needs) {
    DARKROOM_ASSERT(max_needs.lights <= max_directional_lights && max_needs.tiles <= max_tiles);
    if (desc.count < 1 || desc.count > max_cascades)
        return user_error(fmt::format("shadow cascades: {}, [1, {}] are allowed", desc.count, max_cascades));
    const std::uint32_t most = context.traits.max_image_dimension;
    if (desc.resolution < 1 || desc.resolution > most)
        return user_error(
            fmt::format("shadow resolution: {}, [1, {}] are allowed on this device", desc.resolution, most));

    ShadowPass pass;
    pass.state_ = std::make_shared<State>();
    State& state = *pass.state_;
    state.context = &context;
    state.casters = Casters(context, frame_layout, scene.material_layout.handle);
    state.desc = desc;
    state.most = max_needs;
    DARKROOM_TRY_VALUE(state.lit_map, create_lit_map(context));
    DARKROOM_TRY_VALUE(state.sampler, create_shadow_sampler(context));
    return pass;
}

void ShadowPass::clear() {
    state_->error.reset();
    state_->cascades.clear();
    state_->lamps = {};
    state_->lists.clear();
}

Result<> ShadowPass::prepare(const scene::Snapshot& snapshot) {
    clear();
    State& state = *state_;
    const bool has_depth_clamp = state.context->traits.has_depth_clamp;
    const CascadeScene fitted = cascade_scene(snapshot, has_depth_clamp);
    for (const std::uint32_t place : lights_with_shadows(snapshot)) {
        if (state.cascades.size() == state.most.lights) break;
        state.require_map(state.cascades.size());
        if (state.error) return failure(*state.error);
        const Cascades& cascades = state.cascades.emplace_back(
            fit_cascades(snapshot.camera, snapshot.lights[place].direction, state.desc, fitted));
        for (std::uint32_t i = 0; i < cascades.count; ++i) {
            const scene::mat4& matrix = cascades.world_to_cascade[i];
            const DrawList& list =
                state.lists.emplace_back(caster_list(snapshot, has_depth_clamp ? reaching_matrix(matrix) : matrix));
            state.require_pipelines(snapshot, list, NearCasters::Flattened);
        }
    }
    state.prepare_lamps(snapshot);
    return state.error ? failure(*state.error) : Result<>();
}

Result<> ShadowPass::make_pipelines(const scene::Snapshot& snapshot) {
    state_->error.reset();
    // Nothing lies outside the planes of a matrix of zeros.
    const DrawList all = caster_list(snapshot, scene::mat4(0));
    if (state_->most.lights > 0) state_->require_pipelines(snapshot, all, NearCasters::Flattened);
    if (state_->most.tiles > 0) state_->require_pipelines(snapshot, all, NearCasters::LeftOut);
    return state_->error ? failure(*state_->error) : Result<>();
}

std::span<const DrawList> ShadowPass::caster_lists() const { return state_->lists; }

Result<> ShadowPass::record(VkCommandBuffer commands, VkDescriptorSet frame_set, const scene::Snapshot& snapshot,
                            GpuScene& scene, std::uint32_t first_instance) const {
    const State& state = *state_;
    if (state.error) return failure(*state.error);
    if (state.lists.empty()) return {};
    const gpu::Context& context = *state.context;
    const std::vector<const gpu::Image*> maps = state.written();
    const Casters::Recording recording{
        .commands = commands, .frame_set = frame_set, .snapshot = &snapshot, .scene = &scene};
    gpu::begin_label(context, commands, "shadows");
    begin_writing(context, commands, maps);
    Result<> recorded = state.record_cascades(recording, first_instance);
    if (recorded) recorded = state.record_lamps(recording, first_instance);
    begin_reading(context, commands, maps);
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

std::span<const LampTiles> ShadowPass::lamps() const { return state_->lamps.lamps; }

const gpu::Image& ShadowPass::atlas() const { return state_->lamps.lamps.empty() ? state_->lit_map : state_->atlas; }

VkSampler ShadowPass::sampler() const { return state_->sampler; }

void ShadowPass::fill(blocks::Shadows& block) const {
    block = {};
    const CascadeDesc& desc = state_->desc;
    const auto resolution = static_cast<float>(desc.resolution);
    block.shadow_settings = {static_cast<float>(desc.count), resolution, 1 / resolution, desc.far_distance};
    for (std::uint32_t light = 0; light < casting_lights(); ++light) {
        const Cascades& cascades = state_->cascades[light];
        for (std::uint32_t i = 0; i < cascades.count; ++i) {
            block.world_to_map[light * max_cascades + i] = cascades.world_to_cascade[i];
            block.cascade_splits[light][static_cast<int>(i)] = cascades.splits[i];
            block.cascade_texels[light][static_cast<int>(i)] = cascades.texel[i];
        }
    }
    if (state_->lamps.lamps.empty()) return;
    const VkExtent3D atlas = state_->atlas.info.extent;
    block.tile_settings = {static_cast<float>(state_->side()), static_cast<float>(tiles_a_row),
                           1 / static_cast<float>(atlas.width), 1 / static_cast<float>(atlas.height)};
    std::ranges::copy(state_->lamps.world_to_tile, std::begin(block.world_to_map) + first_tile);
}

}  // namespace darkroom::render
