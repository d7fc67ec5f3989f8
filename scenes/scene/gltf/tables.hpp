// SPDX-License-Identifier: MIT
#pragma once
// The properties of glTF 2.0 that are read here, as tables (Khronos Group, "glTF 2.0 Specification", 2021, chapter 5,
// and the specifications of the extensions). What is in no table never reaches the parsing library.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace darkroom::scene::gltf {

// What a table says of a property of glTF (tables.hpp): its name, its kind, and what is allowed.

/// Integers out of range make an element faulty, loose ones are passed over. UnusedIndex: checked, but nothing here
/// depends on it.
enum class Kind {
    Boolean,
    Integer,
    LooseInteger,
    Number,
    Numbers,
    Text,
    Index,
    UnusedIndex,
    Indices,
    IndexMap,
    IndexMaps,
    IntegerMap,
    Object,
    Objects
};

struct Definition;

/// A number outside low..high is reported and used.
struct Property {
    std::string_view name;
    Kind kind = Kind::Text;
    bool is_required = false;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::size_t count = 0;      ///< of numbers; 0: any
    std::string_view target{};  ///< the array that an index points into
    const Definition* object = nullptr;
};

struct Definition {
    std::span<const Property> properties;
};

/// What most elements take in memory, with all that is in none of their arrays: the library's, and ours.
inline constexpr std::uint64_t element_size = 1024;

/// An array of the root. The placeholder stands for elements that cannot be used.
struct Array {
    std::string_view name;
    const Definition* definition = nullptr;
    std::string_view placeholder;
    std::uint64_t element_size = gltf::element_size;
};

/// The largest whole number: byte counts are larger than an int, but nothing is larger than this.
inline constexpr std::uint64_t max_integer = std::uint64_t{1} << 40;

// Where the library reads an int, a larger number would overflow.
inline constexpr double max_int = std::numeric_limits<std::int32_t>::max();

inline constexpr Property index_of(std::string_view name, std::string_view target, bool is_required = false) {
    return {.name = name, .kind = Kind::Index, .is_required = is_required, .target = target};
}
inline constexpr Property object_of(std::string_view name, const Definition& object, bool is_required = false) {
    return {.name = name, .kind = Kind::Object, .is_required = is_required, .object = &object};
}
inline constexpr Property integer(std::string_view name, double low = 0, double high = max_int,
                                  bool is_required = false) {
    return {.name = name, .kind = Kind::Integer, .is_required = is_required, .low = low, .high = high};
}
inline constexpr Property loose_integer(std::string_view name, double low, double high) {
    return {.name = name, .kind = Kind::LooseInteger, .low = low, .high = high};
}
inline constexpr Property number(std::string_view name, double low = -std::numeric_limits<double>::infinity(),
                                 double high = std::numeric_limits<double>::infinity(), bool is_required = false) {
    return {.name = name, .kind = Kind::Number, .is_required = is_required, .low = low, .high = high};
}
inline constexpr Property numbers(std::string_view name, std::size_t count,
                                  double low = -std::numeric_limits<double>::infinity(),
                                  double high = std::numeric_limits<double>::infinity()) {
    return {.name = name, .kind = Kind::Numbers, .low = low, .high = high, .count = count};
}
inline constexpr Property text(std::string_view name, bool is_required = false) {
    return {.name = name, .kind = Kind::Text, .is_required = is_required};
}
inline constexpr double endless = std::numeric_limits<double>::infinity();

inline constexpr std::array fallback_table{Property{.name = "fallback", .kind = Kind::Boolean}};
inline constexpr Definition fallback_definition{fallback_table};
inline constexpr std::array buffer_extensions_table{object_of("EXT_meshopt_compression", fallback_definition)};
inline constexpr Definition buffer_extensions{buffer_extensions_table};
inline constexpr std::array buffer_table{text("uri"), integer("byteLength", 1, endless, true), text("name"),
                                         object_of("extensions", buffer_extensions)};
inline constexpr std::array meshopt_table{index_of("buffer", "buffers", true),
                                          integer("byteOffset", 0, endless),
                                          integer("byteLength", 1, endless, true),
                                          integer("byteStride", 1, 256, true),
                                          integer("count", 1, endless, true),
                                          text("mode", true),
                                          text("filter")};
