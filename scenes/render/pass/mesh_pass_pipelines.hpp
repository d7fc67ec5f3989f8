// SPDX-License-Identifier: MIT
#pragma once
// The pipelines of MeshPass, one for each combination of what a pipeline fixes, made when it is first asked for.

#include <map>

#include "render/frame_set.hpp"
#include "scene/model.hpp"

namespace darkroom::render {

enum class MeshKind : std::uint8_t {
    Surface,
    Edges,         ///< of triangles, instead of surfaces
    RoomEdges,     ///< of a room's box
    Overlay,       ///< edges of triangles over the picture
    NormalArrows,  ///< a line a vertex
};

struct MeshVariant {
    MeshKind kind = MeshKind::Surface;
    bool is_debug_view = false;
    bool is_skinned = false, is_morphed = false;
    // Of surfaces:
    bool is_mirrored = false, is_double_sided = false, writes_alpha_only = false, has_textures = false;
    scene::SurfaceBlend blend = scene::SurfaceBlend::Opaque;
    std::uint32_t layers = 0;  ///< shader_layers()
    friend auto operator<=>(const MeshVariant&, const MeshVariant&) = default;
};

class MeshPipelines {
  public:
    void create(gpu::Context& context, const PassSetup& setup, VkDescriptorSetLayout textures);
    [[nodiscard]] Result<const gpu::Pipeline*> find(const MeshVariant& variant);

  private:
    [[nodiscard]] gpu::PipelineDesc describe(const MeshVariant& variant) const;
    void describe_surface(gpu::PipelineDesc& desc, const MeshVariant& variant) const;
    void describe_lines(gpu::PipelineDesc& desc, const MeshVariant& variant) const;

    gpu::Context* context_ = nullptr;
    PassSetup setup_;
    VkDescriptorSetLayout textures_ = VK_NULL_HANDLE;
    std::map<MeshVariant, gpu::Pipeline> pipelines_;  ///< nodes stay where they are
};

/// Whether what is behind shows through, for some alphas.
[[nodiscard]] bool is_blend(scene::SurfaceBlend blend);
/// How a material's colour goes into the colour target. What is blended keeps the alpha that is there.
[[nodiscard]] gpu::ColorTarget blended_target(scene::SurfaceBlend blend, bool has_alpha_layer);

}  // namespace darkroom::render
