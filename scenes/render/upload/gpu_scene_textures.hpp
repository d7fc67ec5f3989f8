// SPDX-License-Identifier: MIT
#pragma once
// The textures of a scene on the device, by which image and which use: base colour and emissive decode sRGB, the others
// are linear, so an image that is used both ways is there twice. Also the samplers, by wrap and filter.

#include <deque>
#include <map>
#include <tuple>

#include "render/upload/upload.hpp"
#include "scene/assets.hpp"

namespace darkroom::render {

enum class Transfer : std::uint8_t { Linear, Srgb };

/// `model` no_index: of Assets::images.
struct TextureKey {
    std::uint32_t model = scene::no_index, image = scene::no_index;
    Transfer transfer = Transfer::Linear;
    friend auto operator<=>(const TextureKey&, const TextureKey&) = default;
};

class GpuTextures {
  public:
    explicit GpuTextures(gpu::Context& context) : context_(&context) {}
    GpuTextures(const GpuTextures&) = delete;
    GpuTextures& operator=(const GpuTextures&) = delete;
    ~GpuTextures();

    /// Everything that the materials of the assets and its entities may use.
    Result<> create(const scene::Assets& assets, Uploader& uploader);

    static constexpr std::size_t white = 0, flat_normal = 1;
    /// A number for view(); `otherwise` where there is no such texture, because its image is missing or broken.
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

}  // namespace darkroom::render
