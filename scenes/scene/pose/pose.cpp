// SPDX-License-Identifier: MIT
// Keyframes after the glTF 2.0 specification, appendix C "Animation Sampler Interpolation Modes".
#include <algorithm>
#include <cmath>
#include <span>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

namespace {

double looped(double time, double duration) {
    if (!(duration > 0) || !std::isfinite(time)) return 0;
    const double rest = std::fmod(time, duration);
    return rest < 0 ? rest + duration : rest;
}

/// How many times a clip that loops has begun again.
double rounds(double time, double duration) { return std::round((time - looped(time, duration)) / duration); }

/// Between two keys of a channel, of its number that differs the most.
double gap(const AnimationChannel& channel, std::size_t a, std::size_t b) {
    const bool is_spline = channel.interpolation == Interpolation::CubicSpline;
    const auto value = [&](std::size_t key, std::size_t i) {
        return static_cast<double>(channel.values[(is_spline ? key * 3 + 1 : key) * channel.width + i]);
    };
    double apart = 0, against = 0;  // quaternions of both signs are one rotation
    for (std::size_t i = 0; i < channel.width; ++i) {
        apart = std::max(apart, std::abs(value(a, i) - value(b, i)));
        against = std::max(against, std::abs(value(a, i) + value(b, i)));
    }
    return channel.property == AnimatedProperty::Rotation ? std::min(apart, against) : apart;
}

/// Whether the way from the last key to the first is longer than any other that takes `seconds`.
bool jumps_at_its_end(const AnimationChannel& channel, double seconds) {
    double fastest = 0;
    for (std::size_t key = 1; key < channel.times.size(); ++key)
        fastest = std::max(fastest, gap(channel, key - 1, key) / (static_cast<double>(channel.times[key]) -
                                                                  static_cast<double>(channel.times[key - 1])));
    return gap(channel, channel.times.size() - 1, 0) > fastest * seconds;
}

quat to_quat(std::span<const float> xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

quat unit(const quat& rotation) {
    const float length = glm::length(rotation);
    return length > 0 ? rotation / length : quat(1, 0, 0, 0);
}

class Sampler {
  public:
    Sampler(const AnimationChannel& channel, double time) : channel_(channel) {
        const std::vector<float>& times = channel.times;
        const auto later = std::upper_bound(times.begin(), times.end(), time,
                                            [](double value, float key) { return value < static_cast<double>(key); });
        key_ = later == times.begin() ? 0 : static_cast<std::size_t>(later - times.begin()) - 1;
        if (later == times.begin() || later == times.end()) return;  // before the first key and after the last
        seconds_ = static_cast<double>(*later) - static_cast<double>(times[key_]);
        fraction_ = (time - static_cast<double>(times[key_])) / seconds_;
    }

    [[nodiscard]] static bool is_complete(const AnimationChannel& channel) {
        const std::size_t parts = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
        return !channel.times.empty() && channel.values.size() >= channel.times.size() * channel.width * parts;
    }

    void sample(std::span<float> out) const {
        const bool is_spline = channel_.interpolation == Interpolation::CubicSpline;
        const std::span<const float> from = is_spline ? part(key_, 1) : part(key_, 0);
        if (!is_between()) {
            std::copy_n(from.begin(), out.size(), out.begin());
            return;
        }
        const std::span<const float> to = is_spline ? part(key_ + 1, 1) : part(key_ + 1, 0);
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double a = static_cast<double>(from[i]), b = static_cast<double>(to[i]);
            out[i] = static_cast<float>(is_spline ? hermite(a, part(key_, 2)[i], b, part(key_ + 1, 0)[i])
                                                  : a + (b - a) * fraction_);
        }
    }

    [[nodiscard]] vec3 vector() const {
        vec3 out;
        sample(std::span(&out.x, 3));
        return out;
    }

    [[nodiscard]] quat rotation() const {
        if (channel_.interpolation == Interpolation::Linear && is_between())
            return unit(glm::slerp(unit(to_quat(part(key_, 0))), unit(to_quat(part(key_ + 1, 0))),
                                   static_cast<float>(fraction_)));
        std::array<float, 4> xyzw{};
        sample(xyzw);
        return unit(to_quat(xyzw));
    }

  private:
    [[nodiscard]] bool is_between() const { return fraction_ > 0 && channel_.interpolation != Interpolation::Step; }

    /// In-tangent, value and out-tangent of a key of a spline are its parts 0, 1, 2.
    [[nodiscard]] std::span<const float> part(std::size_t key, std::size_t number) const {
        const std::size_t parts = channel_.interpolation == Interpolation::CubicSpline ? 3 : 1;
        return std::span(channel_.values).subspan((key * parts + number) * channel_.width, channel_.width);
    }

    [[nodiscard]] double hermite(double value, float out_tangent, double next_value, float next_in_tangent) const {
        const double t = fraction_, t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * value + seconds_ * (t3 - 2 * t2 + t) * static_cast<double>(out_tangent) +
               (-2 * t3 + 3 * t2) * next_value + seconds_ * (t3 - t2) * static_cast<double>(next_in_tangent);
    }

    const AnimationChannel& channel_;
    std::size_t key_ = 0;
    double seconds_ = 0;   // between this key and the next
    double fraction_ = 0;  // of the way to the next key
};

std::vector<float> weights_at_rest(const Model& model, const Node& node) {
    if (node.mesh == no_index) return node.weights;
    const Mesh& mesh = model.meshes[node.mesh];
    std::vector<float> weights = node.weights.empty() ? mesh.weights : node.weights;
    std::size_t targets = weights.size();
    for (const Primitive& primitive : mesh.primitives) targets = std::max(targets, primitive.targets.size());
    weights.resize(targets);
    return weights;
}

std::size_t min_width(AnimatedProperty property) {
    if (property == AnimatedProperty::Weights) return 0;
    return property == AnimatedProperty::Rotation ? 4 : 3;
}

void apply(const AnimationChannel& channel, double time, Transform& transform, std::vector<float>& weights) {
    if (channel.width < min_width(channel.property) || !Sampler::is_complete(channel)) return;
    const Sampler sampler(channel, time);
    switch (channel.property) {
        case AnimatedProperty::Translation:
            transform.position = sampler.vector();
            return;
        case AnimatedProperty::Rotation:
            transform.rotation = sampler.rotation();
            return;
        case AnimatedProperty::Scale:
            transform.scale = sampler.vector();
            return;
        case AnimatedProperty::Weights:
            sampler.sample(std::span(weights).first(std::min<std::size_t>(weights.size(), channel.width)));
            return;
    }
}

/// The parent that counts for each node.
std::vector<std::uint32_t> parents_of(const Model& model, Skins skins) {
    std::vector<bool> is_joint(model.nodes.size());
    if (skins == Skins::JointsOnly)
        for (const Skin& skin : model.skins)
            for (const std::uint32_t joint : skin.joints) is_joint[joint] = true;
    std::vector<std::uint32_t> parents;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const std::uint32_t parent = model.nodes[i].parent;
        parents.push_back(is_joint[i] && parent < i && !is_joint[parent] ? no_index : parent);
    }
    return parents;
}

}  // namespace

