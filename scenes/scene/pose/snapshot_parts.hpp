// SPDX-License-Identifier: MIT
#pragma once
// The parts of snapshot() that are worth a file: where entities are, what their surfaces are, which lights shine, what
// the camera sees. Only the files snapshot*.cpp use this header.

#include <map>
#include <tuple>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

/// World matrices of all entities at a time, keys of paths included. A cycle of parents ends at its first member.
[[nodiscard]] std::vector<mat4> entity_worlds(const Scene& scene, double time);
/// Where messages say that an entity is: its place, or the scene's file where it has none.
[[nodiscard]] std::string place_of(const Scene& scene, const Entity& entity);
/// Of one entity; the same matrix, to the bit.
[[nodiscard]] mat4 entity_world(const Scene& scene, std::uint32_t entity, double time);
/// Whether it or what it hangs from has a path.
[[nodiscard]] bool is_moving(const Scene& scene, std::uint32_t entity);
/// Turns a direction as the matrix turns it, whatever its scale; of unit length, `fallback` where there is none.
[[nodiscard]] vec3 turned(const mat4& matrix, vec3 direction, vec3 fallback);

/// Poses made so far: many entities share a model that stands still.
class PoseCache {
  public:
    PoseCache(const Scene& scene, const Assets& assets) : assets_(assets), skins_(scene.skins) {}
    [[nodiscard]] const Pose& get(std::uint32_t model, std::uint32_t animation, double time);

  private:
    const Assets& assets_;
    Skins skins_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, double>, Pose> poses_;
};

/// The clip an entity plays, no_index for none. A name that the model lacks is told to `warnings`, if given.
[[nodiscard]] std::uint32_t clip_of(const Scene& scene, std::uint32_t entity, const Model& model,
                                    std::vector<std::string>* warnings);

[[nodiscard]] EntityAssets assets_of(const Assets& assets, std::uint32_t entity);

/// Of a bounds component.
struct BoxSurface {
    SnapshotMaterial material;
    bool is_wireframe = false;
};
[[nodiscard]] BoxSurface box_surface(const Scene& scene, const Assets& assets, std::uint32_t entity);
/// `material`: in the model, no_index for the default one of glTF.
[[nodiscard]] SnapshotMaterial model_surface(const Scene& scene, const Assets& assets, std::uint32_t entity,
                                             std::uint32_t material);
[[nodiscard]] bool casts_shadow(const SnapshotMaterial& material);

/// All lights of the moment, within the limits of the renderer, or the default ones.
void add_lights(const Scene& scene, const Assets& assets, const std::vector<mat4>& worlds, double time,
                PoseCache& poses, Snapshot& out);

/// `fitted`: what a view that the scene does not give is fitted to; empty where the scene gives one.
void add_camera(const Scene& scene, const Assets& assets, const SnapshotOptions& options, const Box& fitted,
                PoseCache& poses, Snapshot& out);

/// Clip space as Vulkan has it: y down, depth reversed.
[[nodiscard]] mat4 perspective(float field_of_view, float aspect, float near_distance, float far_distance);
[[nodiscard]] mat4 orthographic(float height, float aspect, float near_distance, float far_distance);

}  // namespace darkroom::scene