inline constexpr Definition meshopt_definition{meshopt_table};
inline constexpr std::array view_extensions_table{object_of("EXT_meshopt_compression", meshopt_definition)};
inline constexpr Definition view_extensions{view_extensions_table};
inline constexpr std::array view_table{
    index_of("buffer", "buffers", true),     integer("byteOffset", 0, endless),
    integer("byteLength", 1, endless, true), integer("byteStride", 4, 252),
    loose_integer("target", 34962, 34963),   object_of("extensions", view_extensions)};

inline constexpr std::array sparse_indices_table{index_of("bufferView", "bufferViews", true), integer("byteOffset"),
                                                 integer("componentType", 5121, 5125, true)};
inline constexpr Definition sparse_indices{sparse_indices_table};
inline constexpr std::array sparse_values_table{index_of("bufferView", "bufferViews", true), integer("byteOffset")};
inline constexpr Definition sparse_values{sparse_values_table};
inline constexpr std::array sparse_table{integer("count", 1, max_int, true), object_of("indices", sparse_indices, true),
                                         object_of("values", sparse_values, true)};
inline constexpr Definition sparse_definition{sparse_table};
inline constexpr std::array accessor_table{index_of("bufferView", "bufferViews"),
                                           integer("byteOffset", 0, endless),
                                           integer("componentType", 5120, 5126, true),
                                           Property{.name = "normalized", .kind = Kind::Boolean},
                                           integer("count", 1, endless, true),
                                           text("type", true),
                                           numbers("min", 0),
                                           numbers("max", 0),
                                           object_of("sparse", sparse_definition)};

inline constexpr std::array image_table{text("uri"), text("mimeType"), index_of("bufferView", "bufferViews"),
                                        text("name")};
inline constexpr std::array sampler_table{loose_integer("magFilter", 9728, 9729),
                                          loose_integer("minFilter", 9728, 9987), loose_integer("wrapS", 10497, 33648),
                                          loose_integer("wrapT", 10497, 33648)};
inline constexpr std::array texture_webp_table{index_of("source", "images", true)};
inline constexpr Definition texture_webp{texture_webp_table};
inline constexpr std::array texture_sources_table{object_of("EXT_texture_webp", texture_webp)};
inline constexpr Definition texture_sources{texture_sources_table};
inline constexpr std::array texture_table{index_of("sampler", "samplers"), index_of("source", "images"),
                                          object_of("extensions", texture_sources)};

inline constexpr std::array transform_table{numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                            integer("texCoord")};
inline constexpr Definition transform_definition{transform_table};
inline constexpr std::array texture_extensions_table{object_of("KHR_texture_transform", transform_definition)};
inline constexpr Definition texture_extensions{texture_extensions_table};
inline constexpr std::array texture_info_table{index_of("index", "textures", true), integer("texCoord"),
                                               number("scale"), number("strength", 0, 1),
                                               object_of("extensions", texture_extensions)};
inline constexpr Definition texture_info{texture_info_table};
inline constexpr std::array metallic_table{
    numbers("baseColorFactor", 4, 0, 1), object_of("baseColorTexture", texture_info), number("metallicFactor", 0, 1),
    number("roughnessFactor", 0, 1), object_of("metallicRoughnessTexture", texture_info)};
inline constexpr Definition metallic_definition{metallic_table};
inline constexpr Definition empty_definition{};
inline constexpr std::array emissive_strength_table{number("emissiveStrength", 0)};
inline constexpr Definition emissive_strength{emissive_strength_table};
// An index is 0 or at least 1, which the conversion says.
inline constexpr std::array ior_table{number("ior")};
inline constexpr Definition ior_definition{ior_table};
inline constexpr std::array specular_table{number("specularFactor", 0, 1), object_of("specularTexture", texture_info),
                                           numbers("specularColorFactor", 3, 0),
                                           object_of("specularColorTexture", texture_info)};
inline constexpr Definition specular_definition{specular_table};
inline constexpr std::array clearcoat_table{
    number("clearcoatFactor", 0, 1), object_of("clearcoatTexture", texture_info),
    number("clearcoatRoughnessFactor", 0, 1), object_of("clearcoatRoughnessTexture", texture_info),
    object_of("clearcoatNormalTexture", texture_info)};