Pose pose(const Model& model, std::uint32_t animation, double time, Skins skins) {
    std::vector<Transform> transforms(model.nodes.size());
    Pose out;
    out.weights.reserve(model.nodes.size());
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        transforms[i] = model.nodes[i].transform;
        out.weights.push_back(weights_at_rest(model, model.nodes[i]));
    }
    if (animation < model.animations.size()) {
        const Animation& clip = model.animations[animation];
        const double clip_time = looped(time, static_cast<double>(clip.duration));
        for (const AnimationChannel& channel : clip.channels)
            if (channel.node < model.nodes.size())
                apply(channel, clip_time, transforms[channel.node], out.weights[channel.node]);
    }
    const std::vector<std::uint32_t> parents = parents_of(model, skins);
    out.nodes.reserve(model.nodes.size());
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = model.nodes[i];
        const mat4 local = node.matrix ? *node.matrix : transforms[i].matrix();
        out.nodes.push_back(parents[i] < i ? out.nodes[parents[i]] * local : local);
    }
    for (const Skin& skin : model.skins) {
        std::vector<mat4>& joints = out.joints.emplace_back();
        joints.reserve(skin.joints.size());
        for (std::size_t i = 0; i < skin.joints.size(); ++i)
            joints.push_back(out.nodes[skin.joints[i]] *
                             (i < skin.inverse_bind.size() ? skin.inverse_bind[i] : mat4(1)));
    }
    return out;
}

double motion_start(const Model& model, std::uint32_t animation, double time, double previous_time) {
    if (animation >= model.animations.size()) return previous_time;
    const Animation& clip = model.animations[animation];
    const auto duration = static_cast<double>(clip.duration);
    if (!(duration > 0) || !std::isfinite(time) || !std::isfinite(previous_time)) return previous_time;
    if (rounds(time, duration) == rounds(previous_time, duration)) return previous_time;
    const bool jumps = std::ranges::any_of(clip.channels, [&](const AnimationChannel& channel) {
        return Sampler::is_complete(channel) && jumps_at_its_end(channel, std::abs(time - previous_time));
    });
    return jumps ? time : previous_time;
}

std::vector<vec3> deform(const Primitive& primitive, const mat4& world, std::span<const mat4> joints,
                         std::span<const float> weights) {
    std::vector<vec3> out(primitive.vertices.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = primitive.vertices[i].position;
    for (std::size_t target = 0; target < std::min(weights.size(), primitive.targets.size()); ++target) {
        const std::vector<vec3>& deltas = primitive.targets[target].positions;
        if (weights[target] == 0) continue;
        for (std::size_t i = 0; i < std::min(out.size(), deltas.size()); ++i) out[i] += weights[target] * deltas[i];
    }
    const bool is_skinned = !joints.empty() && primitive.skin.size() == out.size();
    for (std::size_t i = 0; i < out.size(); ++i) {
        const vec4 point(out[i], 1);
        if (!is_skinned) {
            out[i] = vec3(world * point);
            continue;
        }
        const VertexSkin& skin = primitive.skin[i];
        vec3 sum(0);
        for (int influence = 0; influence < 4; ++influence) {
            const std::size_t joint = skin.joints[static_cast<std::size_t>(influence)];
            if (skin.weights[influence] != 0 && joint < joints.size())
                sum += skin.weights[influence] * vec3(joints[joint] * point);
        }
        out[i] = sum;
    }
    return out;
}

}  // namespace darkroom::scene
