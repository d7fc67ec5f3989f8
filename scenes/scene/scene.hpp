// SPDX-License-Identifier: MIT
#pragma once
// A scene as its file says it: camera, environment and entities with their components, in the order of the file.
// Nothing is animated or drawn here; assets.hpp loads what a scene names, snapshot.hpp says what it is like at a time.
// The [post_process] and [[stack]] tables of the same file are a look (darkroom/look.hpp) and are passed over here.
//
// Units: metres, seconds, angles in the file as reference: transforms and fields of view in degrees, a spot's cone in
// radians. Colours are linear Rec. 709.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/math.hpp"
#include "scene/named_files.hpp"

namespace darkroom::scene {

enum class Projection : std::uint8_t { Perspective, Orthographic };

/// A point of a camera path; between keys everything is interpolated linearly, before the first and after the last it
/// stands still.
struct CameraKey {
    double time = 0;
    vec3 position{0}, target{0};
    float field_of_view = 45;  ///< vertical, degrees
};

/// What a camera says of its lens.
struct Lens {
    std::optional<float> aperture;       ///< f-stop
    std::optional<float> focus;          ///< distance along the view axis, metres
    std::optional<float> sensor_height;  ///< millimetres
};

struct Camera {
    bool is_given = false;  ///< the file has a [camera]; without one the view is fitted to what the scene holds
    Projection projection = Projection::Perspective;
    float ortho_height = 10;  ///< of the view, orthographic only
    vec3 position{0, 0, 15}, target{0};
    float field_of_view = 45;  ///< vertical, degrees
    float near_distance = 0.1F, far_distance = 1000;
    Lens lens;
    std::vector<CameraKey> path;  ///< [[camera.path]]: goes before position, target and fov
};

struct Environment {
    std::filesystem::path skybox;  ///< equirectangular, .hdr or .exr (LDR files are sRGB-decoded); empty: none
    float skybox_intensity = 1;
    std::optional<vec3> ambient_color;  ///< instead of the hemisphere's two colours
    float ambient_intensity = 1;
    vec3 background{0.1F, 0.1F, 0.15F};  ///< linear, where no skybox is
};

enum class SurfaceBlend : std::uint8_t { Opaque, Mask, Alpha, Additive, Multiply };
/// Which channels of the picture a draw writes; Alpha is for masks that effects read later.
enum class Writes : std::uint8_t { All, Alpha };

/// The [entities.X.material] table. For an entity with a model only what is given overrides the model's materials.
struct Material {
    std::filesystem::path texture;   ///< as the file names it, relative to the scene
    std::optional<vec3> color;       ///< linear; default: the archetype's
    std::optional<float> alpha;      ///< fourth number of color, or base_color_a
    std::optional<float> metallic;   ///< 0
    std::optional<float> roughness;  ///< 0.7
    float opacity = 1;
    std::optional<SurfaceBlend> blend;  ///< default: Opaque, or Alpha where opacity or alpha is below 1
    std::optional<vec3> emissive;
    float emissive_strength = 1;
    std::optional<float> alpha_cutoff;  ///< 0.5
    Writes writes = Writes::All;
};

struct ModelReference {
    std::string asset;        ///< "fox": <scene folder>/models/fox.glb, .gltf, then ../models
    std::string animation;    ///< name or number of a clip; empty: the first
    bool is_animated = true;  ///< false: the pose of the file
    float animation_speed = 1;
    std::string variant;  ///< of KHR_materials_variants, by its name; empty: the materials without one
    /// Of the model's lights, which glTF has in candela and lux: the default undoes the 683 lm/W of exporters.
    float light_scale = 1.0F / 683;
};

enum class LightType : std::uint8_t { Directional, Point, Spot };

struct Light {
    LightType type = LightType::Directional;
    vec3 color{1};
    float intensity = 1;
    vec3 direction{0, -1, 0};  ///< directional: toward the light; spot: the cone's axis, from the light into the scene
    float range = 10;          ///< metres; "radius" in some files
    float inner_angle = 0.3F, outer_angle = 0.5F;  ///< radians, from the axis
    bool casts_shadow = true;
    float volumetric_intensity = 0;
    std::optional<vec3> volumetric_color;  ///< default: color
};

struct Sprite {
    std::filesystem::path texture;
    float width = 1, height = 1;
    std::uint32_t frame = 0, frames_x = 1, frames_y = 1;
    float anchor_y = 0;   ///< 0: stands on its origin, 1: hangs from it
    float intensity = 1;  ///< multiplies the texture's linear light
    bool is_visible = true;
};

enum class EmitterShape : std::uint8_t { Point, Sphere, Cone, Box };

struct ParticleEmitter {
    float emission_rate = 10;  ///< particles a second, [0, 10000]
    std::uint32_t burst_count = 0;
    std::uint32_t max_particles = 256;  ///< [0, 10000]
    float lifetime_min = 1, lifetime_max = 2;
    float speed_min = 1, speed_max = 3;
    vec3 direction{0, 1, 0};
    float spread = 15;  ///< degrees, half angle around direction
    vec3 gravity{0, -9.81F, 0};
    float damping = 0;  ///< 1/s: speed decays as exp(-damping * t)
    float size_start = 0.1F, size_end = 0;
    vec4 color_start{1}, color_end{1, 1, 1, 0};
    std::filesystem::path texture;
    std::uint32_t frames_x = 1, frames_y = 1;
    bool animates_frames = false;
    SurfaceBlend blend = SurfaceBlend::Alpha;  ///< Alpha or Additive
    EmitterShape shape = EmitterShape::Point;
    float shape_radius = 0.5F;
    float shape_angle = 30;  ///< degrees, half angle of a cone
    vec3 shape_extents{0.5F};
    bool is_world_space = true;
    float duration = 0;  ///< seconds a cycle emits; 0: without end
    bool is_looping = true;
    bool is_playing = false, autoplay = true;  ///< emits if either is set
};

/// A moving entity: keys of the whole transform, interpolated linearly (rotations along the shorter arc).
struct TransformKey {
    double time = 0;
    Transform transform;
};

struct Entity {
    static constexpr std::uint32_t none = ~0U;
    std::string name;
    std::string archetype;
    std::uint32_t parent = none;  ///< index in Scene::entities
    Transform transform;
    std::vector<TransformKey> path;  ///< [[entities.X.transform.path]]
    std::optional<Box> bounds;
    std::optional<Material> material;
    std::optional<ModelReference> model;
    std::optional<Light> light;
    std::optional<Sprite> sprite;
    std::optional<ParticleEmitter> emitter;
    std::string place;  ///< "file:line:column" where a file first names it, for messages
};

inline constexpr std::uint32_t max_samples = 1024;  ///< of Scene::samples

/// What moves the joints of a skin. JointsOnly: joints are the only parents, and what hangs above them in the model
/// counts for nothing, as some engines import figures.
enum class Skins : std::uint8_t { AllNodes, JointsOnly };

struct Scene {
    std::string name, description;
    std::filesystem::path file;    ///< for messages
    std::filesystem::path folder;  ///< that assets are relative to
    std::uint64_t file_bytes = 0;  ///< of the scene and of its prefabs
    double time = 0;               ///< [scene] time: of a picture when no other time is asked for, seconds
    std::uint32_t samples = 0;     ///< [scene] samples: places within a pixel that a picture is made of; 0: not said
    bool has_grid = true;          ///< [scene] grid
    NamedFiles named_files = NamedFiles::Any;
    bool has_alpha_layer = false;  ///< [scene] alpha_layer: alpha is cleared to 0 and only Writes::Alpha draws write it
    Skins skins = Skins::AllNodes;   ///< [scene] skins
    bool has_assumed_skins = false;  ///< the scene does not say them, and is of a style that is placed for JointsOnly
    Camera camera;
    Environment environment;
    std::vector<Entity> entities;
};

struct SceneOptions {
    bool is_strict = false;                        ///< what is a warning otherwise is an error
    std::vector<std::string>* warnings = nullptr;  ///< "file:line:column: ..."
    NamedFiles named_files = NamedFiles::Any;
};

/// Errors and warnings are `shown_name:line:column: thing, value, what is allowed, nearest name`.
[[nodiscard]] Result<Scene> parse_scene(std::string_view text, const std::filesystem::path& file,
                                        const SceneOptions& options = {});
/// Whether the name is that of a model (.glb, .gltf, in any case).
[[nodiscard]] bool is_model_path(const std::filesystem::path& path);
/// The name of a scene or of a model.
[[nodiscard]] bool is_scene_path(const std::filesystem::path& path);
/// A .toml file as above; a .glb or .gltf file becomes a scene of that one model, without camera and without grid.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path, const SceneOptions& options = {});

/// The colour of a bounds box without a material, by its archetype; alpha below 1: drawn as a wireframe (rooms).
[[nodiscard]] vec4 archetype_color(std::string_view archetype);

}  // namespace darkroom::scene