inline constexpr Definition clearcoat_definition{clearcoat_table};
inline constexpr std::array sheen_table{
    numbers("sheenColorFactor", 3, 0, 1), object_of("sheenColorTexture", texture_info),
    number("sheenRoughnessFactor", 0, 1), object_of("sheenRoughnessTexture", texture_info)};
inline constexpr Definition sheen_definition{sheen_table};
inline constexpr std::array material_extensions_table{object_of("KHR_materials_unlit", empty_definition),
                                                      object_of("KHR_materials_emissive_strength", emissive_strength),
                                                      object_of("KHR_materials_clearcoat", clearcoat_definition),
                                                      object_of("KHR_materials_ior", ior_definition),
                                                      object_of("KHR_materials_sheen", sheen_definition),
                                                      object_of("KHR_materials_specular", specular_definition)};
inline constexpr Definition material_extensions{material_extensions_table};
inline constexpr std::array material_table{text("name"),
                                           object_of("pbrMetallicRoughness", metallic_definition),
                                           object_of("normalTexture", texture_info),
                                           object_of("occlusionTexture", texture_info),
                                           object_of("emissiveTexture", texture_info),
                                           numbers("emissiveFactor", 3, 0, 1),
                                           text("alphaMode"),
                                           number("alphaCutoff", 0),
                                           Property{.name = "doubleSided", .kind = Kind::Boolean},
                                           object_of("extensions", material_extensions)};

// KHR_materials_variants
inline constexpr std::array mapping_table{
    index_of("material", "materials", true),
    Property{.name = "variants", .kind = Kind::Indices, .is_required = true, .target = "variants"}};
inline constexpr Definition mapping_definition{mapping_table};
inline constexpr std::array mappings_table{
    Property{.name = "mappings", .kind = Kind::Objects, .is_required = true, .object = &mapping_definition}};
inline constexpr Definition mappings_definition{mappings_table};
inline constexpr std::array variant_table{text("name", true)};
inline constexpr Definition variant_definition{variant_table};
inline constexpr std::array draco_table{
    index_of("bufferView", "bufferViews", true),
    Property{.name = "attributes", .kind = Kind::IntegerMap, .is_required = true, .low = 0, .high = max_int}};
inline constexpr Definition draco_definition{draco_table};
inline constexpr std::array primitive_extensions_table{object_of("KHR_materials_variants", mappings_definition),
                                                       object_of("KHR_draco_mesh_compression", draco_definition)};
inline constexpr Definition primitive_extensions{primitive_extensions_table};

inline constexpr std::array primitive_table{
    Property{.name = "attributes", .kind = Kind::IndexMap, .is_required = true, .target = "accessors"},
    index_of("indices", "accessors"),
    index_of("material", "materials"),
    integer("mode"),
    Property{.name = "targets", .kind = Kind::IndexMaps, .target = "accessors"},
    object_of("extensions", primitive_extensions)};
inline constexpr Definition primitive_definition{primitive_table};
inline constexpr std::array mesh_table{
    text("name"), numbers("weights", 0),
    Property{.name = "primitives", .kind = Kind::Objects, .is_required = true, .object = &primitive_definition}};

inline constexpr std::array perspective_table{number("aspectRatio", 1e-6), number("yfov", 1e-6, 3.1415927, true),
                                              number("zfar", 1e-9), number("znear", 1e-9, endless, true)};
inline constexpr Definition perspective_definition{perspective_table};
inline constexpr std::array orthographic_table{number("xmag", 1e-9, endless, true), number("ymag", 1e-9, endless, true),
                                               number("zfar", 1e-9, endless, true), number("znear", 0, endless, true)};
inline constexpr Definition orthographic_definition{orthographic_table};
inline constexpr std::array camera_table{text("name"), text("type", true),
                                         object_of("perspective", perspective_definition),
                                         object_of("orthographic", orthographic_definition)};

inline constexpr std::array skin_table{
    text("name"), index_of("inverseBindMatrices", "accessors"),
    Property{.name = "skeleton", .kind = Kind::UnusedIndex, .target = "nodes"},
    Property{.name = "joints", .kind = Kind::Indices, .is_required = true, .target = "nodes"}};

