// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression (Khronos Group, 2018) and EXT_meshopt_compression (2021).
#include <fmt/format.h>

#include <array>
#include <utility>

#include "scene/gltf/document.hpp"
#include "scene/packed/draco.hpp"
#include "scene/packed/meshopt.hpp"

namespace darkroom::scene::gltf {
namespace {

constexpr const char* draco_extension = "KHR_draco_mesh_compression";
constexpr const char* meshopt_extension = "EXT_meshopt_compression";

Result<MeshoptDesc> meshopt_desc(const nlohmann::json& extension) {
    DARKROOM_TRY_VALUE(const auto mode, meshopt_mode(extension["mode"].get<std::string>()));
    DARKROOM_TRY_VALUE(const auto filter, meshopt_filter(extension.value("filter", "NONE")));
    const MeshoptDesc desc{.mode = mode,
                           .filter = filter,
                           .count = extension["count"].get<std::uint64_t>(),
                           .stride = extension["byteStride"].get<std::uint64_t>()};
    DARKROOM_TRY(check_meshopt(desc));
    return desc;
}

DracoNumber draco_number(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return DracoNumber::Int8;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return DracoNumber::UInt8;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return DracoNumber::Int16;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return DracoNumber::UInt16;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return DracoNumber::UInt32;
        default:
            return DracoNumber::Float;
    }
}

}  // namespace

void Document::unpack_views(nlohmann::json& views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const std::string pointer = fmt::format("/bufferViews/{}", i);
        if (faults_.check(pointer))
            if (auto done = unpack_view(views[i], i); !done) faults_.add(pointer, done.error().text);
        views[i].erase("extensions");
    }
}

Result<> Document::unpack_view(const nlohmann::json& view, std::size_t index) {
    if (!view.contains("extensions") || !view["extensions"].contains(meshopt_extension)) return {};
    const std::string pointer = fmt::format("/bufferViews/{}", index);
    const std::string place = fmt::format("{}/extensions/{}", pointer, meshopt_extension);
    const nlohmann::json& extension = view["extensions"][meshopt_extension];
    const auto desc = meshopt_desc(extension);
    if (!desc) return user_error(fmt::format("{}/{}", place, desc.error().text));

    const auto buffer = extension["buffer"].get<std::size_t>();
    DARKROOM_TRY(faults_.check(fmt::format("/buffers/{}", buffer)));
    const std::size_t offset = extension.value("byteOffset", std::size_t{0});
    const auto packed_size = extension["byteLength"].get<std::size_t>();
    const std::size_t size = buffers_[buffer].size();
    if (offset > size || packed_size > size - offset)
        return user_error(
            fmt::format("{}: bytes {} to {}, buffer {} has {}", place, offset, offset + packed_size, buffer, size));

    DARKROOM_TRY(budget_.take(place, "elements", desc->count, desc->stride));
    const std::uint64_t bytes = desc->count * desc->stride;
    if (const auto said = view["byteLength"].get<std::uint64_t>(); said != bytes)
        return user_error(fmt::format("{}/byteLength: {}, {} elements of {} bytes are packed", pointer, said,
                                      desc->count, desc->stride));
    if (const std::uint64_t stride = view.value("byteStride", desc->stride); stride != desc->stride)
        return user_error(
            fmt::format("{}/byteStride: {}, that of what is packed is {}", pointer, stride, desc->stride));
    auto unpacked = unpack_meshopt(buffers_[buffer].subspan(offset, packed_size), *desc);
    if (!unpacked) return user_error(fmt::format("{}: {}", place, unpacked.error().text));
    budget_.add_unpacked(packed_size, bytes);
    unpacked_views_[index] = unpacked_.emplace_back(std::move(*unpacked));
    return {};
}

// A fault is one of the mesh.
void Document::unpack_meshes() {
    for (std::size_t mesh = 0; mesh < model_.meshes.size(); ++mesh) {
        const std::string pointer = fmt::format("/meshes/{}", mesh);
        if (!faults_.check(pointer)) continue;
        const std::vector<tinygltf::Primitive>& primitives = model_.meshes[mesh].primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i)
            if (auto done = unpack_primitive(primitives[i], fmt::format("{}/primitives/{}", pointer, i)); !done)
                faults_.add(pointer, done.error().text);
    }
}

