// SPDX-License-Identifier: MIT
#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

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
