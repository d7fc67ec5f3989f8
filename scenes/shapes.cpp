// SPDX-License-Identifier: MIT
#include "shapes.hpp"

#include <cmath>
#include <numbers>

namespace darkroom::scenes {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

enum BoneNumber : std::uint16_t {
    Hips,
    Chest,
    Head,
    LeftArm,
    LeftForearm,
    RightArm,
    RightForearm,
    LeftThigh,
    LeftShin,
    RightThigh,
    RightShin,
};

/// A ring of a limb: where its centre is, how thick it is, and which bones move it.
struct Ring {
    vec3 center{0};
    vec2 radius{0};  ///< along x and z
    std::uint16_t bone = 0, other = 0;
    float other_weight = 0;
};

void add_vertex(Mesh& mesh, vec3 position, vec3 normal, vec2 uv, const Ring& ring) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.uvs.push_back(uv);
    mesh.joints.push_back({ring.bone, ring.other, 0, 0});
    mesh.weights.push_back({1 - ring.other_weight, ring.other_weight, 0, 0});
}

/// Rows of `columns` + 1 vertices, the first and last of which coincide.
void add_grid(Mesh& mesh, std::uint32_t first, std::uint32_t rows, std::uint32_t columns) {
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = first + row * (columns + 1) + column, b = a + columns + 1;
            for (const std::uint32_t index : {a, a + 1, b, a + 1, b + 1, b}) mesh.indices.push_back(index);
        }
    }
}

/// A closed tube through rings from bottom to top, rounded off at both ends.
void add_limb(Mesh& mesh, std::span<const Ring> rings) {
    constexpr std::uint32_t columns = 16;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const Ring& ring = rings[i];
        const Ring& below = rings[i == 0 ? 0 : i - 1];
        const Ring& above = rings[i + 1 == rings.size() ? i : i + 1];
        const float rise = std::max(above.center.y - below.center.y, 1e-4F);
        const vec2 growth = (above.radius - below.radius) / rise;
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / columns, angle = 2 * pi * u;
            // Seen from above the angle runs clockwise, so that rows going up face outward.
            const vec2 around(std::sin(angle), std::cos(angle));
            const vec3 normal(around.x, -glm::dot(growth, glm::abs(around)), around.y);
            add_vertex(mesh, ring.center + vec3(around.x * ring.radius.x, 0, around.y * ring.radius.y),
                       glm::normalize(normal), {u, static_cast<float>(i) / static_cast<float>(rings.size() - 1)}, ring);
        }
    }
    add_grid(mesh, first, static_cast<std::uint32_t>(rings.size()), columns);
}

/// Limb from `low` to `high` with a joint between: `bone` moves what is above the joint, `lower` what is below. The
/// ends are round over a share `roundness` of half the length.
void add_jointed(Mesh& mesh, vec3 low, vec3 joint, vec3 high, vec2 thin, vec2 thick, std::uint16_t lower,
                 std::uint16_t bone, float roundness = 1 / 3.0F) {
    constexpr int rings = 25;
    std::vector<Ring> list;
    for (int i = 0; i < rings; ++i) {
        const float t = static_cast<float>(i) / (rings - 1);
        const float y = glm::mix(low.y, high.y, t);
        const float along = y < joint.y ? (y - low.y) / (joint.y - low.y) : (y - joint.y) / (high.y - joint.y);
        const vec3 center = y < joint.y ? glm::mix(low, joint, along) : glm::mix(joint, high, along);
        const float end = std::min(t, 1 - t) * 2 / roundness;
        const float round = end >= 1 ? 1 : std::sqrt(1 - (1 - end) * (1 - end));
        const float blend = glm::smoothstep(joint.y - 0.07F, joint.y + 0.07F, y);
        list.push_back({.center = {center.x, y, center.z},
                        .radius = glm::mix(thin, thick, t) * round,
                        .bone = bone,
                        .other = lower,
                        .other_weight = 1 - blend});
    }
    add_limb(mesh, list);
}

}  // namespace

Mesh lathe(std::span<const vec2> profile, std::uint32_t segments) {
    Mesh mesh;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const bool starts = i == 0 || profile[i - 1] == profile[i];
        const bool ends = i + 1 == profile.size() || profile[i + 1] == profile[i];
        const vec2 before = starts ? profile[i] : profile[i - 1], after = ends ? profile[i] : profile[i + 1];
        const vec2 along = glm::normalize(after - before);
        for (std::uint32_t segment = 0; segment <= segments; ++segment) {
            const float u = static_cast<float>(segment) / static_cast<float>(segments), angle = 2 * pi * u;
            const vec2 around(std::sin(angle), std::cos(angle));
            mesh.positions.push_back({around.x * profile[i].x, profile[i].y, around.y * profile[i].x});
            mesh.normals.push_back(glm::normalize(vec3(around.x * along.y, -along.x, around.y * along.y)));
            mesh.uvs.push_back({u, 1 - static_cast<float>(i) / static_cast<float>(profile.size() - 1)});
        }
    }
    add_grid(mesh, 0, static_cast<std::uint32_t>(profile.size()), segments);
    return mesh;
}

Mesh sphere(float radius, std::uint32_t segments, std::uint32_t rings) {
    std::vector<vec2> profile;
    for (std::uint32_t ring = 0; ring <= rings; ++ring) {
        const float angle = pi * static_cast<float>(ring) / static_cast<float>(rings) - pi / 2;
        profile.push_back(vec2(std::cos(angle), std::sin(angle)) * radius);
    }
    Mesh mesh = lathe(profile, segments);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.normals[i] = mesh.positions[i] / radius;
    return mesh;
}

