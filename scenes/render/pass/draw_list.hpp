// SPDX-License-Identifier: MIT
#pragma once
// Which instances are drawn, in which order, and which of them in one call: culled against a frustum, sorted by state,
// instanced where mesh and textures repeat; transparent ones back to front. Arithmetic alone, no GPU.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

/// Six planes, inside where dot(plane.xyz, p) + plane.w >= 0. From any matrix with depth in [0, 1].
struct Frustum {
    std::array<scene::vec4, 6> planes{};
    explicit Frustum(const scene::mat4& world_to_clip);
    [[nodiscard]] bool touches(const scene::Box& box) const;
};

/// What the shaders call layers (shaders/light/layers.glsl): what a material reflects beyond metallic-roughness, 0 for
/// most.
[[nodiscard]] std::uint32_t shader_layers(const scene::ModelMaterial& surface);

/// Consecutive entries of DrawList::order drawn by one call.
struct Batch {
    scene::MeshId mesh;
    std::uint32_t first = 0, count = 0;  ///< in DrawList::order
    std::uint32_t material = 0;          ///< in Snapshot::materials, of the first: they share textures and state
    bool is_skinned = false;
    bool is_mirrored = false;
};

struct DrawList {
    std::vector<std::uint32_t> order;  ///< of Snapshot::instances; what the instance buffer is filled from
    std::vector<Batch> opaque;         ///< Opaque and Mask
    std::vector<Batch> transparent;    ///< back to front; what only writes alpha is among them
    std::vector<Batch> wireframe;      ///< boxes of rooms
    std::uint32_t culled = 0;
};

/// Two materials in one batch share state and textures; factors may differ, the shader looks them up an instance.
/// `clip_moved`: goes behind the camera's projection.
[[nodiscard]] DrawList draw_list(const scene::Snapshot& snapshot, const scene::mat4& clip_moved = scene::mat4(1));

/// How far a light shines.
struct Reach {
    scene::vec3 center{0};
    float radius = std::numeric_limits<float>::infinity();
    [[nodiscard]] bool touches(const scene::Box& box) const;
};

/// Casters in a shadow map: opaque, masked and transparent meshes whose `casts_shadow` is set, without order by depth.
[[nodiscard]] DrawList caster_list(const scene::Snapshot& snapshot, const scene::mat4& world_to_map,
                                   const Reach& reach = {});

}  // namespace darkroom::render
