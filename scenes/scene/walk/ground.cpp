// SPDX-License-Identifier: MIT
#include "scene/walk/ground.hpp"

#include <cmath>

namespace darkroom::scene {

namespace {

/// Of the unit box: corner i has the bits x, y, z.
const std::vector<std::uint32_t> box_indices{0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                             2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};

std::vector<vec3> box_corners(const Box& box, const mat4& matrix) {
    std::vector<vec3> out;
    for (int i = 0; i < 8; ++i) {
        const vec3 point((i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                         (i & 4) != 0 ? box.high.z : box.low.z);
        out.emplace_back(matrix * vec4(point, 1));
    }
    return out;
}

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_solid(const Snapshot& snapshot, const Instance& instance) {
    const bool moves =
        instance.world != instance.previous_world || instance.joint_count > 0 || instance.weight_count > 0;
    return !moves && !instance.is_wireframe && snapshot.materials[instance.material].writes != Writes::Alpha;
}

/// Distance along the ray to a triangle, from either side (Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997). Edges are a little wide, so that nothing falls through where two triangles meet.
std::optional<float> meet(vec3 from, vec3 direction, vec3 corner, vec3 first_edge, vec3 second_edge) {
    constexpr float edge_width = 1e-4F;
    const vec3 p = glm::cross(direction, second_edge);
    const float determinant = glm::dot(first_edge, p);
    if (determinant == 0) return {};
    const vec3 offset = from - corner;
    const float u = glm::dot(offset, p) / determinant;
    const vec3 q = glm::cross(offset, first_edge);
    const float v = glm::dot(direction, q) / determinant;
    if (!(u >= -edge_width && v >= -edge_width && u + v <= 1 + edge_width)) return {};
    return glm::dot(second_edge, q) / determinant;
}

}  // namespace

Ground::Ground(const Scene& scene, const Assets& assets) {
    // What stands still is where it was at another time.
    constexpr double later = 0.37;
    const Snapshot snapshot = scene::snapshot(scene, assets, {.time = later, .previous_time = 0});
    for (const Instance& instance : snapshot.instances) {
        if (!is_solid(snapshot, instance)) continue;
        const MeshId& id = instance.mesh;
        if (id.model == no_index) {
            add(box_corners({vec3(0), vec3(1)}, instance.world), box_indices);
            continue;
        }
        const Primitive& primitive = assets.models[id.model].meshes[id.mesh].primitives[id.primitive];
        if (triangles_.size() + primitive.indices.size() / 3 > max_triangles)
            add(box_corners(instance.bounds, mat4(1)), box_indices);
        else
            add(deform(primitive, instance.world, {}, {}), primitive.indices);
    }
    link();
}

void Ground::add(const std::vector<vec3>& points, const std::vector<std::uint32_t>& indices) {
    for (std::size_t i = 0; i + 2 < indices.size() && triangles_.size() < max_triangles; i += 3) {
        const vec3 a = points[indices[i]], b = points[indices[i + 1]], c = points[indices[i + 2]];
        if (!is_finite(a) || !is_finite(b) || !is_finite(c) || glm::cross(b - a, c - a) == vec3(0)) continue;
        triangles_.push_back({a, b - a, c - a});
        bounds_.add(bounds_of(triangles_.back()));
    }
}

Box Ground::bounds_of(const Triangle& triangle) {
    Box out;
    for (const vec3& edge : {vec3(0), triangle.first_edge, triangle.second_edge}) out.add(triangle.corner + edge);
    return out;
}

Ground::Cells Ground::cells_of(const Box& box) const {
    const vec3 size = glm::max(bounds_.size(), vec3(1e-6F));
    const auto cell = [&](float at, float low, float extent) {
        const float place = (at - low) / extent * static_cast<float>(side_);
        return place > 0 ? static_cast<std::uint32_t>(std::min(place, static_cast<float>(side_ - 1))) : 0;
    };
    return {cell(box.low.x, bounds_.low.x, size.x), cell(box.high.x, bounds_.low.x, size.x),
            cell(box.low.z, bounds_.low.z, size.z), cell(box.high.z, bounds_.low.z, size.z)};
}

/// As many cells as the links have room for; in one cell alone there are as many as triangles.
void Ground::link() {
    for (side_ = 256; side_ > 1; side_ /= 2) {
        std::size_t count = 0;
        for (const Triangle& triangle : triangles_) count += cells_of(bounds_of(triangle)).count();
        if (count <= max_links) break;
    }
    const auto for_each_link = [&](auto&& act) {
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            const Cells cells = cells_of(bounds_of(triangles_[i]));
            for (std::uint32_t z = cells.low_z; z <= cells.high_z; ++z)
                for (std::uint32_t x = cells.low_x; x <= cells.high_x; ++x) act(std::size_t{z} * side_ + x, i);
        }
    };
    first_.assign(std::size_t{side_} * side_ + 1, 0);
    for_each_link([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    links_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_each_link([&](std::size_t cell, std::uint32_t triangle) { links_[next[cell]++] = triangle; });
}

std::optional<RayHit> Ground::cast(vec3 from, vec3 direction, float reach) const {
    std::optional<RayHit> out;
    if (triangles_.empty()) return out;
    Box swept;
    swept.add(from);
    swept.add(from + reach * direction);
    const Cells cells = cells_of(swept);
    for (std::uint32_t z = cells.low_z; z <= cells.high_z; ++z) {
        for (std::uint32_t x = cells.low_x; x <= cells.high_x; ++x) {
            const std::size_t cell = std::size_t{z} * side_ + x;
            for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
                const Triangle& t = triangles_[links_[i]];
                const std::optional<float> distance = meet(from, direction, t.corner, t.first_edge, t.second_edge);
                if (!distance || !(*distance >= 0 && *distance <= reach)) continue;
                if (out && out->distance <= *distance) continue;
                const vec3 normal = glm::normalize(glm::cross(t.first_edge, t.second_edge));
                out = {*distance, glm::dot(normal, direction) > 0 ? -normal : normal};
            }
        }
    }
    return out;
}

}  // namespace darkroom::scene
