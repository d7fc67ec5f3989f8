// SPDX-License-Identifier: MIT
#include "render/upload/gpu_scene_textures.hpp"

#include <map>
#include <optional>
#include <set>
#include <thread>

#include "core/thread/parallel.hpp"
#include "render/upload/upload_mips.hpp"

namespace darkroom::render {

namespace {

constexpr float max_anisotropy = 8;

std::set<TextureKey> used_textures(const scene::Assets& assets) {
    std::set<TextureKey> keys;
    for (std::uint32_t model = 0; model < assets.models.size(); ++model) {
        for (const scene::ModelMaterial& material : assets.models[model].materials) {
            for (const auto& [texture, is_srgb, is_normal] : scene::textures_of(material))
                keys.insert({model, texture->image, is_srgb ? Transfer::Srgb : Transfer::Linear});
        }
    }
    for (std::uint32_t image = 0; image < assets.images.size(); ++image)
        keys.insert({scene::no_index, image, Transfer::Srgb});
    return keys;
}

/// For textures that mask a surface: the smallest cutoff of the materials that use it.
std::map<TextureKey, float> alpha_cutoffs(const scene::Assets& assets) {
    std::map<TextureKey, float> cutoffs;
    for (std::uint32_t model = 0; model < assets.models.size(); ++model)
        for (const scene::ModelMaterial& material : assets.models[model].materials) {
            if (material.blend != scene::SurfaceBlend::Mask) continue;
            const TextureKey key{model, material.base_color_texture.image, Transfer::Srgb};
            const float cutoff = std::max(material.alpha_cutoff, 1.0F / 255);
            const auto [found, is_new] = cutoffs.emplace(key, cutoff);
            if (!is_new) found->second = std::min(found->second, cutoff);
        }
    return cutoffs;
}

const scene::Image* image_of(const scene::Assets& assets, const TextureKey& key) {
    const std::vector<scene::Image>& images =
        key.model == scene::no_index ? assets.images : assets.models[key.model].images;
    if (key.image >= images.size() || images[key.image].is_empty()) return nullptr;
    return &images[key.image];
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

/// A picture's levels; those of 8 bits are without level 0, which is the picture.
struct Chain {
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    std::vector<MipLevel> levels;
    std::vector<WideMipLevel> wide;
};

Chain chain_of(const gpu::Context& context, const scene::Image& image, bool is_srgb, std::optional<float> cutoff) {
    if (image.kind == scene::ImageKind::Codes8)
        return {.format = is_srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                .levels = mip_levels(image.width, image.height, image.rgba, is_srgb, cutoff),
                .wide = {}};
    // Every device filters halves.
    const bool as_codes =
        image.kind == scene::ImageKind::Codes16 && !is_srgb && is_filtered(context, VK_FORMAT_R16G16B16A16_UNORM);
    return {.format = as_codes ? VK_FORMAT_R16G16B16A16_UNORM : VK_FORMAT_R16G16B16A16_SFLOAT,
            .levels = {},
            .wide = wide_mip_levels(image, is_srgb, as_codes, cutoff)};
}

}  // namespace

GpuTextures::~GpuTextures() {
    for (const auto& [key, sampler] : samplers_)
        context_->vk.DestroySampler(context_->device, sampler, context_->allocator);
}

Result<> GpuTextures::create(const scene::Assets& assets, Uploader& uploader) {
    DARKROOM_TRY(create_constant({255, 255, 255, 255}, uploader, "white"));
    DARKROOM_TRY(create_constant({128, 128, 255, 255}, uploader, "flat normal"));
    std::vector<TextureKey> keys;
    for (const TextureKey& key : used_textures(assets))
        if (image_of(assets, key) != nullptr) keys.push_back(key);
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
    const std::map<TextureKey, float> cutoffs = alpha_cutoffs(assets);
    std::vector<Chain> chains(keys.size());
    parallel_for(keys.size(), 0, [&](std::size_t i) {
        const auto cutoff = cutoffs.find(keys[i]);
        chains[i] = chain_of(*context_, *image_of(assets, keys[i]), keys[i].transfer == Transfer::Srgb,
                             cutoff == cutoffs.end() ? std::nullopt : std::optional(cutoff->second));
    });
    const std::uint32_t limit = context_->traits.max_image_dimension;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const scene::Image& image = *image_of(assets, keys[i]);
        std::vector<Uploader::Level> levels;
        // What is too large for the device is shown by its first level that is not.
        const auto add = [&](std::uint32_t width, std::uint32_t height, std::span<const std::byte> bytes) {
            if (width <= limit && height <= limit) levels.push_back({width, height, bytes});
        };
        if (!image.rgba.empty()) add(image.width, image.height, std::as_bytes(std::span(image.rgba)));
        for (const MipLevel& level : chains[i].levels)
            add(level.width, level.height, std::as_bytes(std::span(level.rgba)));
        for (const WideMipLevel& level : chains[i].wide)
            add(level.width, level.height, std::as_bytes(std::span(level.rgba)));
        numbers_.emplace(keys[i], images_.size());
        DARKROOM_TRY(uploader.image(images_.emplace_back(), chains[i].format, levels, image.name));
    }
    return {};
}

std::size_t GpuTextures::find(const TextureKey& key, std::size_t otherwise) const {
    const auto found = numbers_.find(key);
    return found == numbers_.end() ? otherwise : found->second;
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

}  // namespace darkroom::render
