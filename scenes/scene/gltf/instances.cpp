// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing (Khronos Group, vendor extension, 2018).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/gltf/convert.hpp"
#include "scene/gltf/tables.hpp"

namespace darkroom::scene::gltf {
namespace {

constexpr const char* instancing = "EXT_mesh_gpu_instancing";

struct InstanceAttribute {
    const char* name;
    std::uint32_t components;
};
constexpr std::array instance_attributes{InstanceAttribute{"TRANSLATION", 3}, InstanceAttribute{"ROTATION", 4},
                                         InstanceAttribute{"SCALE", 3}};

/// Nothing of what is not given.
using InstanceNumbers = std::array<std::optional<Numbers>, instance_attributes.size()>;

Result<> read_attribute(Document& document, int accessor, const InstanceAttribute& attribute, const std::string& place,
                        std::optional<std::size_t>& count, std::optional<Numbers>& out) {
    const auto wrong = [&](const std::string& what) {
        return user_error(fmt::format("{}/{}: accessor {} {}", place, attribute.name, accessor, what));
    };
    DARKROOM_TRY_VALUE(auto layout, document.layout(accessor));
    const Layout& shape = *layout;
    if (shape.components != attribute.components)
        return wrong(fmt::format("has {} components, {} are needed", shape.components, attribute.components));
    const bool may_be_integers = attribute.components == 4 && shape.is_normalized;
    if (shape.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT && !may_be_integers)
        return wrong("has integers that are not normalized, or no rotations");
    if (count && *count != shape.count)
        return wrong(fmt::format("has {} elements, the others have {}", shape.count, *count));
    count = shape.count;
    DARKROOM_TRY_VALUE(auto numbers, document.numbers(accessor));
    if (!std::ranges::all_of(numbers.values, [](float value) { return std::isfinite(value); }))
        return wrong("has a value that is not finite");
    out = std::move(numbers);
    return {};
}

Transform transform_of(const InstanceNumbers& numbers, std::size_t i) {
    const auto& [translations, rotations, scales] = numbers;
    Transform out;
    for (int c = 0; c < 3; ++c) {
        const std::size_t at = i * 3 + static_cast<std::size_t>(c);
        if (translations) out.position[c] = translations->values[at];
        if (scales) out.scale[c] = scales->values[at];
    }
    if (rotations) {
        const float* xyzw = rotations->values.data() + i * 4;
        const quat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
        const float length = glm::length(rotation);
        if (length > 1e-6F) out.rotation = rotation / length;
    }
    return out;
}

std::vector<bool> nodes_with_moving_weights(const Model& model) {
    std::vector<bool> out(model.nodes.size());
    for (const Animation& animation : model.animations)
        for (const AnimationChannel& channel : animation.channels)
            if (channel.property == AnimatedProperty::Weights) out[channel.node] = true;
    return out;
}

Result<> add_instances_of(Document& document, std::uint32_t file_index, std::uint32_t node, bool has_moving_weights,
                          Model& model) {
    const tinygltf::Node& source = document.model().nodes[file_index];
    const auto found = source.extensions.find(instancing);
    if (found == source.extensions.end()) return {};
    const std::string pointer = fmt::format("/nodes/{}", file_index);
    const std::string place = fmt::format("{}/extensions/{}/attributes", pointer, instancing);
    if (model.nodes[node].mesh == no_index) {
        document.faults().warn(fmt::format("{}/extensions/{}: the node has no mesh", pointer, instancing));
        return {};
    }
    if (model.nodes[node].skin != no_index) {
        document.faults().warn(
            fmt::format("{}/extensions/{}: the node has a skin, and is drawn once", pointer, instancing));
        return {};
    }
    const std::uint64_t taken = document.budget().taken();
    const tinygltf::Value& attributes = found->second.Get("attributes");
    std::optional<std::size_t> count;
    InstanceNumbers numbers;
    for (std::size_t i = 0; i < instance_attributes.size(); ++i) {
        const InstanceAttribute& attribute = instance_attributes[i];
        if (!attributes.Has(attribute.name)) continue;
        const int accessor = attributes.Get(attribute.name).GetNumberAsInt();
        DARKROOM_TRY(read_attribute(document, accessor, attribute, place, count, numbers[i]));
    }
    if (!count) {
        document.faults().warn(fmt::format("{}: none of TRANSLATION, ROTATION and SCALE; it is drawn once", place));
        return {};
    }
    const std::uint64_t weights = model.nodes[node].weights.size() * sizeof(float);
    DARKROOM_TRY(document.budget().take(place, "instances", *count, element_size + weights));
    Node instance{.name = model.nodes[node].name, .parent = node};
    std::swap(instance.mesh, model.nodes[node].mesh);
    std::swap(instance.weights, model.nodes[node].weights);
    if (has_moving_weights)
        document.faults().warn(
            fmt::format("{}/extensions/{}: morph targets of instances stand still", pointer, instancing));
    for (std::size_t i = 0; i < *count; ++i) {
        instance.transform = transform_of(numbers, i);
        model.nodes.push_back(instance);
    }
    document.budget().give_back_to(taken);
    return document.budget().take(place, "instances", *count, element_size + weights);
}

}  // namespace

Result<> add_instances(Document& document, const NodeOrder& order, Model& model) {
    const std::vector<bool> moves = nodes_with_moving_weights(model);
    for (std::uint32_t node = 0; node < order.file_index.size(); ++node)
        DARKROOM_TRY(add_instances_of(document, order.file_index[node], node, moves[node], model));
    return {};
}

}  // namespace darkroom::scene::gltf
