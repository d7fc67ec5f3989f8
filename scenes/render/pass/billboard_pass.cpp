// SPDX-License-Identifier: MIT
#include "render/pass/billboard_pass.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"
#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

using scene::no_index;
using scene::vec3;
using scene::vec4;

constexpr std::uint32_t vertices_a_square = 6;

/// One instance, as shaders/sprite/billboard_vertex.glsl takes it.
struct Square {
    vec3 position{0};
    float width = 0;
    vec3 previous_position{0};
    float height = 0;
    vec4 tint{1};
    vec4 uv{0, 0, 1, 1};
    float anchor_y = 0;
    float is_disc = 0;
    float covers = 1;  ///< 0: is added to what is behind it
};

enum class Kind : std::uint8_t { Sprite, Particle };

/// Squares that one call draws: of one kind, with one texture.
struct Run {
    Kind kind = Kind::Sprite;
    VkDescriptorSet texture = VK_NULL_HANDLE;
    std::uint32_t first = 0, count = 0;
};

/// A square before it is sorted.
struct Pending {
    Kind kind = Kind::Sprite;
    std::uint32_t image = no_index;
    float distance = 0;  ///< along the view axis
    Square square;
};

struct Slot {
    gpu::Buffer squares;
    std::size_t capacity = 0;  ///< squares
    std::vector<Run> runs;     ///< sprites first
};

std::vector<VkVertexInputAttributeDescription> square_attributes() {
    return {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Square, position)},
            {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Square, previous_position)},
            {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Square, tint)},
            {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Square, uv)},
            {4, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Square, anchor_y)}};
}

gpu::PipelineDesc pipeline_desc(Kind kind, const PassSetup& setup, const GpuScene& scene) {
    gpu::PipelineDesc desc{.vertex = shader_text("sprite/billboard_vertex.glsl"),
                           .bindings = {{0, sizeof(Square), VK_VERTEX_INPUT_RATE_INSTANCE}},
                           .attributes = square_attributes(),
                           .sets = {setup.frame_layout, scene.billboard_layout.handle},
                           .depth = setup.formats.depth,
                           .samples = setup.formats.samples};
    if (kind == Kind::Sprite) {
        gpu::ColorTarget opaque;
        if (setup.formats.has_alpha_layer) opaque.writes = color_without_alpha;
        desc.name = "sprites";
        desc.fragment = shader_text("sprite/sprite_fragment.glsl");
        desc.colors = setup.formats.colors(opaque, TargetFormats::Layers::Written);
        return desc;
    }
    // Light that alpha has weighed: so one pipeline, in one order, both covers and adds.
    const gpu::ColorTarget blended{.is_blended = true,
                                   .source = VK_BLEND_FACTOR_ONE,
                                   .destination = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                   .writes = color_without_alpha};
    desc.name = "particles";
    desc.fragment = shader_text("sprite/particle_fragment.glsl");
    desc.colors = setup.formats.colors(blended, TargetFormats::Layers::Kept);
    desc.writes_depth = false;
    return desc;
}

std::vector<Pending> gather(const scene::Snapshot& snapshot) {
    std::vector<Pending> out;
    for (const scene::SpriteState& sprite : snapshot.sprites)
        out.push_back({.image = sprite.image,
                       .square = {.position = sprite.position,
                                  .width = sprite.size.x,
                                  .previous_position = sprite.previous_position,
                                  .height = sprite.size.y,
                                  .tint = vec4(vec3(sprite.intensity), 1),
                                  .uv = sprite.uv,
                                  .anchor_y = sprite.anchor_y}});
    for (const scene::ParticleState& emitter : snapshot.emitters)
        for (const scene::Particle& particle : emitter.particles)
            out.push_back({.kind = Kind::Particle,
                           .image = emitter.image,
                           .square = {.position = particle.position,
                                      .width = particle.size,
                                      .previous_position = particle.previous_position,
                                      .height = particle.size,
                                      .tint = particle.color,
                                      .uv = particle.uv,
                                      .anchor_y = 0.5F,
                                      .is_disc = emitter.image == no_index ? 1.0F : 0.0F,
                                      .covers = emitter.blend == scene::SurfaceBlend::Additive ? 0.0F : 1.0F}});
    const vec4 depth_row(snapshot.camera.view[0].z, snapshot.camera.view[1].z, snapshot.camera.view[2].z,
                         snapshot.camera.view[3].z);
    for (Pending& pending : out) pending.distance = -glm::dot(depth_row, vec4(pending.square.position, 1));
    return out;
}

