// SPDX-License-Identifier: MIT
#pragma once
// Scenes of boxes for the tests of ambient occlusion, seen by casting a ray through every pixel. Not part of the
// library.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/ssao.hpp>
#include <limits>
#include <string_view>
#include <vector>

#include "compose/test_stacks/support.hpp"
#include "shared/camera_reference.hpp"

namespace darkroom::test {

struct Box {
    Double3 low, high;
};

struct BoxScene {
    std::string_view name;
    std::vector<Box> boxes;
    Double3 eye, target;
    double field_of_view_rad = 1.0;
};

/// What a camera sees of a scene.
struct BoxView {
    ReferenceImage depth, normals;
    Camera camera;
    [[nodiscard]] RunOptions options() const { return {.depth = &depth, .normals = &normals, .camera = camera}; }
    [[nodiscard]] RunOptions options_without_normals() const { return {.depth = &depth, .camera = camera}; }
    /// The point behind a pixel, world space.
    [[nodiscard]] Double3 point(std::uint32_t x, std::uint32_t y) const {
        const ReferenceCamera reference(camera);
        const Double3 view =
            reference.view_position((x + 0.5) / depth.width, (y + 0.5) / depth.height, depth.at(x, y).r);
        const Double3 turned = reference.world_direction(view);
        return {reference.eye[0] + turned[0], reference.eye[1] + turned[1], reference.eye[2] + turned[2]};
    }
};

struct BoxHit {
    double along = std::numeric_limits<double>::infinity();
    Double3 normal{};
};

/// The first side that a ray from outside enters.
inline BoxHit first_hit(const std::vector<Box>& boxes, const Double3& from, const Double3& direction) {
    BoxHit best;
    for (const Box& box : boxes) {
        double enter = 0, leave = std::numeric_limits<double>::infinity();
        Double3 normal{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double a = (box.low[axis] - from[axis]) / direction[axis];
            const double b = (box.high[axis] - from[axis]) / direction[axis];
            if (std::min(a, b) > enter) {
                enter = std::min(a, b);
                normal = {};
                normal[axis] = direction[axis] > 0 ? -1 : 1;
            }
            leave = std::min(leave, std::max(a, b));
        }
        if (enter > 0 && enter < leave && enter < best.along) best = {enter, normal};
    }
    return best;
}

/// What a camera sees, by `cast`, which gives the first hit of a ray.
template <class Cast>
BoxView view_through(const Camera& camera, std::uint32_t width, std::uint32_t height, const Cast& cast) {
    BoxView out{.depth{width, height}, .normals{width, height}, .camera = camera};
    const ReferenceCamera reference(out.camera);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            // One metre along the view axis, so that `along` is the planar distance.
            const Double3 ray =
                reference.world_direction(reference.view_position((x + 0.5) / width, (y + 0.5) / height, 1));
            const BoxHit hit = cast(reference.eye, ray);
            out.depth.at(x, y).r = std::isfinite(hit.along) ? double{static_cast<float>(hit.along)} : 1e10;
            out.normals.at(x, y) = {hit.normal[0], hit.normal[1], hit.normal[2], 0};
        }
    }
    return out;
}

inline BoxView view_of(const BoxScene& scene, std::uint32_t width, std::uint32_t height) {
    const Camera camera = look_at(scene.eye, scene.target, scene.field_of_view_rad, double(width) / height);
    return view_through(camera, width, height, [&](const Double3& from, const Double3& direction) {
        return first_hit(scene.boxes, from, direction);
    });
}

inline Box box(double x, double y, double z, double width, double height, double depth) {
    return {{x, y, z}, {x + width, y + height, z + depth}};
}

/// A corner of a room, and a block on its floor.
inline BoxScene corner_scene() {
    return {.name = "corner",
            .boxes = {box(-9, -1, -9, 18, 1, 18), box(-9, 0, -9, 7, 9, 18), box(-9, 0, -9, 18, 9, 7),
                      box(-1.2, 0, -1.1, 0.5, 0.5, 0.5)},
            .eye = {1.2, 1.5, 1.4},
            .target = {-1.6, 0.3, -1.6}};
}

/// Columns on plinths before a wall, a beam over them, rafters from it to the wall, and a bench.
inline BoxScene courtyard_scene() {
    BoxScene scene{.name = "courtyard", .eye = {-2.6, 1.7, 3.6}, .target = {0.3, 1.2, -1}, .field_of_view_rad = 1.1};
    scene.boxes = {box(-20, -1, -20, 40, 1, 40),         box(-20, 0, -3.2, 40, 6, 1),
                   box(-20, 2.6, -1.2, 40, 0.35, 0.5),   box(-2.2, 0.4, -2.1, 2, 0.08, 0.45),
                   box(-2.1, 0, -2.05, 0.12, 0.4, 0.35), box(-0.4, 0, -2.05, 0.12, 0.4, 0.35)};
    for (int i = -4; i <= 4; ++i) {
        scene.boxes.push_back(box(i * 1.3 - 0.3, 0, -1.25, 0.6, 0.25, 0.6));
        scene.boxes.push_back(box(i * 1.3 - 0.17, 0.25, -1.12, 0.34, 2.15, 0.34));
        scene.boxes.push_back(box(i * 1.3 - 0.25, 2.4, -1.2, 0.5, 0.2, 0.5));
        scene.boxes.push_back(box(i * 1.3 - 0.08, 2.7, -2.2, 0.16, 0.2, 1.0));
    }
    return scene;
}

/// Stairs between two walls, a table and a shelf.
inline BoxScene stairs_scene() {
    BoxScene scene{.name = "stairs", .eye = {1.9, 1.7, 2.6}, .target = {-0.4, 0.7, -0.8}, .field_of_view_rad = 1.15};
    scene.boxes = {box(-20, -1, -20, 40, 1, 40), box(-20, 0, -3, 40, 4, 0.5), box(-3.4, 0, -20, 1, 4, 40),
                   box(0.2, 0.7, -0.6, 1.3, 0.05, 0.8)};
    for (int i = 0; i < 9; ++i) scene.boxes.push_back(box(-2.4, 0.17 * i, -0.2 - 0.27 * i, 1.2, 0.17, 2.5 - 0.27 * i));
    for (const double x : {0.25, 1.4})
        for (const double z : {-0.55, 0.1}) scene.boxes.push_back(box(x, 0, z, 0.06, 0.7, 0.06));
    for (int i = 0; i < 5; ++i) scene.boxes.push_back(box(-0.6, 0.4 * i + 0.1, -2.5, 1.6, 0.03, 0.35));
    for (const double x : {-0.63, 1.0}) scene.boxes.push_back(box(x, 0, -2.5, 0.03, 1.9, 0.35));
    return scene;
}

/// What a picture of ones becomes.
inline ReferenceImage visibility_of(const Ssao& ssao, const RunOptions& options) {
    const ReferenceImage white = uniform(options.depth->width, options.depth->height, {1, 1, 1, 1});
    return develop([&](Composer& composer) { composer.add(ssao); }, white, options);
}

}  // namespace darkroom::test
