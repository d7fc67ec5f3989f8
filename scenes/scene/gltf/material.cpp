// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/gltf/convert.hpp"
#include "scene/image_batch.hpp"

namespace darkroom::scene::gltf {

Result<std::vector<Image>> convert_images(Document& document) {
    const std::vector<ImageSource>& sources = document.images();
    std::vector<EncodedImage> encoded;
    for (const ImageSource& source : sources)
        encoded.push_back({.name = source.name, .bytes = source.bytes, .file = source.file});
    std::vector<Result<Image>> decoded = decode_images(encoded);
    std::vector<Image> images;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (sources[i].fault.empty() && decoded[i]) {
            images.push_back(std::move(*decoded[i]));
            continue;
        }
        // What this machine cannot open now, another or a later run can.
        if (sources[i].fault.empty() && decoded[i].error().fault == Fault::Machine)
            return machine_error(fmt::format("{}: {}", sources[i].shown, decoded[i].error().text));
        images.push_back({.name = sources[i].name});
        const std::string fault = sources[i].fault.empty()
                                      ? fmt::format("{}: {}", sources[i].shown, decoded[i].error().text)
                                      : sources[i].fault;
        document.faults().warn(fmt::format("{}; it is drawn white", fault));
    }
    return images;
}
namespace {

Wrap wrap_of(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::Mirror;
    return Wrap::Repeat;
}

double element_of(const tinygltf::Value& object, const std::string& name, int index, double otherwise) {
    if (!object.IsObject() || !object.Has(name)) return otherwise;
    const tinygltf::Value& array = object.Get(name);
    if (!array.IsArray() || index >= static_cast<int>(array.ArrayLen())) return otherwise;
    const tinygltf::Value& value = array.Get(index);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

// KHR_texture_transform: scale, then rotation, then offset. A positive angle turns the coordinates from u toward -v,
// which is counter-clockwise where v points down, as the text of the extension and its reference viewer have it.
mat3 uv_transform_of(const tinygltf::Value& transform) {
    const float angle = as_float(number_of(transform, "rotation", 0));
    const float sine = std::sin(angle);
    const float cosine = std::cos(angle);
    const float scale_u = as_float(element_of(transform, "scale", 0, 1));
    const float scale_v = as_float(element_of(transform, "scale", 1, 1));
    return {vec3(cosine * scale_u, -sine * scale_u, 0), vec3(sine * scale_v, cosine * scale_v, 0),
            vec3(as_float(element_of(transform, "offset", 0, 0)), as_float(element_of(transform, "offset", 1, 0)), 1)};
}

class MaterialReader {
  public:
    MaterialReader(Document& document, const std::vector<bool>& is_broken, std::string pointer)
        : document_(document), is_broken_(is_broken), pointer_(std::move(pointer)) {}

    // For every kind of texture info, which share no base class in the library.
    template <class Info>
    Result<Texture> read(const Info& info, const char* place) const {
        Texture texture;
        if (info.index < 0) return texture;
        Faults& faults = document_.faults();
        DARKROOM_TRY(faults.check(fmt::format("/textures/{}", info.index)));
        const tinygltf::Texture& source = document_.model().textures[static_cast<std::size_t>(info.index)];
        if (source.source < 0) {
            faults.warn(fmt::format("/textures/{}: has no image that is read here", info.index));
            return texture;
        }
        const std::size_t image = document_.image_of(source.source);
        if (is_broken_[image]) return texture;
        texture.image = static_cast<std::uint32_t>(image);
        if (source.sampler >= 0) {
            DARKROOM_TRY(faults.check(fmt::format("/samplers/{}", source.sampler)));
            const tinygltf::Sampler& sampler = document_.model().samplers[static_cast<std::size_t>(source.sampler)];
            texture.wrap_u = wrap_of(sampler.wrapS);
            texture.wrap_v = wrap_of(sampler.wrapT);
            texture.is_nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        int uv_set = info.texCoord;
        const auto transform = info.extensions.find("KHR_texture_transform");
        if (transform != info.extensions.end()) {
            texture.uv_transform = uv_transform_of(transform->second);
            uv_set = static_cast<int>(number_of(transform->second, "texCoord", uv_set));
        }
        if (uv_set > 1) {
            faults.warn(fmt::format("{}/{}/texCoord: {}, sets 0 and 1 are read here", pointer_, place, uv_set));
            uv_set = 0;
        }
        texture.uv_set = static_cast<std::uint32_t>(uv_set);
        return texture;
    }

    // Of an extension, which the library keeps as it is written; `place` ends in the texture's name.
    Result<> read_into(Texture& texture, const tinygltf::Value& extension, const std::string& place) const {
        const std::string name = place.substr(place.rfind('/') + 1);
        if (!extension.Has(name)) return {};
        const tinygltf::Value& object = extension.Get(name);
        tinygltf::TextureInfo info;
        info.index = static_cast<int>(number_of(object, "index", -1));
        info.texCoord = static_cast<int>(number_of(object, "texCoord", 0));
        if (object.Has("extensions")) {
            const tinygltf::Value& extensions = object.Get("extensions");
            for (const std::string& key : extensions.Keys()) info.extensions[key] = extensions.Get(key);
        }
        DARKROOM_TRY_VALUE(texture, read(info, place.c_str()));
        return {};
    }

    [[nodiscard]] const std::string& pointer() const { return pointer_; }
    [[nodiscard]] Faults& faults() const { return document_.faults(); }

  private:
    Document& document_;
    const std::vector<bool>& is_broken_;
    std::string pointer_;
};

// A factor outside 0 to 1 has its warning from the tables.
float factor_of(const tinygltf::Value& extension, const std::string& name, double otherwise) {
    return as_float(std::clamp(number_of(extension, name, otherwise), 0.0, 1.0));
}

float index_of_refraction(const MaterialReader& reader, const tinygltf::Value& extension) {
    constexpr double otherwise = 1.5;
    const double given = number_of(extension, "ior", otherwise);
    if (given == 0 || given >= 1) return as_float(given);
    reader.faults().warn(fmt::format("{}/extensions/KHR_materials_ior/ior: {}, allowed is 0 and at least 1; {} is used",
                                     reader.pointer(), given, otherwise));
    return as_float(otherwise);
}

Result<> read_specular(const MaterialReader& reader, const tinygltf::Value& extension, SpecularLayer& layer) {
    layer.weight = factor_of(extension, "specularFactor", 1);
    for (int c = 0; c < 3; ++c)
        layer.color[c] = as_float(std::max(element_of(extension, "specularColorFactor", c, 1), 0.0));
    const std::string place = "extensions/KHR_materials_specular/";
    DARKROOM_TRY(reader.read_into(layer.texture, extension, place + "specularTexture"));
    return reader.read_into(layer.color_texture, extension, place + "specularColorTexture");
}

Result<> read_clearcoat(const MaterialReader& reader, const tinygltf::Value& extension, ClearcoatLayer& layer) {
    layer.weight = factor_of(extension, "clearcoatFactor", 0);
    layer.roughness = factor_of(extension, "clearcoatRoughnessFactor", 0);
    const std::string place = "extensions/KHR_materials_clearcoat/";
    if (extension.Has("clearcoatNormalTexture"))
        layer.normal_scale = as_float(number_of(extension.Get("clearcoatNormalTexture"), "scale", 1));
    DARKROOM_TRY(reader.read_into(layer.texture, extension, place + "clearcoatTexture"));
    DARKROOM_TRY(reader.read_into(layer.roughness_texture, extension, place + "clearcoatRoughnessTexture"));
    return reader.read_into(layer.normal_texture, extension, place + "clearcoatNormalTexture");
}

Result<> read_sheen(const MaterialReader& reader, const tinygltf::Value& extension, SheenLayer& layer) {
    for (int c = 0; c < 3; ++c)
        layer.color[c] = as_float(std::clamp(element_of(extension, "sheenColorFactor", c, 0), 0.0, 1.0));
    layer.roughness = factor_of(extension, "sheenRoughnessFactor", 0);
    const std::string place = "extensions/KHR_materials_sheen/";
    DARKROOM_TRY(reader.read_into(layer.color_texture, extension, place + "sheenColorTexture"));
    return reader.read_into(layer.roughness_texture, extension, place + "sheenRoughnessTexture");
}

Result<> read_layers(const MaterialReader& reader, const tinygltf::ExtensionMap& extensions, ModelMaterial& material) {
    if (const auto found = extensions.find("KHR_materials_ior"); found != extensions.end())
        material.specular.index_of_refraction = index_of_refraction(reader, found->second);
    if (const auto found = extensions.find("KHR_materials_specular"); found != extensions.end())
        DARKROOM_TRY(read_specular(reader, found->second, material.specular));
    if (const auto found = extensions.find("KHR_materials_clearcoat"); found != extensions.end())
        DARKROOM_TRY(read_clearcoat(reader, found->second, material.clearcoat));
    if (const auto found = extensions.find("KHR_materials_sheen"); found != extensions.end())
        DARKROOM_TRY(read_sheen(reader, found->second, material.sheen));
    return {};
}

}  // namespace

double number_of(const tinygltf::Value& object, const std::string& name, double otherwise) {
    if (!object.IsObject() || !object.Has(name)) return otherwise;
    const tinygltf::Value& value = object.Get(name);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

Result<ModelMaterial> convert_material(Document& document, std::size_t index, const std::vector<bool>& is_broken) {
    const std::string pointer = fmt::format("/materials/{}", index);
    DARKROOM_TRY(document.faults().check(pointer));
    const tinygltf::Material& source = document.model().materials[index];
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    ModelMaterial material{.name = source.name};
    for (std::size_t c = 0; c < 4 && c < pbr.baseColorFactor.size(); ++c)
        material.base_color[static_cast<int>(c)] = as_float(pbr.baseColorFactor[c]);
    material.metallic = as_float(pbr.metallicFactor);
    material.roughness = as_float(pbr.roughnessFactor);
    material.normal_scale = as_float(source.normalTexture.scale);
    material.occlusion_strength = as_float(source.occlusionTexture.strength);
    material.alpha_cutoff = as_float(source.alphaCutoff);
    material.is_double_sided = source.doubleSided;
    material.is_unlit = source.extensions.contains("KHR_materials_unlit");
    double strength = 1;
    if (const auto found = source.extensions.find("KHR_materials_emissive_strength"); found != source.extensions.end())
        strength = number_of(found->second, "emissiveStrength", 1);
    for (std::size_t c = 0; c < 3 && c < source.emissiveFactor.size(); ++c)
        material.emissive[static_cast<int>(c)] = as_float(source.emissiveFactor[c] * strength);
    if (source.alphaMode == "MASK")
        material.blend = SurfaceBlend::Mask;
    else if (source.alphaMode == "BLEND")
        material.blend = SurfaceBlend::Alpha;
    else if (source.alphaMode != "OPAQUE")
        document.faults().warn(
            fmt::format("{}/alphaMode: {}, allowed is OPAQUE, MASK and BLEND", pointer, source.alphaMode));

    const MaterialReader reader(document, is_broken, pointer);
    const auto read = [&](const auto& info, const char* place, Texture& texture) -> Result<> {
        DARKROOM_TRY_VALUE(texture, reader.read(info, place));
        return {};
    };
    DARKROOM_TRY(read(pbr.baseColorTexture, "pbrMetallicRoughness/baseColorTexture", material.base_color_texture));
    DARKROOM_TRY(read(pbr.metallicRoughnessTexture, "pbrMetallicRoughness/metallicRoughnessTexture",
                      material.metallic_roughness_texture));
    DARKROOM_TRY(read(source.normalTexture, "normalTexture", material.normal_texture));
    DARKROOM_TRY(read(source.occlusionTexture, "occlusionTexture", material.occlusion_texture));
    DARKROOM_TRY(read(source.emissiveTexture, "emissiveTexture", material.emissive_texture));
    DARKROOM_TRY(read_layers(reader, source.extensions, material));
    return material;
}

}  // namespace darkroom::scene::gltf
