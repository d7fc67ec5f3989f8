// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "scene/gltf/convert.hpp"

namespace darkroom::scene::gltf {
namespace {

std::optional<Interpolation> interpolation_of(const std::string& name) {
    if (name.empty() || name == "LINEAR") return Interpolation::Linear;
    if (name == "STEP") return Interpolation::Step;
    if (name == "CUBICSPLINE") return Interpolation::CubicSpline;
    return std::nullopt;
}

std::optional<AnimatedProperty> property_of(const std::string& path) {
    if (path == "translation") return AnimatedProperty::Translation;
    if (path == "rotation") return AnimatedProperty::Rotation;
    if (path == "scale") return AnimatedProperty::Scale;
    if (path == "weights") return AnimatedProperty::Weights;
    return std::nullopt;
}

bool all_finite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

Result<> read_times(Document& document, int accessor, const std::string& pointer, std::vector<float>& times) {
    DARKROOM_TRY_VALUE(auto layout, document.layout(accessor));
    if (layout->components != 1 || layout->component_type != TINYGLTF_COMPONENT_TYPE_FLOAT)
        return user_error(fmt::format("{}/input: accessor {} is not a SCALAR of floats", pointer, accessor));
    DARKROOM_TRY_VALUE(auto numbers, document.numbers(accessor));
    times = std::move(numbers.values);
    if (!all_finite(times) || times.front() < 0)
        return user_error(fmt::format("{}/input: a time of accessor {} is negative or not finite", pointer, accessor));
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!(times[i] > times[i - 1]))
            return user_error(fmt::format("{}/input: times of accessor {} do not increase: {} after {}", pointer,
                                          accessor, times[i], times[i - 1]));
    const tinygltf::Accessor& source = document.model().accessors[static_cast<std::size_t>(accessor)];
    if (source.minValues.size() != 1 || source.maxValues.size() != 1)
        document.faults().warn(fmt::format("/accessors/{}: times without min and max", accessor));
    return {};
}

// Linear and stepped keys and the values of splines; tangents are no rotations.
void normalize_rotations(AnimationChannel& channel, Document& document, const std::string& pointer) {
    const bool is_spline = channel.interpolation == Interpolation::CubicSpline;
    bool is_reported = false;
    for (std::size_t i = 0; i * 4 < channel.values.size(); ++i) {
        if (is_spline && i % 3 != 1) continue;
        float* value = channel.values.data() + i * 4;
        const float length = std::hypot(std::hypot(value[0], value[1]), std::hypot(value[2], value[3]));
        if (std::abs(length - 1) > 0.01F && !is_reported) {
            document.faults().warn(fmt::format("{}/output: a rotation of length {}, 1 is needed", pointer, length));
            is_reported = true;
        }
        if (!(length > 1e-6F)) {
            std::fill_n(value, 3, 0.0F);
            value[3] = 1;
            continue;
        }
        for (int c = 0; c < 4; ++c) value[c] /= length;
    }
}

Result<> read_values(Document& document, int accessor, const std::string& pointer, AnimationChannel& channel) {
    DARKROOM_TRY_VALUE(auto layout, document.layout(accessor));
    const bool is_weights = channel.property == AnimatedProperty::Weights;
    const std::uint32_t components = is_weights ? 1 : channel.width;
    const Layout& shape = *layout;
    if (shape.components != components)
        return user_error(fmt::format("{}/output: accessor {} has {} components, {} are needed", pointer, accessor,
                                      shape.components, components));
    if (shape.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT && !shape.is_normalized)
        return user_error(
            fmt::format("{}/output: accessor {} has integers that are not normalized", pointer, accessor));
    const std::size_t per_key = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
    const std::size_t needed = channel.times.size() * per_key * (is_weights ? channel.width : 1);
    if (shape.count != needed)
        return user_error(fmt::format("{}/output: accessor {} has {} elements, {} are needed for {} times", pointer,
                                      accessor, shape.count, needed, channel.times.size()));
    DARKROOM_TRY_VALUE(auto numbers, document.numbers(accessor));
    channel.values = std::move(numbers.values);
    if (!all_finite(channel.values))
        return user_error(fmt::format("{}/output: accessor {} has a value that is not finite", pointer, accessor));
    if (channel.property == AnimatedProperty::Rotation) normalize_rotations(channel, document, pointer);
    const tinygltf::Accessor& source = document.model().accessors[static_cast<std::size_t>(accessor)];
    if (source.bufferView >= 0 &&
        document.model().bufferViews[static_cast<std::size_t>(source.bufferView)].byteStride != 0)
        document.faults().warn(fmt::format("{}/output: bufferView {} has a byteStride", pointer, source.bufferView));
    return {};
}

// Nothing: the channel moves nothing that is drawn.
Result<std::optional<AnimationChannel>> convert_channel(Document& document, const tinygltf::Animation& animation,
                                                        const tinygltf::AnimationChannel& source,
                                                        const std::string& pointer, const NodeOrder& order,
                                                        const Model& model) {
    const std::string target = fmt::format("{}/channels/{}/target", pointer, &source - animation.channels.data());
    const auto property = property_of(source.target_path);
    if (!property) {
        document.faults().warn(fmt::format("{}/path: {} is not animated here", target, source.target_path));
        return std::nullopt;
    }
    if (source.sampler < 0 || static_cast<std::size_t>(source.sampler) >= animation.samplers.size())
        return user_error(
            fmt::format("{}: sampler {}, there are {}", target, source.sampler, animation.samplers.size()));
    const std::uint32_t node = order.new_index[static_cast<std::size_t>(source.target_node)];
    AnimationChannel channel{.node = node, .property = *property};
    if (*property == AnimatedProperty::Rotation) channel.width = 4;
    if (*property == AnimatedProperty::Weights) {
        const int mesh = document.model().nodes[static_cast<std::size_t>(source.target_node)].mesh;
        channel.width =
            mesh < 0 ? 0 : static_cast<std::uint32_t>(model.meshes[static_cast<std::size_t>(mesh)].weights.size());
        if (channel.width == 0)
            return user_error(fmt::format("{}: node {} has no morph targets", target, source.target_node));
    }
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(source.sampler)];
    const std::string place = fmt::format("{}/samplers/{}", pointer, source.sampler);
    const auto interpolation = interpolation_of(sampler.interpolation);
    if (!interpolation)
        return user_error(
            fmt::format("{}/interpolation: {}, allowed is STEP, LINEAR and CUBICSPLINE", place, sampler.interpolation));
    channel.interpolation = *interpolation;
    DARKROOM_TRY(read_times(document, sampler.input, place, channel.times));
    if (*interpolation == Interpolation::CubicSpline && channel.times.size() < 2)
        document.faults().warn(fmt::format("{}/input: one time, a spline needs two", place));
    DARKROOM_TRY(read_values(document, sampler.output, place, channel));
    if (node == no_index) return std::nullopt;
    if (model.nodes[node].matrix && *property != AnimatedProperty::Weights) {
        document.faults().warn(fmt::format("{}: node {} has a matrix and is not animated", target, source.target_node));
        return std::nullopt;
    }
    return std::optional<AnimationChannel>(std::move(channel));
}

}  // namespace

Result<Animation> convert_animation(Document& document, std::size_t index, const NodeOrder& order, const Model& model) {
    const std::string pointer = fmt::format("/animations/{}", index);
    DARKROOM_TRY(document.faults().check(pointer));
    const tinygltf::Animation& source = document.model().animations[index];
    Animation animation{.name = source.name};
    std::set<std::pair<int, std::string>> targets;
    for (const tinygltf::AnimationChannel& from : source.channels) {
        if (!targets.emplace(from.target_node, from.target_path).second) {
            document.faults().warn(fmt::format("{}/channels/{}: node {} has a channel for {} already", pointer,
                                               &from - source.channels.data(), from.target_node, from.target_path));
            continue;
        }
        DARKROOM_TRY_VALUE(auto channel, convert_channel(document, source, from, pointer, order, model));
        if (!channel) continue;
        animation.duration = std::max(animation.duration, channel->times.back());
        animation.channels.push_back(std::move(*channel));
    }
    return animation;
}

}  // namespace darkroom::scene::gltf
