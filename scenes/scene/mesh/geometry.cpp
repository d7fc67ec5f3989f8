// SPDX-License-Identifier: MIT
#include "scene/mesh/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

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
    for (MorphTarget& target : primitive.targets) target.normals.assign(corners.size(), vec3(0));
    for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
        // Twice as long as the triangle is large.
        const auto normal_of = [&](const MorphTarget* target) {
            std::array<vec3, 3> corner;
            for (std::size_t i = 0; i < 3; ++i)
                corner[i] = primitive.vertices[first + i].position + (target ? target->positions[first + i] : vec3(0));
            return glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        };
        const vec3 normal = normal_of(nullptr);
        const float length = glm::length(normal);
        const bool is_flat = length > 0 && std::isfinite(length);
        for (std::size_t i = first; is_flat && i < first + 3; ++i) primitive.vertices[i].normal = normal / length;
        for (MorphTarget& target : primitive.targets) {
            const vec3 moved = normal_of(&target);
            const float moved_length = glm::length(moved);
            if (!(moved_length > 0) || !std::isfinite(moved_length)) continue;
            const vec3 delta = moved / (is_flat ? length : moved_length) - primitive.vertices[first].normal;
            std::fill_n(target.normals.begin() + static_cast<std::ptrdiff_t>(first), 3, delta);
        }
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

// Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, section 2: each triangle's tangent is projected onto
// the plane of the vertex normal, made a unit vector there and weighed by the corner's angle. What lies on two sides of
// a mirrored seam is never averaged.

namespace {

using glm::dvec2;
using glm::dvec3;

/// Nothing is left of what is shorter, or not finite.
dvec3 unit_or_zero(const dvec3& vector) {
    const double length = glm::length(vector);
    return length > 1e-150 && std::isfinite(length) ? vector / length : dvec3(0);
}

dvec3 on_plane(const dvec3& vector, const dvec3& normal) {
    return unit_or_zero(vector - normal * glm::dot(normal, vector));
}

dvec3 any_across(const dvec3& normal) {
    const dvec3 axis = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    return on_plane(axis, normal);
}

/// The tangent of one group of corners: those of one place, normal, coordinates and handedness.
struct Group {
    dvec3 tangent{0};
    [[nodiscard]] bool is_known() const { return tangent != dvec3(0); }
};

class TangentMaker {
  public:
    TangentMaker(Primitive& primitive, const Texture& texture) : primitive_(primitive) {
        const std::vector<Vertex>& vertices = primitive.vertices;
        uv_.reserve(vertices.size());
        for (const Vertex& vertex : vertices) {
            const vec2 uv(texture.uv_transform * vec3(texture.uv_set == 1 ? vertex.uv1 : vertex.uv0, 1));
            uv_.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : vec2(0));
        }
        weld();
    }

    void make() {
        for (std::size_t first = 0; first + 2 < primitive_.indices.size(); first += 3) add_triangle(first);
        for (Group& group : groups_) group.tangent = unit_or_zero(group.tangent);
        choose_sides();
        take_from_neighbours();
        write();
    }

