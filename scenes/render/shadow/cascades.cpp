// SPDX-License-Identifier: MIT
#include "render/shadow/cascades.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace darkroom::render {

using scene::mat4;
using scene::vec3;

namespace {

using glm::dmat3;
using glm::dvec3;

/// Texels between a slice's sphere and the border of its map: 0.5 for snapping, 2 for the filter's taps, 1 for what a
/// receiver is moved by, rounded up, and one that rounding may take.
constexpr std::uint32_t border = 5;
/// What the scene sets grows in steps of these many a power of two, so that texels stay when the camera moves a little.
constexpr double distance_steps = 2, size_steps = 4;

struct Sphere {
    vec3 center{0};  ///< camera space
    float radius = 0;
};

/// Four corners of the view at a distance, camera space, for any projection without rotation: in clip space
/// x = P00 x + P20 z + P30 and w = P23 z + P33.
std::array<vec3, 4> section(const mat4& projection, float distance) {
    const float w = projection[3][3] - projection[2][3] * distance;
    std::array<vec3, 4> corners{};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const float x = (i & 1U) != 0 ? w : -w;
        const float y = (i & 2U) != 0 ? w : -w;
        corners[i] = vec3((x + projection[2][0] * distance - projection[3][0]) / projection[0][0],
                          (y + projection[2][1] * distance - projection[3][1]) / projection[1][1], -distance);
    }
    return corners;
}

/// The smallest sphere whose centre lies on the line between the centres of both ends. It is made in camera space, so
/// that turning and moving the camera cannot change it by a bit.
Sphere bounding_sphere(const mat4& projection, float from, float to) {
    const std::array<vec3, 4> near = section(projection, from);
    const std::array<vec3, 4> far = section(projection, to);
    const vec3 near_center = (near[0] + near[3]) * 0.5F;
    const vec3 far_center = (far[0] + far[3]) * 0.5F;
    const vec3 axis = far_center - near_center;
    const float length = glm::dot(axis, axis);
    const vec3 near_half = near[3] - near_center;
    const vec3 far_half = far[3] - far_center;
    const float place = 0.5F + (glm::dot(far_half, far_half) - glm::dot(near_half, near_half)) / (2 * length);
    Sphere sphere{.center = near_center + axis * std::clamp(place, 0.0F, 1.0F)};
    for (const vec3& corner : near) sphere.radius = std::max(sphere.radius, glm::distance(corner, sphere.center));
    for (const vec3& corner : far) sphere.radius = std::max(sphere.radius, glm::distance(corner, sphere.center));
    return sphere;
}

/// To whole metres, small ones to a sixteenth of their power of two: a zooming camera changes the texels in steps. The
/// little that is added first keeps what lies on the sphere inside in spite of rounding.
float round_up(float radius) {
    const float grown = std::max(radius * 1.0001F, std::numeric_limits<float>::min());
    const float step = std::exp2(std::min(std::floor(std::log2(grown)) - 4, 0.0F));
    return std::ceil(grown / step) * step;
}

/// To the next of `steps` values a power of two.
double round_up_in_steps(double value, double steps) {
    return std::exp2(std::ceil(std::log2(value) * steps - 1e-6) / steps);
}

using Polygon = std::vector<glm::dvec4>;

/// The part where dot(plane, corner) >= 0 (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974).
Polygon clip(const Polygon& polygon, const glm::dvec4& plane) {
    Polygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec4 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double before = glm::dot(plane, from), after = glm::dot(plane, to);
        if (before >= 0) out.push_back(from);
        if ((before >= 0) != (after >= 0)) out.push_back(from + (to - from) * (before / (before - after)));
    }
    return out;
}

/// One of six faces of a box, in homogeneous coordinates.
Polygon face_of(const scene::Box& box, int face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    Polygon corners;
    for (const auto& [is_right, is_down] : {std::pair(false, false), {true, false}, {true, true}, {false, true}}) {
        glm::dvec4 corner(0, 0, 0, 1);
        corner[axis] = face % 2 != 0 ? box.high[axis] : box.low[axis];
        corner[u] = is_right ? box.high[u] : box.low[u];
        corner[v] = is_down ? box.high[v] : box.low[v];
        corners.push_back(corner);
    }
    return corners;
}

/// What the light sees of something: along its axes.
struct LightBounds {
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

LightBounds light_bounds(const dmat3& axes, const scene::Box& box) {
    LightBounds out;
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner((i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                           (i & 4) != 0 ? box.high.z : box.low.z);
        const dvec3 place = glm::transpose(axes) * corner;
        out.low = glm::min(out.low, place);
        out.high = glm::max(out.high, place);
    }
    return out;
}

/// A slice's square across the light, and its depth along it.
struct Extent {
    dvec3 center{0};
    double half = 0, near = 0, far = 0;  ///< along the axis toward the light: near is the greater
};

/// What lies outside of the scene as the light sees it is lit, or behind all that is.
/// `min_reach`: texels before the slice in which the distance of casters counts.
Extent fit(dvec3 center, double radius, const LightBounds& bounds, double min_reach, std::uint32_t used) {
    const dvec3 low = glm::max(center - radius, bounds.low), high = glm::min(center + radius, bounds.high);
    Extent out{.center = center, .half = radius};
    if (low.x < high.x && low.y < high.y) {
        const double needed = std::max(high.x - low.x, high.y - low.y) / 2;
        out.half = std::min(radius, round_up_in_steps(std::max(needed, radius * 1e-3), size_steps));
        // A square that is no smaller than the slice's is that one, which the scene's edges do not move.
        if (out.half < radius) out.center = dvec3((low + high) * 0.5);
    }
    // What is behind everything is compared at depth 1, so that the far end may lie anywhere before the near one.
    const double texel = 2 * out.half / used;
    out.near = std::max(std::min(bounds.high.z, center.z + radius + min_reach * texel), low.z);
    const double least = radius * 1e-3;
    out.far = std::min(low.z, out.near - least);
    // A little before the first surface, which must not lie at depth 0, where casters before it are.
    out.near += (out.near - out.far) * 1e-3;
    return out;
}

/// Columns: right, up and toward the light.
dmat3 light_axes(vec3 toward_light) {
    const dvec3 toward = glm::normalize(dvec3(toward_light));
    // A vertical light has no horizon to be upright against.
    const dvec3 upright = std::abs(toward.y) > 0.99 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(upright, toward));
    return {right, glm::cross(toward, right), toward};
}