namespace {

/// A sheet over [0, 1] x [0, 1], columns by rows, with normals from its neighbours.
template <class Place>
void add_sheet(Mesh& mesh, std::uint32_t columns, std::uint32_t rows, const Place& place) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    constexpr float step = 1e-3F;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            const vec3 along = place(u + step, v) - place(u - step, v), up = place(u, v + step) - place(u, v - step);
            mesh.positions.push_back(place(u, v));
            mesh.normals.push_back(glm::normalize(glm::cross(along, up)));
            mesh.uvs.push_back({u, 1 - v});
        }
    }
    add_grid(mesh, first, rows + 1, columns);
}

}  // namespace

Mesh curtain(float width, float height, std::uint32_t folds) {
    Mesh mesh;
    add_sheet(mesh, folds * 12, 12, [&](float u, float v) {
        const float wave = 2 * pi * static_cast<float>(folds) * u;
        const float depth = glm::mix(0.09F, 0.03F, v) * (1 + 0.4F * std::sin(5 * u + 2));
        return vec3((u - 0.5F) * width + 0.02F * std::sin(wave * 0.5F + 3 * v), v * height, depth * std::sin(wave));
    });
    return mesh;
}

Mesh plant(std::uint32_t leaves, float height) {
    Mesh mesh;
    for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
        const auto number = static_cast<float>(leaf);
        // The golden angle, and lengths and bends that do not repeat with it.
        const float turn = 2.39996F * number, length = height * (0.65F + 0.35F * std::sin(number * 1.7F));
        const float bend = 0.35F + 0.55F * number / static_cast<float>(leaves), wide = 0.05F + 0.02F * std::cos(number);
        const vec3 out(std::cos(turn), 0, std::sin(turn)), side(-out.z, 0, out.x);
        add_sheet(mesh, 4, 14, [&](float u, float v) {
            const float width = wide * std::sin(pi * std::pow(glm::clamp(v, 0.0F, 1.0F), 0.7F)) + 0.004F;
            const float across = (u - 0.5F) * 2 * width, crease = 0.3F * std::abs(across);
            return out * (length * bend * v * v + 0.02F) +
                   vec3(0, length * (v - 0.45F * bend * v * v * v) + crease, 0) + side * across;
        });
    }
    return mesh;
}

std::vector<Bone> figure_bones() {
    return {{"hips", Hips, {0, 0.95F, 0}},
            {"chest", Hips, {0, 1.15F, 0}},
            {"head", Chest, {0, 1.52F, 0}},
            {"left_arm", Chest, {0.23F, 1.42F, 0}},
            {"left_forearm", LeftArm, {0.26F, 1.12F, 0}},
            {"right_arm", Chest, {-0.23F, 1.42F, 0}},
            {"right_forearm", RightArm, {-0.26F, 1.12F, 0}},
            {"left_thigh", Hips, {0.1F, 0.92F, 0}},
            {"left_shin", LeftThigh, {0.11F, 0.5F, 0}},
            {"right_thigh", Hips, {-0.1F, 0.92F, 0}},
            {"right_shin", RightThigh, {-0.11F, 0.5F, 0}}};
}

Mesh figure() {
    Mesh mesh;
    add_jointed(mesh, {0, 0.82F, 0}, {0, 1.15F, 0}, {0, 1.5F, 0}, {0.15F, 0.11F}, {0.2F, 0.13F}, Hips, Chest);
    add_jointed(mesh, {0, 1.5F, 0.01F}, {0, 1.52F, 0.01F}, {0, 1.8F, 0.01F}, {0.1F, 0.11F}, {0.1F, 0.12F}, Chest, Head,
                1);
    for (const float side : {1.0F, -1.0F}) {
        const bool is_left = side > 0;
        add_jointed(mesh, {0.28F * side, 0.8F, 0.02F}, {0.26F * side, 1.12F, 0}, {0.21F * side, 1.47F, 0},
                    {0.04F, 0.045F}, {0.065F, 0.065F}, is_left ? LeftForearm : RightForearm,
                    is_left ? LeftArm : RightArm);
        add_jointed(mesh, {0.12F * side, 0, 0.02F}, {0.11F * side, 0.5F, 0}, {0.1F * side, 0.96F, 0}, {0.055F, 0.07F},
                    {0.095F, 0.1F}, is_left ? LeftShin : RightShin, is_left ? LeftThigh : RightThigh);
    }
    return mesh;
}

std::vector<quat> stride(std::uint32_t bone, std::uint32_t keys) {
    std::vector<quat> out;
    for (std::uint32_t key = 0; key < keys; ++key) {
        const float phase = 2 * pi * static_cast<float>(key % (keys - 1)) / static_cast<float>(keys - 1);
        float swing = 0;
        vec3 axis(1, 0, 0);
        switch (bone) {
            case LeftThigh:
                swing = -0.5F * std::sin(phase);
                break;
            case RightThigh:
                swing = 0.5F * std::sin(phase);
                break;
            case LeftShin:
                swing = 0.45F - 0.4F * std::cos(phase - 0.6F);
                break;
            case RightShin:
                swing = 0.45F + 0.4F * std::cos(phase - 0.6F);
                break;
            case LeftArm:
                swing = 0.4F * std::sin(phase);
                break;
            case RightArm:
                swing = -0.4F * std::sin(phase);
                break;
            case LeftForearm:
            case RightForearm:
                swing = -0.35F;
                break;
            case Chest:
                axis = {0, 1, 0};
                swing = 0.12F * std::sin(phase);
                break;
            default:
                break;
        }
        out.push_back(glm::angleAxis(swing, axis));
    }
    return out;
}

}  // namespace darkroom::scenes
