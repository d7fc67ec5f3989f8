// SPDX-License-Identifier: MIT
#include "scene/mesh/geometry.hpp"

#include <cmath>

namespace darkroom::scene {
namespace {

template <class T>
void pick(std::vector<T>& values, std::span<const std::uint32_t> from) {
    if (values.empty()) return;
    std::vector<T> picked;
    picked.reserve(from.size());
    for (const std::uint32_t index : from) picked.push_back(values[index]);
    values = std::move(picked);
}

}  // namespace

void rearrange(Primitive& primitive, std::span<const std::uint32_t> from) {
    pick(primitive.vertices, from);
    pick(primitive.skin, from);
    for (MorphTarget& target : primitive.targets) {
        pick(target.positions, from);
        pick(target.normals, from);
    }
}

// glTF 2.0 specification, 3.7.2.1: the corners of triangle i, in the order that keeps its front.
std::vector<std::uint32_t> triangles_of(std::span<const std::uint32_t> corners, int mode) {
    constexpr int strip = 5;
    constexpr int fan = 6;
    std::vector<std::uint32_t> out;
    if (mode != strip && mode != fan) {
        out.assign(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(corners.size() / 3 * 3));
        return out;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        const std::size_t odd = i % 2;
        if (mode == strip)
            out.insert(out.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
        else
            out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
    return out;
}

void make_flat(Primitive& primitive) {
    const std::vector<std::uint32_t> corners = std::move(primitive.indices);
    rearrange(primitive, corners);
    primitive.indices.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) primitive.indices[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        Vertex* vertex = &primitive.vertices[i];
        const vec3 normal =
            glm::cross(vertex[1].position - vertex[0].position, vertex[2].position - vertex[0].position);
        const float length = glm::length(normal);
        if (!(length > 0) || !std::isfinite(length)) continue;
        for (int corner = 0; corner < 3; ++corner) vertex[corner].normal = normal / length;
    }
}

void drop_unused_vertices(Primitive& primitive) {
    constexpr std::uint32_t unused = no_index;
    std::vector<std::uint32_t> new_index(primitive.vertices.size(), unused);
    for (const std::uint32_t index : primitive.indices) new_index[index] = 0;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < new_index.size(); ++i) {
        if (new_index[i] == unused) continue;
        new_index[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(i);
    }
    if (kept.size() == primitive.vertices.size()) return;
    rearrange(primitive, kept);
    for (std::uint32_t& index : primitive.indices) index = new_index[index];
}

std::size_t size_in_memory(const Primitive& primitive) {
    std::size_t size = primitive.vertices.size() * sizeof(Vertex) + primitive.skin.size() * sizeof(VertexSkin) +
                       primitive.indices.size() * sizeof(std::uint32_t);
    for (const MorphTarget& target : primitive.targets)
        size += (target.positions.size() + target.normals.size()) * sizeof(vec3);
    return size;
}

}  // namespace darkroom::scene
