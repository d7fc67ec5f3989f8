// SPDX-License-Identifier: MIT
#include "render/upload/gpu_scene.hpp"

#include <cstddef>
#include <map>

#include "core/assert.hpp"
#include "render/frame_buffers.hpp"
#include "render/upload/gpu_scene_sets.hpp"
#include "render/upload/gpu_scene_textures.hpp"
#include "render/upload/upload.hpp"

namespace darkroom::render {

namespace {

using scene::no_index;
using scene::vec2;
using scene::vec3;
using scene::vec4;

/// Everything that goes into the shared buffers, one mesh after the other.
struct Geometry {
    std::vector<scene::Vertex> vertices;
    std::vector<scene::VertexSkin> skins;
    std::vector<std::uint32_t> indices;
    std::vector<vec4> morph_deltas;

    GpuMesh add(const scene::Primitive& primitive);
};

GpuMesh Geometry::add(const scene::Primitive& primitive) {
    GpuMesh mesh{.first_index = static_cast<std::uint32_t>(indices.size()),
                 .index_count = static_cast<std::uint32_t>(primitive.indices.size()),
                 .first_vertex = static_cast<std::int32_t>(vertices.size()),
                 .vertex_count = static_cast<std::uint32_t>(primitive.vertices.size()),
                 .morph_targets = static_cast<std::uint32_t>(primitive.targets.size())};
    vertices.insert(vertices.end(), primitive.vertices.begin(), primitive.vertices.end());
    indices.insert(indices.end(), primitive.indices.begin(), primitive.indices.end());
    if (!primitive.skin.empty()) {
        mesh.first_skin = static_cast<std::uint32_t>(skins.size());
        skins.insert(skins.end(), primitive.skin.begin(), primitive.skin.end());
    }
    if (!primitive.targets.empty()) mesh.first_morph_delta = static_cast<std::uint32_t>(morph_deltas.size());
    for (const scene::MorphTarget& target : primitive.targets) {
        for (std::size_t i = 0; i < primitive.vertices.size(); ++i) {
            morph_deltas.emplace_back(i < target.positions.size() ? target.positions[i] : vec3(0), 0);
            morph_deltas.emplace_back(i < target.normals.size() ? target.normals[i] : vec3(0), 0);
        }
    }
    return mesh;
}

/// (0,0,0)-(1,1,1), front faces counter-clockwise seen from outside, the texture upright on the four sides.
scene::Primitive unit_box() {
    struct Face {
        vec3 normal, right, up;
    };
    constexpr std::array faces{
        Face{vec3(1, 0, 0), vec3(0, 0, -1), vec3(0, 1, 0)}, Face{vec3(-1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0)},
        Face{vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, -1)}, Face{vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 0, 1)},
        Face{vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0)},  Face{vec3(0, 0, -1), vec3(-1, 0, 0), vec3(0, 1, 0)}};
    scene::Primitive box;
    for (const Face& face : faces) {
        const auto first = static_cast<std::uint32_t>(box.vertices.size());
        for (const vec2& uv : {vec2(0, 1), vec2(1, 1), vec2(1, 0), vec2(0, 0)}) {
            const vec3 offset = face.normal + face.right * (2 * uv.x - 1) + face.up * (1 - 2 * uv.y);
            box.vertices.push_back(
                {.position = vec3(0.5F) + 0.5F * offset, .normal = face.normal, .uv0 = uv, .uv1 = uv});
        }
        for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) box.indices.push_back(first + corner);
    }
    return box;
}

/// Ends of the twelve edges of unit_box(), by its vertices: +z face 16..19, -z face 20..23.
constexpr std::array<std::uint32_t, 24> box_edge_indices{16, 17, 17, 18, 18, 19, 19, 16, 20, 21, 21, 22,
                                                         22, 23, 23, 20, 16, 21, 17, 20, 18, 23, 19, 22};

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace

MeshInput mesh_input(bool is_skinned, VkVertexInputRate rate) {
    using scene::Vertex;
    using scene::VertexSkin;
    // A mesh without a skin reads the same element for every vertex.
    const std::uint32_t skin_stride = is_skinned ? sizeof(VertexSkin) : 0;
    return {.bindings = {{0, sizeof(Vertex), rate}, {1, skin_stride, rate}},
            .attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                           {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                           {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)},
                           {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv0)},
                           {4, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv1)},
                           {5, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(Vertex, color)},
                           {6, 1, VK_FORMAT_R16G16B16A16_UINT, offsetof(VertexSkin, joints)},
                           {7, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(VertexSkin, weights)}}};
}