/// Sprites, which hide each other: by texture, so that they need few calls, and the nearest first. Then particles, the
/// farthest first whatever their blending is: smoke covers what glows behind it.
bool is_drawn_before(const Pending& a, const Pending& b) {
    const bool is_sprite = a.kind == Kind::Sprite;
    if (is_sprite != (b.kind == Kind::Sprite)) return is_sprite;
    if (!is_sprite) return a.distance > b.distance;
    return a.image != b.image ? a.image < b.image : a.distance < b.distance;
}

void sort(std::vector<Pending>& list) {
    std::ranges::stable_sort(list, is_drawn_before);
    // Among those that are added, with nothing between them that covers, the order does not show: by texture.
    const auto covers = [](const Pending& pending) { return pending.square.covers > 0; };
    for (auto first = std::ranges::find_if_not(list, covers); first != list.end();) {
        const auto last = std::find_if(first, list.end(), covers);
        std::ranges::stable_sort(first, last, {}, &Pending::image);
        first = std::find_if_not(last, list.end(), covers);
    }
}

}  // namespace

struct BillboardPass::State {
    gpu::Context* context = nullptr;
    std::array<gpu::Pipeline, 2> pipelines;  ///< by Kind
    std::vector<Slot> slots;

    void record(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot, bool are_sprites) const;
};

Result<BillboardPass> BillboardPass::create(gpu::Context& context, const PassSetup& setup, GpuScene& scene) {
    BillboardPass pass;
    pass.state_ = std::make_shared<State>();
    pass.state_->context = &context;
    for (const Kind kind : {Kind::Sprite, Kind::Particle}) {
        DARKROOM_TRY_VALUE(gpu::Pipeline made, gpu::Pipeline::create(context, pipeline_desc(kind, setup, scene)));
        pass.state_->pipelines[static_cast<std::size_t>(kind)] = std::move(made);
    }
    return pass;
}

Result<> BillboardPass::prepare(const scene::Snapshot& snapshot, GpuScene& scene, std::uint32_t slot) {
    if (slot >= state_->slots.size()) state_->slots.resize(slot + 1);
    Slot& own = state_->slots[slot];
    own.runs.clear();
    std::vector<Pending> list = gather(snapshot);
    if (list.empty()) return {};
    sort(list);

    if (own.capacity < list.size()) {
        const std::size_t capacity = list.size() + list.size() / 2;
        DARKROOM_TRY_VALUE(own.squares, gpu::Buffer::create(*state_->context, capacity * sizeof(Square),
                                                            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                                            gpu::Memory::Kind::Upload, "billboards"));
        own.capacity = capacity;
    }
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        const Pending& pending = list[i];
        std::memcpy(own.squares.memory.mapped + i * sizeof(Square), &pending.square, sizeof(Square));
        if (i > 0 && list[i - 1].kind == pending.kind && list[i - 1].image == pending.image) {
            ++own.runs.back().count;
            continue;
        }
        DARKROOM_TRY_VALUE(VkDescriptorSet texture, scene.texture(pending.image, pending.kind == Kind::Sprite));
        own.runs.push_back({.kind = pending.kind, .texture = texture, .first = i, .count = 1});
    }
    return {};
}

void BillboardPass::State::record(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot,
                                  bool are_sprites) const {
    if (slot >= slots.size()) return;
    const gpu::Dispatch& vk = context->vk;
    const gpu::Pipeline* bound = nullptr;
    for (const Run& run : slots[slot].runs) {
        if ((run.kind == Kind::Sprite) != are_sprites) continue;
        const gpu::Pipeline& pipeline = pipelines[static_cast<std::size_t>(run.kind)];
        if (bound != &pipeline) {
            constexpr VkDeviceSize offset = 0;
            vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
            vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0, 1, &frame_set, 0,
                                     nullptr);
            vk.CmdBindVertexBuffers(commands, 0, 1, &slots[slot].squares.handle, &offset);
            bound = &pipeline;
        }
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 1, 1, &run.texture, 0,
                                 nullptr);
        vk.CmdDraw(commands, vertices_a_square, run.count, 0, run.first);
    }
}

void BillboardPass::record_sprites(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot) const {
    state_->record(commands, frame_set, slot, true);
}

void BillboardPass::record_particles(VkCommandBuffer commands, VkDescriptorSet frame_set, std::uint32_t slot) const {
    state_->record(commands, frame_set, slot, false);
}

}  // namespace darkroom::render