  private:
    // Vertices that agree in place, normal and coordinates get one number.
    void weld() {
        const std::vector<Vertex>& vertices = primitive_.vertices;
        const auto key = [&](std::uint32_t i) {
            const Vertex& v = vertices[i];
            return std::make_tuple(v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z,
                                   uv_[i].x, uv_[i].y);
        };
        std::vector<std::uint32_t> order(vertices.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
        welded_.resize(vertices.size());
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i > 0 && key(order[i - 1]) < key(order[i])) ++count;
            welded_[order[i]] = count;
        }
        groups_.resize((std::size_t{count} + 1) * 2);
        corner_side_.assign(primitive_.indices.size(), undecided);
    }

    [[nodiscard]] dvec3 position(std::size_t corner) const {
        return primitive_.vertices[primitive_.indices[corner]].position;
    }
    [[nodiscard]] dvec3 normal(std::size_t corner) const {
        return primitive_.vertices[primitive_.indices[corner]].normal;
    }
    [[nodiscard]] std::size_t group_of(std::size_t corner) const {
        return std::size_t{welded_[primitive_.indices[corner]]} * 2 + corner_side_[corner];
    }

    void add_triangle(std::size_t first) {
        const dvec2 origin = uv_[primitive_.indices[first]];
        const dvec2 uv1 = dvec2(uv_[primitive_.indices[first + 1]]) - origin;
        const dvec2 uv2 = dvec2(uv_[primitive_.indices[first + 2]]) - origin;
        const dvec3 edge1 = position(first + 1) - position(first), edge2 = position(first + 2) - position(first);
        const double area = uv1.x * uv2.y - uv1.y * uv2.x;
        const dvec3 along_u = unit_or_zero((edge1 * uv2.y - edge2 * uv1.y) * (area < 0 ? -1.0 : 1.0));
        const bool is_flat = unit_or_zero(glm::cross(edge1, edge2)) == dvec3(0);
        if (area == 0 || !std::isfinite(area) || is_flat || along_u == dvec3(0)) return;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t corner = first + i;
            const dvec3 n = normal(corner), here = position(corner);
            const dvec3 before = on_plane(position(first + (i + 2) % 3) - here, n);
            const dvec3 after = on_plane(position(first + (i + 1) % 3) - here, n);
            const double angle = std::acos(std::clamp(glm::dot(before, after), -1.0, 1.0));
            // The second coordinate of glTF points down: w is 1 where the area, counted so, is negative.
            corner_side_[corner] = area < 0 ? 1 : 0;
            groups_[group_of(corner)].tangent += on_plane(along_u, n) * angle;
        }
    }

    // A corner of a degenerate triangle joins the others of its place.
    void choose_sides() {
        for (std::size_t corner = 0; corner < corner_side_.size(); ++corner) {
            if (corner_side_[corner] != undecided) continue;
            corner_side_[corner] = 1;
            if (!groups_[group_of(corner)].is_known()) corner_side_[corner] = 0;
            if (!groups_[group_of(corner)].is_known()) corner_side_[corner] = undecided;
        }
    }

    // Where no triangle around a place has a tangent, the nearest along the edges gives its own, and its handedness.
    void take_from_neighbours() {
        std::vector<std::pair<std::uint32_t, std::size_t>> triangles;  // by the place of a corner
        std::queue<std::size_t> known;                                 // corners
        for (std::size_t first = 0; first + 2 < corner_side_.size(); first += 3) {
            bool is_whole = true;
            for (std::size_t i = 0; i < 3; ++i) is_whole = is_whole && corner_side_[first + i] != undecided;
            if (is_whole) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                triangles.emplace_back(welded_[primitive_.indices[first + i]], first);
                if (corner_side_[first + i] != undecided) known.push(first + i);
            }
        }
        std::sort(triangles.begin(), triangles.end());
        std::vector<std::uint8_t> side_of_place(groups_.size() / 2, undecided);
        for (; !known.empty(); known.pop()) {
            const std::size_t corner = known.front();
            const std::uint32_t place = welded_[primitive_.indices[corner]];
            if (side_of_place[place] != undecided) continue;
            side_of_place[place] = corner_side_[corner];
            const dvec3 tangent = groups_[group_of(corner)].tangent;
            for (auto at = std::lower_bound(triangles.begin(), triangles.end(), std::pair(place, std::size_t{0}));
                 at != triangles.end() && at->first == place; ++at)
                for (std::size_t next = at->second; next < at->second + 3; ++next) {
                    if (corner_side_[next] != undecided) continue;
                    corner_side_[next] = side_of_place[place];
                    Group& group = groups_[group_of(next)];
                    if (!group.is_known()) group.tangent = on_plane(tangent, normal(next));
                    known.push(next);
                }
        }
    }

    void write() {
        const std::size_t count = primitive_.vertices.size();
        std::vector<std::uint32_t> from(count);
        std::vector<std::size_t> group_of_vertex(count, no_group);
        std::vector<std::uint32_t> twin(count, no_index);
        for (std::uint32_t i = 0; i < count; ++i) from[i] = i;
        for (std::size_t corner = 0; corner < corner_side_.size(); ++corner) {
            if (corner_side_[corner] == undecided) corner_side_[corner] = 1;
            const std::size_t group = group_of(corner);
            std::uint32_t& index = primitive_.indices[corner];
            if (group_of_vertex[index] == no_group) group_of_vertex[index] = group;
            if (group_of_vertex[index] == group) continue;
            if (twin[index] == no_index) {
                twin[index] = static_cast<std::uint32_t>(from.size());
                from.push_back(index);
                group_of_vertex.push_back(group);
            }
            index = twin[index];
        }
        if (from.size() > count) rearrange(primitive_, from);
        for (std::size_t i = 0; i < from.size(); ++i) {
            if (group_of_vertex[i] == no_group) continue;
            Vertex& vertex = primitive_.vertices[i];
            const Group& group = groups_[group_of_vertex[i]];
            const dvec3 tangent = group.is_known() ? group.tangent : any_across(vertex.normal);
            vertex.tangent = vec4(vec3(tangent), group_of_vertex[i] % 2 == 1 ? 1 : -1);
        }
    }

    static constexpr std::uint8_t undecided = 2;
    static constexpr std::size_t no_group = ~std::size_t{0};

    Primitive& primitive_;
    std::vector<vec2> uv_;
    std::vector<std::uint32_t> welded_;      ///< of each vertex
    std::vector<Group> groups_;              ///< two of each welded one: handedness -1 and 1
    std::vector<std::uint8_t> corner_side_;  ///< 0: -1, 1: 1
};

}  // namespace

void make_tangents(Primitive& primitive, const Texture& texture) {
    if (!primitive.vertices.empty()) TangentMaker(primitive, texture).make();
}

std::size_t tangent_bytes_per_vertex(const Primitive& primitive) {
    const std::size_t split = sizeof(Vertex) + sizeof(VertexSkin) + primitive.targets.size() * 2 * sizeof(vec3);
    return split + sizeof(vec2) + 2 * sizeof(Group) + 4 * sizeof(std::uint32_t) + 2 * sizeof(std::size_t);
}

}  // namespace darkroom::scene
