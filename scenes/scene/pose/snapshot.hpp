// SPDX-License-Identifier: MIT
#pragma once
// What a scene is like at a moment: every mesh with its world matrix now and a moment ago, joints, lights, particles,
// camera. It is a function of scene, assets and time alone: the same time gives the same bytes, in any order. Drawing
// is for scenes/render; nothing here knows a GPU.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/assets.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {

/// A mesh of a model, or the unit box (0,0,0)-(1,1,1) of a bounds component.
struct MeshId {
    std::uint32_t model = no_index;  ///< no_index: the unit box
    std::uint32_t mesh = 0, primitive = 0;
    friend bool operator==(const MeshId&, const MeshId&) = default;
    friend auto operator<=>(const MeshId&, const MeshId&) = default;
};

/// A drawn mesh. Its surface is in `SnapshotMaterial`.
struct Instance {
    MeshId mesh;
    mat4 world{1}, previous_world{1};
    Box bounds;                  ///< world space, of now; skinned and morphed: of the moved vertices or a safe box
    std::uint32_t material = 0;  ///< in Snapshot::materials
    std::uint32_t entity = 0;    ///< in Scene::entities
    std::uint32_t first_joint = no_index, joint_count = 0;    ///< in Snapshot::joints; skinned vertices ignore `world`
    std::uint32_t first_weight = no_index, weight_count = 0;  ///< in Snapshot::weights
    bool is_mirrored = false;                                 ///< the world matrix turns front faces to the back
    bool is_wireframe = false;                                ///< rooms: their box is drawn by its edges
    bool casts_shadow = true;
};

/// Textures are either of a model (`model`, with the indices of ModelMaterial) or of Assets::images (entity textures).
struct SnapshotMaterial {
    ModelMaterial surface;
    std::uint32_t model = no_index;           ///< whose images `surface` names
    std::uint32_t entity_texture = no_index;  ///< in Assets::images: base colour of a box
    float opacity = 1;
    Writes writes = Writes::All;
};

/// Directional lights come first ordered by intensity (brightest first), then name; others in the order of the file.
struct LightState {
    Light light;
    std::string name;
    vec3 position{0};   ///< world space
    vec3 direction{0};  ///< world space, normalised; meaning as in Light
};

struct SpriteState {
    std::uint32_t image = no_index;  ///< in Assets::images; no_index: white
    vec3 position{0}, previous_position{0};
    vec2 size{1};
    float anchor_y = 0;
    vec4 uv{0, 0, 1, 1};  ///< of the frame: left, top, right, bottom
    float intensity = 1;
};

struct Particle {
    vec3 position{0}, previous_position{0};  ///< world space
    float size = 0;                          ///< width of the square, metres
    vec4 color{1};
    vec4 uv{0, 0, 1, 1};
};

/// The particles of one emitter, unsorted: drawing sorts them by the camera.
struct ParticleState {
    std::uint32_t image = no_index;
    SurfaceBlend blend = SurfaceBlend::Alpha;
    std::vector<Particle> particles;
};

struct CameraState {
    mat4 view{1}, previous_view{1};
    /// Camera to clip space: y down, depth reversed (1 near, 0 far).
    mat4 projection{1}, previous_projection{1};
    vec3 position{0};
    vec3 target{0};  ///< what an orbit goes around
    Projection kind = Projection::Perspective;
    float field_of_view = 45;  ///< vertical, degrees
    float ortho_height = 10;   ///< of the view, metres; orthographic only
    float near_distance = 0.1F, far_distance = 1000;
};

struct Snapshot {
    double time = 0;
    CameraState camera;
    std::vector<SnapshotMaterial> materials;
    std::vector<Instance> instances;
    std::vector<mat4> joints, previous_joints;  ///< world space: joint world * inverse bind
    std::vector<float> weights, previous_weights;
    std::vector<LightState> lights;
    std::vector<SpriteState> sprites;
    std::vector<ParticleState> emitters;
    std::vector<std::string> warnings;  ///< limits that were exceeded: more than 4 directional lights, 16, 8
};

/// Where the picture is taken from; unset members are the scene's. The camera orbits `target`, and changing one of
/// these keeps the others: eye = target + distance * (cos pitch sin yaw, sin pitch, cos pitch cos yaw).
struct OrbitOverride {
    std::optional<float> distance, yaw, pitch;  ///< degrees
    std::optional<vec3> target;
    std::optional<float> field_of_view;  ///< degrees
    std::optional<float> ortho_height;   ///< metres; of an orthographic camera
    float least_far_distance = 0;        ///< metres; for the far plane of a camera that leaves its place
};

struct SnapshotOptions {
    double time = 0;
    double previous_time = 0;  ///< for motion; equal to time: nothing moves
    float aspect = 16.0F / 9;
    std::uint64_t seed = 0;  ///< of all particles
    OrbitOverride orbit;
    /// The overrides of the frame before, for the motion of a camera that hands move; unset: those of `orbit`.
    std::optional<OrbitOverride> previous_orbit;
};

/// Whether what a snapshot holds, and what the renderer makes of it, stays in proportion to the files of the scene:
/// entities may share a model, and its nodes meshes, skins and morph targets. The error names the entity and the count
/// that passed its limit. To be asked before the first snapshot().
[[nodiscard]] Result<> check_snapshot(const Scene& scene, const Assets& assets);

[[nodiscard]] Snapshot snapshot(const Scene& scene, const Assets& assets, const SnapshotOptions& options);

/// What everything visible fits in, at a time.
[[nodiscard]] Box scene_bounds(const Snapshot& snapshot);

/// The nodes of a model at a time: world matrices relative to the model, joints, morph weights.
struct Pose {
    std::vector<mat4> nodes;
    std::vector<std::vector<mat4>> joints;    ///< one list a skin: node world * inverse bind
    std::vector<std::vector<float>> weights;  ///< one list a node
};
/// `animation`: index, or no_index for the pose of the file. The clip loops.
[[nodiscard]] Pose pose(const Model& model, std::uint32_t animation, double time, Skins skins = Skins::AllNodes);

/// The time that motion at `time` is measured from: the one before, or `time` itself, so that there is none, where the
/// clip has begun again in between and jumps there: further than it moves anywhere in as much time.
[[nodiscard]] double motion_start(const Model& model, std::uint32_t animation, double time, double previous_time);

/// Vertices as the GPU should place them: the CPU's own skinning and morphing, for tests and for bounds.
[[nodiscard]] std::vector<vec3> deform(const Primitive& primitive, const mat4& world, std::span<const mat4> joints,
                                       std::span<const float> weights);

}  // namespace darkroom::scene
