// SPDX-License-Identifier: MIT
#pragma once
// Draws lists of casters into shadow maps of every kind, depth alone: the pipelines for it, one for each kind of
// surface that casts, made when it is first needed. The map, its viewport and its rendering instance are the caller's.

#include <map>

#include "render/frame_set.hpp"
#include "render/pass/draw_list.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

inline constexpr VkFormat shadow_map_format = VK_FORMAT_D32_SFLOAT;

/// What becomes of casters before the near plane: they cast as if they stood on it, or not at all.
enum class NearCasters : std::uint8_t { Flattened, LeftOut };

class Casters {
  public:
    struct Recording {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkDescriptorSet frame_set = VK_NULL_HANDLE;
        const scene::Snapshot* snapshot = nullptr;
        GpuScene* scene = nullptr;
        NearCasters near_casters = NearCasters::Flattened;
        std::uint32_t map = 0;  ///< number of its matrix in ShadowBlock
    };

    Casters() = default;
    Casters(gpu::Context& context, VkDescriptorSetLayout frame_layout, VkDescriptorSetLayout material_layout);
    /// Makes the pipelines that recording the list needs and that there are not yet.
    Result<> require(const scene::Snapshot& snapshot, const DrawList& list, NearCasters near_casters);
    Result<> record(const Recording& recording, const DrawList& list, std::uint32_t first_instance) const;

  private:
    /// What tells pipelines apart.
    struct Variant {
        bool is_skinned = false, is_morphed = false, is_masked = false, is_mirrored = false, is_double_sided = false;
        NearCasters near_casters = NearCasters::Flattened;
        friend auto operator<=>(const Variant&, const Variant&) = default;
    };
    [[nodiscard]] static Variant variant_of(const scene::Snapshot& snapshot, const DrawList& list, const Batch& batch,
                                            NearCasters near_casters);
    [[nodiscard]] Result<gpu::Pipeline> create_pipeline(const Variant& variant) const;
    Result<> record_batch(const Recording& recording, const DrawList& list, const Batch& batch,
                          std::uint32_t first_instance) const;

    gpu::Context* context_ = nullptr;
    VkDescriptorSetLayout frame_layout_ = VK_NULL_HANDLE, material_layout_ = VK_NULL_HANDLE;
    std::map<Variant, gpu::Pipeline> pipelines_;
};

}  // namespace darkroom::render
