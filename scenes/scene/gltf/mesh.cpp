// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/gltf/convert.hpp"
#include "scene/mesh/geometry.hpp"

namespace darkroom::scene::gltf {
namespace {

using Attributes = std::map<std::string, int>;

/// Which types an attribute may have beside floats.
enum class Integers { Quantized, Normalized, Plain };

/// Reads the attributes of one primitive or morph target. All have one count.
class AttributeReader {
  public:
    AttributeReader(Document& document, const Attributes& attributes, std::string pointer)
        : document_(document), attributes_(attributes), pointer_(std::move(pointer)) {}

    [[nodiscard]] bool has(const std::string& name) const { return attributes_.contains(name); }
    void set_count(std::size_t count) { count_ = count; }
    [[nodiscard]] std::size_t count() const { return count_.value_or(0); }

    // An accessor of `components` (or one more, if `has_optional_component`) numbers; nothing if it is absent.
    Result<std::optional<Numbers>> read(const std::string& name, std::uint32_t components, Integers integers,
                                        bool has_optional_component = false) {
        const auto found = attributes_.find(name);
        if (found == attributes_.end()) return std::nullopt;
        DARKROOM_TRY_VALUE(auto layout, document_.layout(found->second));
        const Layout& shape = *layout;
        const auto wrong = [&](const std::string& what) {
            return user_error(fmt::format("{}/{}: accessor {} {}", pointer_, name, found->second, what));
        };
        if (shape.components != components && !(has_optional_component && shape.components == components + 1))
            return wrong(fmt::format("has {} components, {} are needed", shape.components, components));
        if (shape.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return wrong("has 32-bit integers");
        if (shape.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT) {
            const bool is_allowed = integers == Integers::Quantized ? document_.uses_extension("KHR_mesh_quantization")
                                                                    : shape.is_normalized;
            if (!is_allowed)
                document_.faults().warn(fmt::format("{}/{}: accessor {} has integers that are not allowed here",
                                                    pointer_, name, found->second));
        }
        if (count_ && shape.count != *count_)
            return wrong(fmt::format("has {} elements, the others have {}", shape.count, *count_));
        DARKROOM_TRY_VALUE(auto numbers, document_.numbers(found->second));
        count_ = shape.count;
        const auto is_bad = [](float value) { return !std::isfinite(value); };
        if (std::any_of(numbers.values.begin(), numbers.values.end(), is_bad)) {
            if (name == "POSITION") return wrong("has a value that is not finite");
            document_.faults().warn(fmt::format("{}/{}: accessor {} has values that are not finite; they are read as 0",
                                                pointer_, name, found->second));
            std::replace_if(numbers.values.begin(), numbers.values.end(), is_bad, 0.0F);
        }
        return std::optional<Numbers>(std::move(numbers));
    }

    Result<std::optional<std::vector<std::uint32_t>>> read_joints(const std::string& name) {
        const auto found = attributes_.find(name);
        if (found == attributes_.end()) return std::nullopt;
        DARKROOM_TRY_VALUE(auto layout, document_.layout(found->second));
        if (layout->components != 4 || layout->count != count())
            return user_error(fmt::format("{}/{}: accessor {} has {} elements of {} numbers, {} of 4 are needed",
                                          pointer_, name, found->second, layout->count, layout->components, count()));
        DARKROOM_TRY_VALUE(auto joints, document_.integers(found->second));
        return std::optional<std::vector<std::uint32_t>>(std::move(joints));
    }

  private:
    Document& document_;
    const Attributes& attributes_;
    std::string pointer_;
    std::optional<std::size_t> count_;
};

vec3 vec3_at(const Numbers& numbers, std::size_t i) {
    const float* value = numbers.values.data() + i * numbers.components;
    return {value[0], value[1], value[2]};
}

void warn_without_extent(Document& document, int accessor) {
    const tinygltf::Accessor& source = document.model().accessors[static_cast<std::size_t>(accessor)];
    if (source.minValues.size() != 3 || source.maxValues.size() != 3)
        document.faults().warn(fmt::format("/accessors/{}: positions without min and max", accessor));
}

Result<> read_vertices(Document& document, AttributeReader& reader, const tinygltf::Primitive& source,
                       Primitive& primitive) {
    DARKROOM_TRY_VALUE(auto positions, reader.read("POSITION", 3, Integers::Quantized));
    DARKROOM_TRY(document.budget().take("/meshes", "vertices", reader.count(), sizeof(Vertex)));
    primitive.vertices.resize(reader.count());
    for (std::size_t i = 0; i < reader.count(); ++i) {
        primitive.vertices[i].position = vec3_at(*positions, i);
        primitive.bounds.add(primitive.vertices[i].position);
    }
    warn_without_extent(document, source.attributes.at("POSITION"));

    DARKROOM_TRY_VALUE(auto normals, reader.read("NORMAL", 3, Integers::Quantized));
    DARKROOM_TRY_VALUE(auto tangents, reader.read("TANGENT", 4, Integers::Quantized));
    DARKROOM_TRY_VALUE(auto uv0, reader.read("TEXCOORD_0", 2,
                                             document.uses_extension("KHR_mesh_quantization") ? Integers::Quantized
                                                                                              : Integers::Normalized));
    DARKROOM_TRY_VALUE(auto uv1, reader.read("TEXCOORD_1", 2,
                                             document.uses_extension("KHR_mesh_quantization") ? Integers::Quantized
                                                                                              : Integers::Normalized));
    DARKROOM_TRY_VALUE(auto colors, reader.read("COLOR_0", 3, Integers::Normalized, true));
    const auto is_outside = [](float value) { return value < 0 || value > 1; };
    if (colors && std::any_of(colors->values.begin(), colors->values.end(), is_outside))
        document.faults().warn(fmt::format("/accessors/{}: colours outside [0, 1], which are brought into it",
                                           source.attributes.at("COLOR_0")));
    for (std::size_t i = 0; i < reader.count(); ++i) {
        Vertex& vertex = primitive.vertices[i];
        if (normals) {
            const vec3 normal = vec3_at(*normals, i);
            const float length = glm::length(normal);
            if (length > 0 && std::isfinite(length)) vertex.normal = normal / length;
            if (tangents) {
                const float* tangent = tangents->values.data() + i * 4;
                const vec3 direction(tangent[0], tangent[1], tangent[2]);
                const float size = glm::length(direction);
                if (size > 0 && std::isfinite(size)) vertex.tangent = vec4(direction / size, tangent[3] < 0 ? -1 : 1);
            }
        }
        if (uv0) vertex.uv0 = {uv0->values[i * 2], uv0->values[i * 2 + 1]};
        if (uv1) vertex.uv1 = {uv1->values[i * 2], uv1->values[i * 2 + 1]};
        if (colors)
            for (std::uint32_t c = 0; c < colors->components; ++c)
                vertex.color[static_cast<int>(c)] = std::clamp(colors->values[i * colors->components + c], 0.0F, 1.0F);
    }
    return {};
}

// The four largest of up to eight influences, made to sum to 1.
VertexSkin largest_influences(std::array<std::pair<float, std::uint32_t>, 8>& influences) {
    std::stable_sort(influences.begin(), influences.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    VertexSkin out;
    float sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += influences[i].first;
    if (!(sum > 0) || !std::isfinite(sum)) return out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.weights[static_cast<int>(i)] = influences[i].first / sum;
        out.joints[i] = influences[i].first > 0 ? static_cast<std::uint16_t>(influences[i].second) : std::uint16_t{0};
    }
    return out;
}

Result<> read_skin(Document& document, AttributeReader& reader, const std::string& pointer, Primitive& primitive) {
    if (!reader.has("JOINTS_0") && !reader.has("WEIGHTS_0")) return {};
    constexpr std::uint64_t size = sizeof(VertexSkin) + sizeof(std::array<std::pair<float, std::uint32_t>, 8>);
    DARKROOM_TRY(document.budget().take("/meshes", "skinned vertices", reader.count(), size));
    std::vector<std::array<std::pair<float, std::uint32_t>, 8>> influences(reader.count());
    for (std::size_t set = 0; set < 2; ++set) {
        const std::string joints_name = fmt::format("JOINTS_{}", set);
        const std::string weights_name = fmt::format("WEIGHTS_{}", set);
        if (reader.has(joints_name) != reader.has(weights_name))
            return user_error(fmt::format("{}: {} and {} need each other", pointer, joints_name, weights_name));
        DARKROOM_TRY_VALUE(auto joints, reader.read_joints(joints_name));
        DARKROOM_TRY_VALUE(auto weights, reader.read(weights_name, 4, Integers::Normalized));
        if (!joints || !weights) continue;
        for (std::size_t i = 0; i < reader.count() * 4; ++i) {
            const std::uint32_t joint = (*joints)[i];
            const float weight = std::max(weights->values[i], 0.0F);
            if (joint > 0xffff && weight > 0)
                return user_error(
                    fmt::format("{}/{}: joint {}, at most 65535 is allowed", pointer, joints_name, joint));
            influences[i / 4][set * 4 + i % 4] = {weight, joint};
        }
    }
    primitive.skin.reserve(reader.count());
    for (auto& influence : influences) primitive.skin.push_back(largest_influences(influence));
    return {};
}

Result<> read_targets(Document& document, const tinygltf::Primitive& source, const std::string& pointer,
                      bool has_normals, Primitive& primitive) {
    for (std::size_t t = 0; t < source.targets.size(); ++t) {
        AttributeReader reader(document, source.targets[t], fmt::format("{}/targets/{}", pointer, t));
        reader.set_count(primitive.vertices.size());
        for (const auto& [name, accessor] : source.targets[t])
            if (!source.attributes.contains(name))
                document.faults().warn(
                    fmt::format("{}/targets/{}/{}: the primitive has no such attribute", pointer, t, name));
        DARKROOM_TRY_VALUE(auto positions, reader.read("POSITION", 3, Integers::Quantized));
        if (positions) warn_without_extent(document, source.targets[t].at("POSITION"));
        DARKROOM_TRY_VALUE(auto normals, reader.read("NORMAL", 3, Integers::Quantized));
        DARKROOM_TRY(document.budget().take("/meshes", "vertices of morph targets", primitive.vertices.size(),
                                            2 * sizeof(vec3)));
        MorphTarget target;
        target.positions.resize(primitive.vertices.size());
        if (positions)
            for (std::size_t i = 0; i < target.positions.size(); ++i) target.positions[i] = vec3_at(*positions, i);
        if (normals && has_normals) {
            target.normals.resize(primitive.vertices.size());
            for (std::size_t i = 0; i < target.normals.size(); ++i) target.normals[i] = vec3_at(*normals, i);
        }
        primitive.targets.push_back(std::move(target));
    }
    return {};
}

Result<std::vector<std::uint32_t>> read_corners(Document& document, const tinygltf::Primitive& source,
                                                const std::string& pointer, std::size_t vertex_count) {
    if (source.indices < 0) {
        DARKROOM_TRY(document.budget().take(pointer, "corners", vertex_count, sizeof(std::uint32_t)));
        std::vector<std::uint32_t> corners(vertex_count);
        for (std::size_t i = 0; i < vertex_count; ++i) corners[i] = static_cast<std::uint32_t>(i);
        return corners;
    }
    DARKROOM_TRY_VALUE(auto layout, document.layout(source.indices));
    if (layout->components != 1)
        return user_error(fmt::format("{}/indices: accessor {} is not a SCALAR", pointer, source.indices));
    if (const int view = document.model().accessors[static_cast<std::size_t>(source.indices)].bufferView; view >= 0)
        if (document.model().bufferViews[static_cast<std::size_t>(view)].byteStride != 0)
            document.faults().warn(fmt::format("{}/indices: bufferView {} has a byteStride", pointer, view));
    DARKROOM_TRY_VALUE(auto corners, document.integers(source.indices));
    std::uint32_t restart = 0xffffffff;
    if (layout->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) restart = 0xff;
    if (layout->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) restart = 0xffff;
    if (std::find(corners.begin(), corners.end(), restart) != corners.end())
        document.faults().warn(
            fmt::format("{}/indices: accessor {} has the index {}, which some readers take for a "
                        "restart",
                        pointer, source.indices, restart));
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (corners[i] >= vertex_count)
            return user_error(fmt::format("{}/indices: number {} of accessor {} is {}, there are {} vertices", pointer,
                                          i, source.indices, corners[i], vertex_count));
    return corners;
}

void check_names(Document& document, const tinygltf::Primitive& source, const std::string& pointer) {
    static constexpr std::array<std::string_view, 3> plain{"POSITION", "NORMAL", "TANGENT"};
    static constexpr std::array<std::string_view, 4> numbered{"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    for (const auto& attribute : source.attributes) {
        const std::string& name = attribute.first;
        const bool is_plain = std::find(plain.begin(), plain.end(), name) != plain.end() || name.starts_with('_');
        const bool is_numbered = std::any_of(numbered.begin(), numbered.end(), [&](std::string_view start) {
            return name.starts_with(start) && name.size() > start.size();
        });
        if (!is_plain && !is_numbered)
            document.faults().warn(fmt::format("{}/attributes/{}: no attribute of this name exists", pointer, name));
        if (document.model().accessors[static_cast<std::size_t>(attribute.second)].componentType ==
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            document.faults().warn(fmt::format("{}/attributes/{}: has 32-bit integers", pointer, name));
    }
}

// Of variants that are named twice the first counts.
std::vector<VariantMaterial> read_variants(const tinygltf::Primitive& source) {
    std::vector<VariantMaterial> out;
    const auto found = source.extensions.find("KHR_materials_variants");
    if (found == source.extensions.end()) return out;
    const tinygltf::Value& mappings = found->second.Get("mappings");
    for (int i = 0; i < static_cast<int>(mappings.ArrayLen()); ++i) {
        const tinygltf::Value& mapping = mappings.Get(i);
        const auto material = static_cast<std::uint32_t>(number_of(mapping, "material", 0));
        const tinygltf::Value& variants = mapping.Get("variants");
        for (int k = 0; k < static_cast<int>(variants.ArrayLen()); ++k)
            out.push_back({static_cast<std::uint32_t>(variants.Get(k).GetNumberAsInt()), material});
    }
    std::ranges::stable_sort(out, {}, &VariantMaterial::variant);
    // Not std::ranges::unique, whose subrange clang 14 cannot read in the standard library of gcc 12.
    const auto is_same = [](const auto& a, const auto& b) { return a.variant == b.variant; };
    out.erase(std::unique(out.begin(), out.end(), is_same), out.end());
    return out;
}

// Nothing: there is nothing to draw.
Result<std::optional<Primitive>> convert_primitive(Document& document, const tinygltf::Primitive& source,
                                                   const std::string& pointer) {
    check_names(document, source, pointer);
    if (source.mode < TINYGLTF_MODE_POINTS || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return user_error(fmt::format("{}/mode: {}, allowed is [0, 6]", pointer, source.mode));
    if (!source.attributes.contains("POSITION")) {
        document.faults().warn(fmt::format("{}: has no positions and is not drawn", pointer));
        return std::nullopt;
    }
    Budget& budget = document.budget();
    const std::uint64_t taken = budget.taken();
    AttributeReader reader(document, source.attributes, fmt::format("{}/attributes", pointer));
    Primitive primitive;
    DARKROOM_TRY(read_vertices(document, reader, source, primitive));
    DARKROOM_TRY(read_skin(document, reader, fmt::format("{}/attributes", pointer), primitive));
    const bool has_normals = reader.has("NORMAL");
    DARKROOM_TRY(read_targets(document, source, pointer, has_normals, primitive));
    DARKROOM_TRY_VALUE(auto corners, read_corners(document, source, pointer, primitive.vertices.size()));
    if (source.mode < TINYGLTF_MODE_TRIANGLES) {
        document.faults().warn(fmt::format("{}: points and lines are not drawn", pointer));
        budget.give_back_to(taken);
        return std::nullopt;
    }
    if (source.material >= 0) primitive.material = static_cast<std::uint32_t>(source.material);
    primitive.variants = read_variants(source);
    if (source.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
        document.faults().warn(fmt::format("{}: {} corners do not make whole triangles; the last are passed over",
                                           pointer, corners.size()));
    DARKROOM_TRY(budget.take(pointer, "corners", corners.size(), 3 * sizeof(std::uint32_t)));
    primitive.indices = triangles_of(corners, source.mode);
    if (!has_normals) {
        const std::size_t vertex_size =
            sizeof(Vertex) + sizeof(VertexSkin) + primitive.targets.size() * 2 * sizeof(vec3);
        DARKROOM_TRY(budget.take(pointer, "vertices", primitive.indices.size(), vertex_size));
        make_flat(primitive);
    } else {
        drop_unused_vertices(primitive);
    }
    if (primitive.indices.empty()) {
        document.faults().warn(fmt::format("{}: has no triangles", pointer));
        budget.give_back_to(taken);
        return std::nullopt;
    }
    primitive.bounds = {};
    for (const Vertex& vertex : primitive.vertices) primitive.bounds.add(vertex.position);
    // From here on only the result takes memory.
    budget.give_back_to(taken);
    DARKROOM_TRY(budget.take(pointer, "bytes", size_in_memory(primitive), 1));
    return std::optional<Primitive>(std::move(primitive));
}

}  // namespace

Result<Mesh> convert_mesh(Document& document, std::size_t index) {
    const std::string pointer = fmt::format("/meshes/{}", index);
    DARKROOM_TRY(document.faults().check(pointer));
    const tinygltf::Mesh& source = document.model().meshes[index];
    Mesh mesh{.name = source.name};
    std::size_t target_count = 0;
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const std::size_t targets = source.primitives[i].targets.size();
        if (i > 0 && targets != target_count)
            return user_error(fmt::format("{}/primitives/{}/targets: {} morph targets, the first primitive has {}",
                                          pointer, i, targets, target_count));
        target_count = targets;
        DARKROOM_TRY_VALUE(auto primitive, convert_primitive(document, source.primitives[i],
                                                             fmt::format("{}/primitives/{}", pointer, i)));
        if (primitive) mesh.primitives.push_back(std::move(*primitive));
    }
    if (!source.weights.empty() && source.weights.size() != target_count)
        document.faults().warn(
            fmt::format("{}/weights: {} numbers for {} morph targets", pointer, source.weights.size(), target_count));
    for (const double weight : source.weights) mesh.weights.push_back(static_cast<float>(weight));
    mesh.weights.resize(target_count);
    return mesh;
}

}  // namespace darkroom::scene::gltf
