// SPDX-License-Identifier: MIT
#pragma once
// A glTF 2.0 model on the CPU, checked: every index is in range, nodes form trees (parents before children), arrays of
// a primitive have one length. Nothing of the parsing library passes this header.

#include <algorithm>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/budget.hpp"
#include "scene/math.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {

inline constexpr std::uint32_t no_index = ~0U;

/// What the samples of an Image are: codes of 8 or 16 bits, whose transfer function is a matter of use (base colour and
/// emissive are sRGB, everything else linear), or halves, which are linear always.
enum class ImageKind : std::uint8_t { Codes8, Codes16, Halves };

/// Four samples a pixel, top row first, as fine as the file has them.
struct Image {
    std::string name;
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba{};   ///< of Codes8
    std::vector<std::uint16_t> wide{};  ///< of the others
    ImageKind kind = ImageKind::Codes8;
    [[nodiscard]] bool is_empty() const { return rgba.empty() && wide.empty(); }
};

enum class Wrap : std::uint8_t { Repeat, Mirror, Clamp };

struct Texture {
    std::uint32_t image = no_index;  ///< in Model::images; no_index: none
    Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
    bool is_nearest = false;
    std::uint32_t uv_set = 0;  ///< 0 or 1
    mat3 uv_transform{1};      ///< KHR_texture_transform, applied to (u, v, 1)
    [[nodiscard]] bool is_given() const { return image != no_index; }
};

/// The dielectric's reflection: KHR_materials_ior and KHR_materials_specular.
struct SpecularLayer {
    float index_of_refraction = 1.5F;  ///< 0: reflects all of the colour, whatever the angle
    float weight = 1;
    Texture texture;  ///< alpha
    vec3 color{1};    ///< of what is reflected head-on; may be above 1
    Texture color_texture;
    [[nodiscard]] bool is_given() const {
        return index_of_refraction != 1.5F || weight != 1 || color != vec3(1) || texture.is_given() ||
               color_texture.is_given();
    }
};

/// A clear varnish over all else: KHR_materials_clearcoat.
struct ClearcoatLayer {
    float weight = 0;
    Texture texture;  ///< red
    float roughness = 0;
    Texture roughness_texture;  ///< green
    Texture normal_texture;     ///< none: the coat is as smooth as the mesh, whatever bumps are under it
    float normal_scale = 1;
    [[nodiscard]] bool is_given() const { return weight > 0; }
};

/// Fibres that stand off the surface, as of velvet: KHR_materials_sheen.
struct SheenLayer {
    vec3 color{0};
    Texture color_texture;
    float roughness = 0;
    Texture roughness_texture;  ///< alpha
    [[nodiscard]] bool is_given() const { return color != vec3(0); }
};

/// Metallic-roughness. Textures multiply factors.
struct ModelMaterial {
    std::string name;
    vec4 base_color{1};
    Texture base_color_texture;
    float metallic = 1, roughness = 1;
    Texture metallic_roughness_texture;  ///< green roughness, blue metallic
    Texture normal_texture;
    float normal_scale = 1;
    Texture occlusion_texture;  ///< red
    float occlusion_strength = 1;
    vec3 emissive{0};  ///< times KHR_materials_emissive_strength
    Texture emissive_texture;
    SpecularLayer specular;
    ClearcoatLayer clearcoat;
    SheenLayer sheen;
    SurfaceBlend blend = SurfaceBlend::Opaque;  ///< Opaque, Mask or Alpha
    float alpha_cutoff = 0.5F;
    bool is_double_sided = false;
    bool is_unlit = false;
};

/// A texture of a material and what it is used for.
struct TextureUse {
    const Texture* texture = nullptr;
    bool is_srgb = false, is_normal = false;
};
inline constexpr std::size_t material_textures = 12;
/// In the order in which shaders number them: base colour first.
[[nodiscard]] inline std::array<TextureUse, material_textures> textures_of(const ModelMaterial& material) {
    return {TextureUse{&material.base_color_texture, true},
            {&material.metallic_roughness_texture},
            {&material.normal_texture, false, true},
            {&material.occlusion_texture},
            {&material.emissive_texture, true},
            {&material.specular.texture},
            {&material.specular.color_texture, true},
            {&material.clearcoat.texture},
            {&material.clearcoat.roughness_texture},
            {&material.clearcoat.normal_texture, false, true},
            {&material.sheen.color_texture, true},
            {&material.sheen.roughness_texture}};
}