Result<> Document::unpack_primitive(const tinygltf::Primitive& primitive, const std::string& pointer) {
    const auto extension = primitive.extensions.find(draco_extension);
    if (extension == primitive.extensions.end()) return {};
    const std::string place = fmt::format("{}/extensions/{}", pointer, draco_extension);
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
        return user_error(fmt::format("{}/mode: {}, only triangles (4) are unpacked", pointer, primitive.mode));
    if (primitive.indices < 0) return user_error(fmt::format("{}/indices: is missing", pointer));
    const int view_index = extension->second.Get("bufferView").GetNumberAsInt();
    const auto packed = view(view_index);
    if (!packed) return failure(Error(packed.error()));
    const auto wrong = [&](std::string_view what) {
        return user_error(fmt::format("{}/bufferView: bufferView {} {}", place, view_index, what));
    };

    std::vector<DracoAttribute> attributes;
    std::vector<int> accessors;
    std::optional<std::uint64_t> vertices;
    const tinygltf::Value& ids = extension->second.Get("attributes");
    for (const std::string& name : ids.Keys()) {
        const auto named = primitive.attributes.find(name);
        if (named == primitive.attributes.end())
            return user_error(fmt::format("{}/attributes/{}: the primitive has no such attribute", place, name));
        const auto shape = layout(named->second);
        if (!shape) return failure(Error(shape.error()));
        if (vertices && *vertices != (*shape)->count)
            return user_error(fmt::format("{}/attributes/{}: accessor {} has {} elements, the others have {}", pointer,
                                          name, named->second, (*shape)->count, *vertices));
        vertices = (*shape)->count;
        attributes.push_back({.id = static_cast<std::uint32_t>(ids.Get(name).GetNumberAsInt()),
                              .components = (*shape)->components,
                              .number = draco_number((*shape)->component_type)});
        accessors.push_back(named->second);
    }
    if (!vertices) return user_error(fmt::format("{}/attributes: is empty", place));
    const auto corners_shape = layout(primitive.indices);
    if (!corners_shape) return failure(Error(corners_shape.error()));
    const std::uint64_t corner_count = (*corners_shape)->count;

    // Primitives of one shape and different materials share all of it.
    accessors.push_back(primitive.indices);
    std::size_t known = 0;
    for (const int accessor : accessors)
        if (const auto found = packed_in_.find(accessor); found != packed_in_.end()) {
            if (found->second != view_index)
                return wrong(fmt::format("has accessor {}, as bufferView {} has", accessor, found->second));
            ++known;
        }
    if (known == accessors.size()) return {};

    const auto head = read_draco_head(*packed);
    if (!head) return wrong(head.error().text);
    if (head->triangles * 3 != corner_count)
        return wrong(fmt::format("has {} triangles, accessor {} has {} corners", head->triangles, primitive.indices,
                                 corner_count));
    if (head->vertices > *vertices || (head->has_all_vertices && head->vertices != *vertices))
        return wrong(fmt::format("has {} vertices, its accessors have {}", head->vertices, *vertices));
    std::uint64_t vertex_bytes = 0;
    for (const DracoAttribute& attribute : attributes) vertex_bytes += attribute.components * sizeof(float);
    budget_.add_unpacked(packed->size(), *vertices * vertex_bytes + corner_count * sizeof(std::uint32_t));
    const std::uint64_t kept = budget_.taken();
    DARKROOM_TRY(budget_.take(place, "corners", corner_count, sizeof(std::uint32_t)));
    DARKROOM_TRY(budget_.take(place, "vertices", *vertices, vertex_bytes));
    const std::uint64_t result = budget_.taken();
    DARKROOM_TRY(budget_.take(place, "triangles", head->triangles, head->bytes_per_triangle));
    const auto admit = [&](std::uint64_t count, std::uint64_t bytes) {
        return budget_.take(place, "packed vertices", count, bytes);
    };
    std::vector<std::uint32_t> corners;
    auto unpacked = unpack_draco(*packed, *vertices, admit, attributes, corners);
    if (!unpacked || corners.size() != corner_count) {
        budget_.give_back_to(kept);
        return unpacked ? wrong(fmt::format("is damaged: {} corners of {}", corners.size(), corner_count))
                        : wrong(unpacked.error().text);
    }
    budget_.give_back_to(result);

    const auto keep = [&](int accessor, std::vector<std::byte> values, std::size_t stride) {
        Layout& layout = *layouts_[static_cast<std::size_t>(accessor)];
        layout.data = unpacked_.emplace_back(std::move(values));
        layout.stride = stride;
        layout.sparse_count = 0;
        packed_in_[accessor] = view_index;
    };
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        const std::size_t stride = attributes[i].values.size() / *vertices;
        keep(accessors[i], std::move(attributes[i].values), stride);
    }
    const auto bytes = std::as_bytes(std::span(corners));
    keep(primitive.indices, {bytes.begin(), bytes.end()}, sizeof(std::uint32_t));
    layouts_[static_cast<std::size_t>(primitive.indices)]->component_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    return {};
}

}  // namespace darkroom::scene::gltf