struct GpuScene::State {
    explicit State(gpu::Context& owner) : context(owner), textures(owner), sets(owner, set_sizes, 64) {}

    gpu::Context& context;
    GpuTextures textures;
    /// Of one set; a billboard's needs one of them.
    static constexpr std::array set_sizes{
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, scene::material_textures}};
    SetAllocator sets;
    std::map<scene::MeshId, GpuMesh> meshes;
    GpuMesh box_edges;
    struct Slot {
        std::size_t texture = GpuTextures::white;
        VkSampler sampler = VK_NULL_HANDLE;
        friend auto operator<=>(const Slot&, const Slot&) = default;
    };
    std::map<std::vector<Slot>, VkDescriptorSet> made_sets;

    Geometry gather(const scene::Assets& assets);
    void draw(VkCommandBuffer commands, const GpuScene& scene, const GpuMesh& mesh, std::uint32_t first_instance,
              std::uint32_t instances) const;
    Result<Slot> slot(const scene::Texture& texture, const TextureKey& key, std::size_t otherwise);
    Result<VkDescriptorSet> set(const std::vector<Slot>& slots, VkDescriptorSetLayout layout);
};

Geometry GpuScene::State::gather(const scene::Assets& assets) {
    Geometry geometry;
    const GpuMesh box = geometry.add(unit_box());
    meshes.emplace(scene::MeshId{}, box);
    box_edges = box;
    box_edges.first_index = static_cast<std::uint32_t>(geometry.indices.size());
    box_edges.index_count = static_cast<std::uint32_t>(box_edge_indices.size());
    geometry.indices.insert(geometry.indices.end(), box_edge_indices.begin(), box_edge_indices.end());
    for (std::uint32_t model = 0; model < assets.models.size(); ++model) {
        const std::vector<scene::Mesh>& list = assets.models[model].meshes;
        for (std::uint32_t mesh = 0; mesh < list.size(); ++mesh) {
            for (std::uint32_t primitive = 0; primitive < list[mesh].primitives.size(); ++primitive)
                meshes.emplace(scene::MeshId{model, mesh, primitive}, geometry.add(list[mesh].primitives[primitive]));
        }
    }
    return geometry;
}

Result<GpuScene::State::Slot> GpuScene::State::slot(const scene::Texture& texture, const TextureKey& key,
                                                    std::size_t otherwise) {
    const std::size_t found = textures.find(key, otherwise);
    // Constant textures need no sampler of their own: it would only make more sets.
    const bool is_constant = found <= GpuTextures::flat_normal;
    const scene::Texture use = is_constant ? scene::Texture{} : texture;
    DARKROOM_TRY_VALUE(VkSampler sampler, textures.sampler(use.wrap_u, use.wrap_v, use.is_nearest));
    return Slot{found, sampler};
}

Result<VkDescriptorSet> GpuScene::State::set(const std::vector<Slot>& slots, VkDescriptorSetLayout layout) {
    if (const auto found = made_sets.find(slots); found != made_sets.end()) return found->second;
    DARKROOM_TRY_VALUE(VkDescriptorSet made, sets.allocate(layout));
    std::array<VkDescriptorImageInfo, scene::material_textures> images{};
    std::array<VkWriteDescriptorSet, scene::material_textures> writes{};
    for (std::uint32_t i = 0; i < slots.size(); ++i) {
        images[i] = {.sampler = slots[i].sampler,
                     .imageView = textures.view(slots[i].texture),
                     .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .dstSet = made,
                     .dstBinding = i,
                     .descriptorCount = 1,
                     .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                     .pImageInfo = &images[i]};
    }
    context.vk.UpdateDescriptorSets(context.device, static_cast<std::uint32_t>(slots.size()), writes.data(), 0,
                                    nullptr);
    made_sets.emplace(slots, made);
    return made;
}

