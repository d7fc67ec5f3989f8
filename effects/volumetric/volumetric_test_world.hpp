// SPDX-License-Identifier: MIT
#pragma once
// What tests of volumetric light are set in: a world of boxes, with exact rays, the distances a camera sees in it, and
// a light whose cascades are filled by tracing it. Not part of the library.

#include <algorithm>
#include <cmath>
#include <darkroom/reference.hpp>
#include <limits>
#include <vector>

#include "shared/camera_reference.hpp"

namespace darkroom::test {

struct Box {
    Double3 low{}, high{};
};

inline Double3 normalized(const Double3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}
inline Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Double3 along(const Double3& from, const Double3& direction, double t) {
    return {from[0] + direction[0] * t, from[1] + direction[1] * t, from[2] + direction[2] * t};
}

/// How far a ray goes before it meets a box; infinity where it meets none. From inside a box: 0.
inline double trace(const std::vector<Box>& world, const Double3& from, const Double3& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& box : world) {
        double enter = 0, leave = nearest;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double inverse = 1 / direction[axis];
            const double a = (box.low[axis] - from[axis]) * inverse, b = (box.high[axis] - from[axis]) * inverse;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter < leave) nearest = enter;
    }
    return nearest;
}

/// The ray through a place of the picture: where it starts, and its direction per metre of planar distance.
struct CameraRay {
    CameraRay(const ReferenceCamera& camera, double u, double v)
        : from(camera.eye), direction(camera.world_direction(camera.view_position(u, v, 1))) {}
    Double3 from, direction;
};

inline ReferenceImage traced_depth(const std::vector<Box>& world, const Camera& camera, std::uint32_t width,
                                   std::uint32_t height) {
    const ReferenceCamera eye(camera);
    ReferenceImage out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const CameraRay ray(eye, (x + 0.5) / width, (y + 0.5) / height);
            out.at(x, y).r = double{static_cast<float>(std::min(trace(world, ray.from, ray.direction), 1e10))};
        }
    return out;
}

/// A part of the world that a cascade shows: a cube around `centre`, turned to the light, up to a distance of the
/// camera.
struct CascadeRange {
    Double3 centre{};
    double radius = 10;
    float split = 1000;
};

inline ReferenceLight traced_light(const std::vector<Box>& world, const Double3& toward_light,
                                   const std::vector<CascadeRange>& ranges, std::uint32_t resolution) {
    const Double3 back = normalized(toward_light);
    const Double3 right = normalized(cross(std::abs(back[1]) > 0.9 ? Double3{1, 0, 0} : Double3{0, 1, 0}, back));
    const Double3 down = cross(right, back);
    ReferenceLight out{.light = {.volumetric_intensity = 1}, .resolution = resolution};
    for (std::size_t axis = 0; axis < 3; ++axis) out.light.direction[axis] = static_cast<float>(back[axis]);
    for (const CascadeRange& range : ranges) {
        const std::size_t number = out.cascades.size();
        out.light.splits[number] = range.split;
        Matrix& m = out.light.world_to_cascade[number];
        m = {};
        const Double3 into{-back[0] / 2, -back[1] / 2, -back[2] / 2};
        std::size_t row = 0;
        for (const Double3& axis : {right, down, into}) {
            for (std::size_t column = 0; column < 3; ++column)
                m[column * 4 + row] = static_cast<float>(axis[column] / range.radius);
            m[12 + row] = static_cast<float>((row == 2 ? 0.5 : 0.0) - dot(axis, range.centre) / range.radius);
            ++row;
        }
        m[15] = 1;
        std::vector<float>& depth = out.cascades.emplace_back();
        for (std::uint32_t y = 0; y < resolution; ++y)
            for (std::uint32_t x = 0; x < resolution; ++x) {
                const double across = ((x + 0.5) / resolution * 2 - 1) * range.radius;
                const double downward = ((y + 0.5) / resolution * 2 - 1) * range.radius;
                const Double3 from =
                    along(along(along(range.centre, right, across), down, downward), back, range.radius);
                const double length = trace(world, from, {-back[0], -back[1], -back[2]});
                depth.push_back(static_cast<float>(std::min(length / (2 * range.radius), 1.0)));
            }
    }
    return out;
}

/// A light that nothing hides: cascades of a few texels, all at their far end.
inline ReferenceLight open_light(const Double3& toward_light, float intensity = 1) {
    ReferenceLight out = traced_light({}, toward_light, {{.radius = 500}}, 4);
    out.light.volumetric_intensity = intensity;
    return out;
}

}  // namespace darkroom::test
