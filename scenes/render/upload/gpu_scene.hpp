// SPDX-License-Identifier: MIT
#pragma once
// The assets of a scene on the device: one vertex and one index buffer for all meshes, textures with mip chains, one
// descriptor set for each combination of textures. Uploaded once, through staging memory, in one submission.

#include <memory>
#include <span>
#include <vector>

#include "draw/pipeline.hpp"
#include "gpu/resource/resources.hpp"
#include "render/frame_set.hpp"
#include "scene/assets.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

/// A mesh in the shared buffers.
struct GpuMesh {
    std::uint32_t first_index = 0, index_count = 0;
    std::int32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
    std::uint32_t first_skin = scene::no_index;         ///< first VertexSkin; no_index: not skinned
    std::uint32_t first_morph_delta = scene::no_index;  ///< in vec4; no_index: no targets
    std::uint32_t morph_targets = 0;
};

/// Vertex input of pipelines with shaders/mesh/mesh_vertex.glsl: binding 0 scene::Vertex, binding 1 scene::VertexSkin
/// (a single one where the mesh is not skinned).
struct MeshInput {
    std::vector<VkVertexInputBindingDescription> bindings;
    std::vector<VkVertexInputAttributeDescription> attributes;
};
[[nodiscard]] MeshInput mesh_input(bool is_skinned, VkVertexInputRate rate = VK_VERTEX_INPUT_RATE_VERTEX);

/// What alpha of a material's texture is cut out below, before factors lower it; 0: all is kept, or nothing.
[[nodiscard]] float texture_cutoff(const scene::SnapshotMaterial& material);

class GpuScene {
  public:
    /// `materials`: those that will be drawn beside the models' own, as entities change them.
    [[nodiscard]] static Result<GpuScene> create(gpu::Context& context, const scene::Assets& assets,
                                                 std::span<const scene::SnapshotMaterial> materials = {});

    [[nodiscard]] const GpuMesh& mesh(const scene::MeshId& id) const;
    /// Binds the mesh's vertices (its first is vertex 0 of the shader) and, where it has them, its skin.
    void bind_vertices(VkCommandBuffer commands, const GpuMesh& mesh) const;
    /// bind_vertices(), the index buffer, and one call for instances of a mesh. `first_instance`: in the instance
    /// buffer.
    void draw(VkCommandBuffer commands, const scene::MeshId& id, std::uint32_t first_instance,
              std::uint32_t instances) const;
    /// The twelve edges of the unit box, as a list of lines.
    void draw_box_edges(VkCommandBuffer commands, std::uint32_t first_instance, std::uint32_t instances) const;
    /// Set 1 of mesh pipelines: textures in the order of scene::textures_of(); what is not given is white (normals:
    /// flat). The same set for materials that share textures.
    [[nodiscard]] Result<VkDescriptorSet> textures(const scene::SnapshotMaterial& material);
    /// Set 1 of billboards: one texture, by its number in Assets::images; no_index: white. Sprites are cut out of it,
    /// particles blended.
    [[nodiscard]] Result<VkDescriptorSet> texture(std::uint32_t image, bool is_cut_out);

    gpu::SetLayout material_layout;                      ///< all textures of a material
    gpu::SetLayout billboard_layout;                     ///< one
    gpu::Buffer vertices, skins, indices, morph_deltas;  ///< skins and morph_deltas hold one element at least

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace darkroom::render