Result<GpuScene> GpuScene::create(gpu::Context& context, const scene::Assets& assets) {
    GpuScene out;
    out.state_ = std::make_shared<State>(context);
    std::array<gpu::SetLayout::Binding, scene::material_textures> bindings{};
    for (gpu::SetLayout::Binding& binding : bindings) binding.stages = VK_SHADER_STAGE_FRAGMENT_BIT;
    DARKROOM_TRY_VALUE(out.material_layout, gpu::SetLayout::create(context, bindings));
    DARKROOM_TRY_VALUE(out.billboard_layout, gpu::SetLayout::create(context, {bindings.data(), 1}));

    const Geometry geometry = out.state_->gather(assets);
    Uploader uploader(context);
    struct Part {
        gpu::Buffer& buffer;
        std::span<const std::byte> bytes;
        VkBufferUsageFlags usage;
        std::size_t least_size;
        const char* name;
    };
    const std::array parts{
        Part{out.vertices, bytes_of(geometry.vertices), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, 0, "vertices of the scene"},
        Part{out.skins, bytes_of(geometry.skins), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, sizeof(scene::VertexSkin),
             "joints of vertices"},
        Part{out.indices, bytes_of(geometry.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT, 0, "indices of the scene"},
        Part{out.morph_deltas, bytes_of(geometry.morph_deltas), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, sizeof(vec4),
             "morph targets"}};
    const VkDeviceSize deltas = geometry.morph_deltas.size() * sizeof(vec4);
    DARKROOM_TRY(check_storage(context, deltas, "morph targets"));
    for (const Part& part : parts) {
        DARKROOM_TRY_VALUE(part.buffer, uploader.buffer(part.bytes, part.usage, part.least_size, part.name));
    }
    DARKROOM_TRY(out.state_->textures.create(assets, uploader));
    DARKROOM_TRY(uploader.flush());
    return out;
}

const GpuMesh& GpuScene::mesh(const scene::MeshId& id) const {
    const auto found = state_->meshes.find(id.model == no_index ? scene::MeshId{} : id);
    DARKROOM_ASSERT(found != state_->meshes.end());
    return found->second;
}

void GpuScene::bind_vertices(VkCommandBuffer commands, const GpuMesh& mesh) const {
    const std::array buffers{vertices.handle, skins.handle};
    const VkDeviceSize first_skin = mesh.first_skin == no_index ? 0 : mesh.first_skin;
    const std::array<VkDeviceSize, 2> offsets{static_cast<VkDeviceSize>(mesh.first_vertex) * sizeof(scene::Vertex),
                                              first_skin * sizeof(scene::VertexSkin)};
    state_->context.vk.CmdBindVertexBuffers(commands, 0, 2, buffers.data(), offsets.data());
}

void GpuScene::State::draw(VkCommandBuffer commands, const GpuScene& scene, const GpuMesh& mesh,
                           std::uint32_t first_instance, std::uint32_t instances) const {
    scene.bind_vertices(commands, mesh);
    context.vk.CmdBindIndexBuffer(commands, scene.indices.handle, 0, VK_INDEX_TYPE_UINT32);
    context.vk.CmdDrawIndexed(commands, mesh.index_count, instances, mesh.first_index, 0, first_instance);
}

void GpuScene::draw(VkCommandBuffer commands, const scene::MeshId& id, std::uint32_t first_instance,
                    std::uint32_t instances) const {
    state_->draw(commands, *this, mesh(id), first_instance, instances);
}

void GpuScene::draw_box_edges(VkCommandBuffer commands, std::uint32_t first_instance, std::uint32_t instances) const {
    state_->draw(commands, *this, state_->box_edges, first_instance, instances);
}

Result<VkDescriptorSet> GpuScene::textures(const scene::SnapshotMaterial& material) {
    std::vector<State::Slot> slots;
    for (const auto& [texture, is_srgb, is_normal] : scene::textures_of(material.surface)) {
        TextureKey key{material.model, texture->image, is_srgb ? Transfer::Srgb : Transfer::Linear};
        if (slots.empty() && material.entity_texture != no_index)
            key = {no_index, material.entity_texture, Transfer::Srgb};
        DARKROOM_TRY_VALUE(State::Slot slot,
                           state_->slot(*texture, key, is_normal ? GpuTextures::flat_normal : GpuTextures::white));
        slots.push_back(slot);
    }
    return state_->set(slots, material_layout.handle);
}

Result<VkDescriptorSet> GpuScene::texture(std::uint32_t image) {
    const scene::Texture clamped{.wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp};
    DARKROOM_TRY_VALUE(State::Slot slot, state_->slot(clamped, {no_index, image, Transfer::Srgb}, GpuTextures::white));
    return state_->set({slot}, billboard_layout.handle);
}

}  // namespace darkroom::render
