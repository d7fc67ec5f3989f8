// SPDX-License-Identifier: MIT
#pragma once
// Shadow maps. Cascades of the directional lights that cast, brightest first: one depth image a light, a layer a
// cascade; they stay readable by effects after the frame (darkroom::Light::cascades). Lamps share one image of tiles.

#include <memory>
#include <span>
#include <vector>

#include "render/frame_set.hpp"
#include "render/pass/draw_list.hpp"
#include "render/shadow/cascades.hpp"
#include "render/shadow/lamps.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

/// Places in Snapshot::lights of those that have shadow maps, in the order of the maps: directional lights among the
/// first max_directional_lights that cast and shine.
[[nodiscard]] std::vector<std::uint32_t> lights_with_shadows(const scene::Snapshot& snapshot);

/// How many directional lights, [0, 4], and how many tiles of lamps, [0, max_tiles], there will be at most: no memory
/// is spent on others.
struct ShadowNeeds {
    std::uint32_t lights = 0, tiles = 0;
};

class ShadowPass {
  public:
    /// Errors: a resolution that the device lacks, VkResult.
    [[nodiscard]] static Result<ShadowPass> create(gpu::Context& context, VkDescriptorSetLayout frame_layout,
                                                   GpuScene& scene, const CascadeDesc& desc,
                                                   const ShadowNeeds& max_needs);

    /// Fits the cascades and tiles of the snapshot's casting lights and lists their casters. Before the frame's buffers
    /// are filled: the instances of all lists go into the frame's instance buffer, one list after the other. Pipelines
    /// are made when casters first need them, maps when lights do. Where that failed, record() says so, too.
    [[nodiscard]] Result<> prepare(const scene::Snapshot& snapshot);
    /// Makes the pipelines of all that the snapshot holds, wherever it is.
    Result<> make_pipelines(const scene::Snapshot& snapshot);
    /// Instead of prepare(): no light casts.
    void clear();
    /// One a cascade, the cascades of the first light first, then one a tile.
    [[nodiscard]] std::span<const DrawList> caster_lists() const;
    /// `first_instance`: of the first list. Outside rendering; leaves every map of a casting light in
    /// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL for fragment and compute shaders.
    Result<> record(VkCommandBuffer commands, VkDescriptorSet frame_set, const scene::Snapshot& snapshot,
                    GpuScene& scene, std::uint32_t first_instance) const;

    [[nodiscard]] std::uint32_t casting_lights() const;  ///< of the last prepare
    [[nodiscard]] const Cascades& cascades(std::uint32_t light) const;
    [[nodiscard]] const gpu::Image& map(std::uint32_t light) const;  ///< a 1x1 lit one beyond the casting lights
    [[nodiscard]] std::span<const LampTiles> lamps() const;          ///< of the last prepare
    [[nodiscard]] const gpu::Image& atlas() const;                   ///< of lamps' tiles; a 1x1 lit one without any
    [[nodiscard]] VkSampler sampler() const;                         ///< of single texels; beyond the edge is light
    void fill(blocks::Shadows& block) const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace darkroom::render