/// Orthographic, `half` wide and high around the centre (in light's axes), depth 0 at `near` .. 1 at `far`.
mat4 light_matrix(const dmat3& axes, const Extent& extent) {
    mat4 matrix(1);
    const double range = extent.near - extent.far;
    for (int i = 0; i < 3; ++i) {
        matrix[i][0] = static_cast<float>(axes[0][i] / extent.half);
        matrix[i][1] = static_cast<float>(-axes[1][i] / extent.half);
        matrix[i][2] = static_cast<float>(-axes[2][i] / range);
    }
    matrix[3][0] = static_cast<float>(-extent.center.x / extent.half);
    matrix[3][1] = static_cast<float>(extent.center.y / extent.half);
    matrix[3][2] = static_cast<float>(extent.near / range);
    return matrix;
}

}  // namespace

std::array<float, max_cascades> practical_splits(float near_distance, float far_distance, float lambda,
                                                 std::uint32_t count) {
    // Orthographic cameras may start at 0 or behind themselves, where a logarithm has nothing to say.
    const double near = near_distance;
    const double far = far_distance;
    const double first = std::max(near, far * 1e-6);
    std::array<float, max_cascades> splits{};
    for (std::uint32_t i = 1; i < count; ++i) {
        const double part = static_cast<double>(i) / count;
        const double logarithmic = first * std::pow(far / first, part);
        const double uniform = near + (far - near) * part;
        splits[i - 1] = static_cast<float>(lambda * logarithmic + (1 - static_cast<double>(lambda)) * uniform);
    }
    splits[count - 1] = far_distance;
    return splits;
}

double farthest_in_view(const scene::CameraState& camera, const scene::Box& box) {
    if (box.is_empty()) return 0;
    const glm::dmat4 view(camera.view);
    const glm::dmat4 rows = glm::transpose(glm::dmat4(camera.projection) * view);
    double farthest = 0;
    for (int face = 0; face < 6; ++face) {
        Polygon seen = face_of(box, face);
        for (const auto& plane : {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]})
            seen = clip(seen, plane);
        for (const glm::dvec4& corner : seen) farthest = std::max(farthest, -(view * corner).z);
    }
    return farthest;
}

Cascades fit_cascades(const scene::CameraState& camera, vec3 toward_light, const CascadeDesc& desc,
                      const CascadeScene& scene) {
    const std::uint32_t count = std::clamp(desc.count, 1U, max_cascades);
    const std::uint32_t resolution = std::max(desc.resolution, 1U);
    const float near = camera.near_distance;
    const float least_far = near + std::max(std::abs(near), 1.0F) * 1e-3F;
    const scene::Box everything = CascadeScene{}.bounds;
    const scene::Box& box = scene.bounds.is_empty() ? everything : scene.bounds;
    const double seen = std::max(farthest_in_view(camera, box), double{least_far});
    const float far = std::max(
        std::min({desc.far_distance, camera.far_distance, static_cast<float>(round_up_in_steps(seen, distance_steps))}),
        least_far);
    const dmat3 axes = light_axes(toward_light);
    const LightBounds bounds = light_bounds(axes, box);
    const mat4 camera_to_world = glm::inverse(camera.view);

    Cascades cascades{.count = count, .splits = practical_splits(near, far, desc.split_lambda, count)};
    const double soft_reach = desc.filter == ShadowFilter::Soft ? max_penumbra / sun_tangent : 0.0F;
    const double reach = scene.holds_casters ? std::numeric_limits<double>::infinity() : soft_reach;
    float from = near;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Sphere sphere = bounding_sphere(camera.projection, from, cascades.splits[i]);
        const dvec3 center = glm::transpose(axes) * dvec3(camera_to_world * scene::vec4(sphere.center, 1));
        const std::uint32_t used = resolution - 2 * std::min(border, resolution / 4);
        Extent extent = fit(center, round_up(sphere.radius), bounds, reach, used);
        const double texel = 2 * extent.half / used;
        // Whole texels: a point that stands still keeps its place within its texel.
        extent.center.x = std::round(extent.center.x / texel) * texel;
        extent.center.y = std::round(extent.center.y / texel) * texel;
        extent.half = texel * resolution / 2;
        cascades.world_to_cascade[i] = light_matrix(axes, extent);
        cascades.texel[i] = static_cast<float>(texel);
        // The next slice starts where the shader starts to blend into it.
        const float before = i == 0 ? near : cascades.splits[i - 1];
        from = cascades.splits[i] - (cascades.splits[i] - before) * cascade_blend;
    }
    return cascades;
}

}  // namespace darkroom::render
