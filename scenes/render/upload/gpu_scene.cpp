// SPDX-License-Identifier: MIT
#include "render/upload/gpu_scene.hpp"

#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <thread>
#include <tuple>

#include "core/assert.hpp"
#include "core/thread/parallel.hpp"
#include "render/frame_buffers.hpp"
#include "render/upload/upload.hpp"
#include "scene/assets.hpp"

namespace darkroom::render {

namespace {

// The textures of a scene on the device, by which image and which use: base colour and emissive decode sRGB, the others
// are linear, and alpha is ignored, weighs colour or cuts it out, so an image that is used in two ways is there twice.
// Also the samplers, by wrap and filter.

enum class Transfer : std::uint8_t { Linear, Srgb };

/// `model` no_index: of Assets::images.
struct TextureKey {
    std::uint32_t model = scene::no_index, image = scene::no_index;
    Transfer transfer = Transfer::Linear;
    AlphaUse alpha{};
    friend auto operator<=>(const TextureKey&, const TextureKey&) = default;
};

class GpuTextures {
  public:
    explicit GpuTextures(gpu::Context& context) : context_(&context) {}
    GpuTextures(const GpuTextures&) = delete;
    GpuTextures& operator=(const GpuTextures&) = delete;
    ~GpuTextures();

    /// Everything that the materials of the assets and its entities may use.
    Result<> create(const scene::Assets& assets, std::span<const scene::SnapshotMaterial> materials,
                    Uploader& uploader);

    static constexpr std::size_t white = 0, flat_normal = 1;
    /// A number for view(), of another use of alpha where this one is not there, as for pictures without holes;
    /// `otherwise` where there is no such texture, because its image is missing or broken.
    [[nodiscard]] std::size_t find(const TextureKey& key, std::size_t otherwise) const;
    [[nodiscard]] VkImageView view(std::size_t texture) const { return images_[texture].view; }
    [[nodiscard]] Result<VkSampler> sampler(scene::Wrap wrap_u, scene::Wrap wrap_v, bool is_nearest);

  private:
    Result<> create_constant(std::array<std::uint8_t, 4> rgba, Uploader& uploader, std::string_view name);
    Result<> create_textures(const scene::Assets& assets, std::span<const TextureKey> keys, Uploader& uploader);

