// SPDX-License-Identifier: MIT
#pragma once
// Geometry of the shipped models: bodies of revolution, cloth, a plant and a jointed figure. Metres, y up,
// counter-clockwise fronts.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/math.hpp"

namespace darkroom::scenes {

using scene::quat;
using scene::vec2;
using scene::vec3;
using scene::vec4;

struct Mesh {
    std::vector<vec3> positions, normals;
    std::vector<vec2> uvs;
    std::vector<std::array<std::uint16_t, 4>> joints;  ///< empty: not skinned
    std::vector<vec4> weights;
    std::vector<std::uint32_t> indices;
};

/// A profile of (radius, height) points from bottom to top, turned around the y axis. Normals are smooth along the
/// profile; a point given twice makes a crease.
[[nodiscard]] Mesh lathe(std::span<const vec2> profile, std::uint32_t segments);
[[nodiscard]] Mesh sphere(float radius, std::uint32_t segments, std::uint32_t rings);

/// Cloth that hangs from y = height to the floor, `folds` waves across `width`, deeper at the bottom; seen from both
/// sides.
[[nodiscard]] Mesh curtain(float width, float height, std::uint32_t folds);
/// Leaves that rise from the origin and bend outward, each by its own number; seen from both sides.
[[nodiscard]] Mesh plant(std::uint32_t leaves, float height);

/// A bone of the figure: where it starts in the rest pose, and below which.
struct Bone {
    std::string name;
    std::uint32_t parent = 0;  ///< its own number: none
    vec3 position{0};
};
[[nodiscard]] std::vector<Bone> figure_bones();
/// 1.8 m tall, feet on y = 0, facing +z, arms hanging.
[[nodiscard]] Mesh figure();

/// Rotation of a bone at each of `keys` evenly spaced moments of one stride; the last equals the first.
[[nodiscard]] std::vector<quat> stride(std::uint32_t bone, std::uint32_t keys);

}  // namespace darkroom::scenes