inline constexpr std::array node_light_table{index_of("light", "lights", true)};
inline constexpr Definition node_light{node_light_table};
inline constexpr std::array instancing_table{
    Property{.name = "attributes", .kind = Kind::IndexMap, .is_required = true, .target = "accessors"}};
inline constexpr Definition instancing_definition{instancing_table};
inline constexpr std::array node_extensions_table{object_of("KHR_lights_punctual", node_light),
                                                  object_of("EXT_mesh_gpu_instancing", instancing_definition)};
inline constexpr Definition node_extensions{node_extensions_table};
inline constexpr std::array node_table{text("name"),
                                       index_of("camera", "cameras"),
                                       Property{.name = "children", .kind = Kind::Indices, .target = "nodes"},
                                       index_of("skin", "skins"),
                                       index_of("mesh", "meshes"),
                                       numbers("matrix", 16),
                                       numbers("rotation", 4, -1, 1),
                                       numbers("scale", 3),
                                       numbers("translation", 3),
                                       numbers("weights", 0),
                                       object_of("extensions", node_extensions)};

inline constexpr std::array target_table{index_of("node", "nodes"), text("path", true)};
inline constexpr Definition target_definition{target_table};
inline constexpr std::array channel_table{integer("sampler", 0, max_int, true),
                                          object_of("target", target_definition, true)};
inline constexpr Definition channel_definition{channel_table};
inline constexpr std::array animation_sampler_table{index_of("input", "accessors", true), text("interpolation"),
                                                    index_of("output", "accessors", true)};
inline constexpr Definition animation_sampler{animation_sampler_table};
inline constexpr std::array animation_table{
    text("name"),
    Property{.name = "channels", .kind = Kind::Objects, .is_required = true, .object = &channel_definition},
    Property{.name = "samplers", .kind = Kind::Objects, .is_required = true, .object = &animation_sampler}};

inline constexpr std::array scene_table{text("name"),
                                        Property{.name = "nodes", .kind = Kind::Indices, .target = "nodes"}};

inline constexpr std::array spot_table{number("innerConeAngle", 0, 1.5707964), number("outerConeAngle", 0, 1.5707964)};
inline constexpr Definition spot_definition{spot_table};
inline constexpr std::array light_table{
    text("name"),           text("type", true),    numbers("color", 3, 0, 1),
    number("intensity", 0), number("range", 1e-9), object_of("spot", spot_definition)};
inline constexpr Definition light_definition{light_table};
inline constexpr std::string_view light_placeholder = R"({"type":"point","intensity":0})";

inline constexpr Definition buffer_definition{buffer_table}, view_definition{view_table},
    accessor_definition{accessor_table}, image_definition{image_table}, sampler_definition{sampler_table},
    texture_definition{texture_table}, material_definition{material_table}, mesh_definition{mesh_table},
    camera_definition{camera_table}, skin_definition{skin_table}, node_definition{node_table},
    animation_definition{animation_table}, scene_definition{scene_table};

inline constexpr std::array arrays{
    Array{"buffers", &buffer_definition, R"({"byteLength":1})"},
    Array{"bufferViews", &view_definition, R"({"buffer":0,"byteLength":1})"},
    Array{"accessors", &accessor_definition, R"({"componentType":5126,"count":1,"type":"SCALAR"})"},
    Array{"images", &image_definition, "{}"},
    Array{"samplers", &sampler_definition, "{}"},
    Array{"textures", &texture_definition, "{}"},
    Array{"materials", &material_definition, "{}", 3 * element_size},
    Array{"meshes", &mesh_definition, R"({"primitives":[]})"},
    Array{"cameras", &camera_definition, R"({"type":"perspective","perspective":{"yfov":1,"znear":0.1}})"},
    Array{"skins", &skin_definition, R"({"joints":[]})"},
    Array{"nodes", &node_definition, "{}"},
    Array{"animations", &animation_definition, R"({"channels":[],"samplers":[]})"},
    Array{"scenes", &scene_definition, "{}"}};

}  // namespace darkroom::scene::gltf