    gpu::Context* context_;
    std::deque<gpu::Image> images_;  ///< stay where they are
    std::map<TextureKey, std::size_t> numbers_;
    std::map<std::tuple<scene::Wrap, scene::Wrap, bool>, VkSampler> samplers_;
};

constexpr float max_anisotropy = 8;

/// Sprites are cut out as shaders/sprite/sprite_fragment.glsl does it.
constexpr AlphaUse sprite_alpha{.weighs = true, .cutoff = 0.5F}, particle_alpha{.weighs = true};

/// Of the texture of base colour.
AlphaUse alpha_use(const scene::SnapshotMaterial& material) {
    const scene::SurfaceBlend blend = material.surface.blend;
    if (blend == scene::SurfaceBlend::Alpha || blend == scene::SurfaceBlend::Additive) return {.weighs = true};
    const float cutoff = texture_cutoff(material);
    return {.weighs = cutoff > 0, .cutoff = cutoff};
}

TextureKey key_of(const scene::SnapshotMaterial& material, std::size_t number, const scene::TextureUse& use) {
    TextureKey key{.model = material.model,
                   .image = use.texture->image,
                   .transfer = use.is_srgb ? Transfer::Srgb : Transfer::Linear};
    if (number > 0) return key;
    if (material.entity_texture != scene::no_index)
        key = {.image = material.entity_texture, .transfer = Transfer::Srgb};
    key.alpha = alpha_use(material);
    return key;
}

const scene::Image* image_of(const scene::Assets& assets, const TextureKey& key) {
    const std::vector<scene::Image>& images =
        key.model == scene::no_index ? assets.images : assets.models[key.model].images;
    if (key.image >= images.size() || images[key.image].is_empty()) return nullptr;
    return &images[key.image];
}

bool has_holes(const scene::Image& image) {
    const auto any_below = [](const auto& samples, auto opaque) {
        for (std::size_t i = 3; i < samples.size(); i += 4)
            if (samples[i] < opaque) return true;
        return false;
    };
    if (image.kind == scene::ImageKind::Codes8) return any_below(image.rgba, std::uint8_t{255});
    return any_below(image.wide, image.kind == scene::ImageKind::Halves ? std::uint16_t{0x3c00} : std::uint16_t{65535});
}

std::set<TextureKey> used_textures(const scene::Assets& assets, std::span<const scene::SnapshotMaterial> materials) {
    std::set<TextureKey> keys;
    const auto add = [&](TextureKey key) {
        const scene::Image* const image = image_of(assets, key);
        if (image == nullptr) return;
        if (key.alpha.weighs && !has_holes(*image)) key.alpha = {};
        keys.insert(key);
    };
    const auto add_material = [&](const scene::SnapshotMaterial& material) {
        std::size_t number = 0;
        for (const scene::TextureUse& use : scene::textures_of(material.surface)) add(key_of(material, number++, use));
    };
    for (const scene::SnapshotMaterial& material : materials) add_material(material);
    for (std::uint32_t model = 0; model < assets.models.size(); ++model)
        for (const scene::ModelMaterial& surface : assets.models[model].materials)
            add_material({.surface = surface, .model = model});
    for (const scene::EntityAssets& entity : assets.entities)
        add({.image = entity.sprite_texture, .transfer = Transfer::Srgb, .alpha = sprite_alpha});
    for (std::uint32_t image = 0; image < assets.images.size(); ++image)
        add({.image = image, .transfer = Transfer::Srgb, .alpha = particle_alpha});
    return keys;
}

VkSamplerAddressMode address_mode(scene::Wrap wrap) {
    switch (wrap) {
        case scene::Wrap::Repeat:
            return VK_SAMPLER_ADDRESS_MODE_REPEAT;
        case scene::Wrap::Mirror:
            return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case scene::Wrap::Clamp:
            break;
    }
    return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

/// The library enables anisotropy wherever it makes the device; of an adopted one it does not know.
bool has_anisotropy(const gpu::Context& context) {
    if (!context.is_owner || context.traits.is_software) return false;
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    context.vk.GetPhysicalDeviceFeatures2(context.physical_device, &features);
    return features.features.samplerAnisotropy == VK_TRUE;
}

bool is_filtered(const gpu::Context& context, VkFormat format) {
    VkFormatProperties properties{};
    context.vk.GetPhysicalDeviceFormatProperties(context.physical_device, format, &properties);
    return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

/// A picture's levels; those of 8 bits are without level 0 where that is the picture.
struct Chain {
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    std::vector<MipLevel> levels;
    std::vector<WideMipLevel> wide;
};

Chain chain_of(const gpu::Context& context, const scene::Image& image, bool is_srgb, AlphaUse alpha) {
    if (image.kind == scene::ImageKind::Codes8)
        return {.format = is_srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                .levels = mip_levels(image.width, image.height, image.rgba, is_srgb, alpha),
                .wide = {}};
    // Every device filters halves.
    const bool as_codes =
        image.kind == scene::ImageKind::Codes16 && !is_srgb && is_filtered(context, VK_FORMAT_R16G16B16A16_UNORM);
    return {.format = as_codes ? VK_FORMAT_R16G16B16A16_UNORM : VK_FORMAT_R16G16B16A16_SFLOAT,
            .levels = {},
            .wide = wide_mip_levels(image, is_srgb, as_codes, alpha)};
}

GpuTextures::~GpuTextures() {
    for (const auto& [key, sampler] : samplers_)
        context_->vk.DestroySampler(context_->device, sampler, context_->allocator);
}

Result<> GpuTextures::create(const scene::Assets& assets, std::span<const scene::SnapshotMaterial> materials,
                             Uploader& uploader) {
    DARKROOM_TRY(create_constant({255, 255, 255, 255}, uploader, "white"));
    DARKROOM_TRY(create_constant({128, 128, 255, 255}, uploader, "flat normal"));
    const std::set<TextureKey> used = used_textures(assets, materials);
    const std::vector<TextureKey> keys(used.begin(), used.end());
    // A few at a time: the chains of a whole scene need not be in memory together.
    const std::size_t group = 2 * std::max(1U, std::thread::hardware_concurrency());
    for (std::size_t first = 0; first < keys.size(); first += group) {
        const std::span<const TextureKey> some(keys.data() + first, std::min(group, keys.size() - first));
        DARKROOM_TRY(create_textures(assets, some, uploader));
    }
    return {};
}

Result<> GpuTextures::create_constant(std::array<std::uint8_t, 4> rgba, Uploader& uploader, std::string_view name) {
    const Uploader::Level level{.width = 1, .height = 1, .bytes = std::as_bytes(std::span(rgba))};
    return uploader.image(images_.emplace_back(), VK_FORMAT_R8G8B8A8_UNORM, {&level, 1}, name);
}

Result<> GpuTextures::create_textures(const scene::Assets& assets, std::span<const TextureKey> keys,
                                      Uploader& uploader) {
    std::vector<Chain> chains(keys.size());
    parallel_for(keys.size(), 0, [&](std::size_t i) {
        chains[i] = chain_of(*context_, *image_of(assets, keys[i]), keys[i].transfer == Transfer::Srgb, keys[i].alpha);
    });
    const std::uint32_t limit = context_->traits.max_image_dimension;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const scene::Image& image = *image_of(assets, keys[i]);
        std::vector<Uploader::Level> levels;
        // What is too large for the device is shown by its first level that is not.
        const auto add = [&](std::uint32_t width, std::uint32_t height, std::span<const std::byte> bytes) {
            if (width <= limit && height <= limit) levels.push_back({width, height, bytes});
        };
        const std::vector<MipLevel>& made = chains[i].levels;
        const bool has_first = !made.empty() && made[0].width == image.width && made[0].height == image.height;
        if (!image.rgba.empty() && !has_first) add(image.width, image.height, std::as_bytes(std::span(image.rgba)));
        for (const MipLevel& level : made) add(level.width, level.height, std::as_bytes(std::span(level.rgba)));
        for (const WideMipLevel& level : chains[i].wide)
            add(level.width, level.height, std::as_bytes(std::span(level.rgba)));
        numbers_.emplace(keys[i], images_.size());
        DARKROOM_TRY(uploader.image(images_.emplace_back(), chains[i].format, levels, image.name));
    }
    return {};
}

std::size_t GpuTextures::find(const TextureKey& key, std::size_t otherwise) const {
    auto found = numbers_.find(key);
    if (found == numbers_.end()) found = numbers_.lower_bound({key.model, key.image, key.transfer, {}});
    const bool is_it = found != numbers_.end() && found->first.model == key.model && found->first.image == key.image &&
                       found->first.transfer == key.transfer;
    return is_it ? found->second : otherwise;
}

Result<VkSampler> GpuTextures::sampler(scene::Wrap wrap_u, scene::Wrap wrap_v, bool is_nearest) {
    const auto key = std::make_tuple(wrap_u, wrap_v, is_nearest);
    if (const auto found = samplers_.find(key); found != samplers_.end()) return found->second;
    const VkFilter filter = is_nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    const bool is_anisotropic = !is_nearest && has_anisotropy(*context_);
    const VkSamplerCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = filter,
        .minFilter = filter,
        .mipmapMode = is_nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR,
        .addressModeU = address_mode(wrap_u),
        .addressModeV = address_mode(wrap_v),
        .addressModeW = address_mode(wrap_u),
        .anisotropyEnable = is_anisotropic ? VK_TRUE : VK_FALSE,
        .maxAnisotropy = is_anisotropic ? max_anisotropy : 1,
        .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler = VK_NULL_HANDLE;
    DARKROOM_TRY(context_->check(context_->vk.CreateSampler(context_->device, &info, context_->allocator, &sampler),
                                 "creating a sampler of the scene"));
    samplers_.emplace(key, sampler);
    return sampler;
}

}  // namespace

float texture_cutoff(const scene::SnapshotMaterial& material) {
    const float factor = material.surface.base_color.w * material.opacity, cutoff = material.surface.alpha_cutoff;
    const bool is_cut_out = material.surface.blend == scene::SurfaceBlend::Mask && cutoff > 0 && cutoff <= factor;
    return is_cut_out ? cutoff / factor : 0;
}

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
                           {5, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, color)},
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

Result<GpuScene> GpuScene::create(gpu::Context& context, const scene::Assets& assets,
                                  std::span<const scene::SnapshotMaterial> materials) {
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
    DARKROOM_TRY(out.state_->textures.create(assets, materials, uploader));
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
    for (const scene::TextureUse& use : scene::textures_of(material.surface)) {
        DARKROOM_TRY_VALUE(State::Slot slot,
                           state_->slot(*use.texture, key_of(material, slots.size(), use),
                                        use.is_normal ? GpuTextures::flat_normal : GpuTextures::white));
        slots.push_back(slot);
    }
    return state_->set(slots, material_layout.handle);
}

Result<VkDescriptorSet> GpuScene::texture(std::uint32_t image, bool is_cut_out) {
    const scene::Texture clamped{.wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp};
    const TextureKey key{no_index, image, Transfer::Srgb, is_cut_out ? sprite_alpha : particle_alpha};
    DARKROOM_TRY_VALUE(State::Slot slot, state_->slot(clamped, key, GpuTextures::white));
    return state_->set({slot}, billboard_layout.handle);
}

}  // namespace darkroom::render
