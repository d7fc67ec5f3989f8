// SPDX-License-Identifier: MIT
#pragma once
// Which extensions of glTF 2.0 are read here, and what a model looks like without some of those that are not. An
// extension that is learnt moves from the second list to the first.

#include <algorithm>
#include <array>
#include <string_view>

namespace darkroom::scene::gltf {

inline constexpr auto read_extensions = std::to_array<std::string_view>({
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
});

/// What happens without one that a file may do without.
struct MissingExtension {
    std::string_view name, consequence;
};

inline constexpr auto missing_extensions = std::to_array<MissingExtension>({
    {"EXT_lights_image_based", "light of the model's own surroundings is left out"},
    {"KHR_animation_pointer", "only nodes and morph targets are animated"},
    {"KHR_materials_anisotropy", "highlights are round"},
    {"KHR_materials_diffuse_transmission", "no light comes through its surfaces"},
    {"KHR_materials_dispersion", "colours are not split"},
    {"KHR_materials_iridescence", "thin films are left out"},
    {"KHR_materials_pbrSpecularGlossiness", "surfaces are drawn by their metallic-roughness values, or white"},
    {"KHR_materials_transmission", "glass is opaque"},
    {"KHR_materials_volume", "nothing absorbs light inside"},
    {"KHR_node_visibility", "hidden nodes are drawn"},
    {"KHR_texture_basisu", "textures are read from their other images, or left out"},
    {"MSFT_lod", "the finest level is drawn"},
    {"MSFT_texture_dds", "textures are read from their other images, or left out"},
});

inline bool is_read_extension(std::string_view name) {
    return std::ranges::find(read_extensions, name) != read_extensions.end();
}

/// Empty where nothing is known of it.
inline std::string_view consequence_without(std::string_view name) {
    const auto found = std::ranges::find(missing_extensions, name, &MissingExtension::name);
    return found == missing_extensions.end() ? std::string_view() : found->consequence;
}

}  // namespace darkroom::scene::gltf