/// One vertex as the GPU gets it.
struct Vertex {
    vec3 position{0};
    vec3 normal{0, 1, 0};
    vec4 tangent{0};  ///< w: handedness; all 0: no normal map, or none to be had
    vec2 uv0{0}, uv1{0};
    vec4 color{1};  ///< linear
};

/// Joint indices of a skinned vertex and their weights, which sum to 1.
struct VertexSkin {
    std::array<std::uint16_t, 4> joints{};
    vec4 weights{1, 0, 0, 0};
};

/// One morph target: what is added per unit of weight, as many as there are vertices (normals may be empty).
struct MorphTarget {
    std::vector<vec3> positions, normals;
};

/// KHR_materials_variants: what a primitive is made of in one of Model::variants.
struct VariantMaterial {
    std::uint32_t variant = 0, material = 0;
};

struct Primitive {
    std::vector<Vertex> vertices;
    std::vector<VertexSkin> skin;        ///< empty, or one a vertex
    std::vector<std::uint32_t> indices;  ///< triangles
    std::vector<MorphTarget> targets;
    std::uint32_t material = no_index;      ///< no_index: the default material
    std::vector<VariantMaterial> variants;  ///< in their order, one each; the others have `material`
    Box bounds;                             ///< of the vertices as they are in the file
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  ///< of the morph targets at rest
};

struct Node {
    std::string name;
    std::uint32_t parent = no_index;  ///< always before its children in Model::nodes
    Transform transform;
    std::optional<mat4> matrix;  ///< given instead of the transform; such nodes are not animated
    std::uint32_t mesh = no_index, skin = no_index, camera = no_index, light = no_index;
    std::vector<float> weights;  ///< overrides the mesh's
};

struct Skin {
    std::vector<std::uint32_t> joints;  ///< nodes
    std::vector<mat4> inverse_bind;     ///< one a joint
};

enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
enum class AnimatedProperty : std::uint8_t { Translation, Rotation, Scale, Weights };

struct AnimationChannel {
    std::uint32_t node = 0;
    AnimatedProperty property = AnimatedProperty::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< seconds, increasing
    /// `width` numbers a key (3, 4 as x y z w, or the count of weights); cubic splines have in-tangent, value and
    /// out-tangent a key, in this order.
    std::vector<float> values;
    std::uint32_t width = 3;
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
    float duration = 0;  ///< seconds
};

struct ModelCamera {
    std::string name;
    Projection projection = Projection::Perspective;
    float field_of_view = 45;  ///< vertical, degrees
    float ortho_height = 10;
    float near_distance = 0.1F, far_distance = 1000;
};

struct Model {
    std::string name;
    std::vector<Image> images;
    std::vector<ModelMaterial> materials;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;            ///< of the default scene
    std::vector<std::string> variants;  ///< their names
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<ModelCamera> cameras;
    std::vector<Light> lights;          ///< KHR_lights_punctual, in the units of the file (candela and lux as they are)
    std::vector<std::string> warnings;  ///< one line each, without the file's name
    std::uint64_t file_bytes = 0;       ///< of the model and of what its buffers name
};

/// Reads .glb or .gltf. Images are decoded in parallel; a missing or broken image is a warning and is drawn as white.
/// Errors begin with the path and name the fault: damaged structure, an index or accessor out of range, a cycle of
/// nodes, a URI that leaves the model's folder, a required extension this reader lacks.
/// More elements, or more data that share bytes, than the budget has room for are refused before they are made.
[[nodiscard]] Result<Model> read_model(const std::filesystem::path& path, Budget budget = Budget(),
                                       NamedFiles named_files = NamedFiles::Own);

/// `variant`: in Model::variants, or no_index.
[[nodiscard]] inline std::uint32_t material_of(const Primitive& primitive, std::uint32_t variant) {
    const auto found = std::ranges::lower_bound(primitive.variants, variant, {}, &VariantMaterial::variant);
    return found == primitive.variants.end() || found->variant != variant ? primitive.material : found->material;
}

/// The variant of this name, no_index where there is none.
[[nodiscard]] inline std::uint32_t variant_of(const Model& model, std::string_view name) {
    const auto found = std::ranges::find(model.variants, name);
    return name.empty() || found == model.variants.end() ? no_index
                                                         : static_cast<std::uint32_t>(found - model.variants.begin());
}

}  // namespace darkroom::scene
