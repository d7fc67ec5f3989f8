// SPDX-License-Identifier: MIT
#include "render/shadow/cascades.hpp"

#include <cmath>
#include <limits>

namespace darkroom::render {

using scene::mat4;
using scene::vec3;

namespace {

using glm::dmat3;
using glm::dvec3;

/// Texels between a slice's sphere and the border of its map: 0.5 for snapping, 2 for the filter's taps, 2 for what a
/// receiver is moved by, rounded up.
constexpr std::uint32_t border = 5;

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

/// Columns: right, up and toward the light.
dmat3 light_axes(vec3 toward_light) {
    const dvec3 toward = glm::normalize(dvec3(toward_light));
    // A vertical light has no horizon to be upright against.
    const dvec3 upright = std::abs(toward.y) > 0.99 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(upright, toward));
    return {right, glm::cross(toward, right), toward};
}

/// Orthographic, `half` wide and high around the centre (in light's axes), depth 0 at `near` toward the light.
mat4 light_matrix(const dmat3& axes, dvec3 center, double half, double near, double range) {
    mat4 matrix(1);
    for (int i = 0; i < 3; ++i) {
        matrix[i][0] = static_cast<float>(axes[0][i] / half);
        matrix[i][1] = static_cast<float>(-axes[1][i] / half);
        matrix[i][2] = static_cast<float>(-axes[2][i] / range);
    }
    matrix[3][0] = static_cast<float>(-center.x / half);
    matrix[3][1] = static_cast<float>(center.y / half);
    matrix[3][2] = static_cast<float>((center.z + near) / range);
    return matrix;
}

}  // namespace

std::array<float, most_cascades> practical_splits(float near_distance, float far_distance, float lambda,
                                                  std::uint32_t count) {
    // Orthographic cameras may start at 0 or behind themselves, where a logarithm has nothing to say.
    const double near = near_distance;
    const double far = far_distance;
    const double first = std::max(near, far * 1e-6);
    std::array<float, most_cascades> splits{};
    for (std::uint32_t i = 1; i < count; ++i) {
        const double part = static_cast<double>(i) / count;
        const double logarithmic = first * std::pow(far / first, part);
        const double uniform = near + (far - near) * part;
        splits[i - 1] = static_cast<float>(lambda * logarithmic + (1 - static_cast<double>(lambda)) * uniform);
    }
    splits[count - 1] = far_distance;
    return splits;
}

Cascades fit_cascades(const scene::CameraState& camera, vec3 toward_light, const CascadeDesc& desc) {
    const std::uint32_t count = std::clamp(desc.count, 1U, most_cascades);
    const std::uint32_t resolution = std::max(desc.resolution, 1U);
    const float near = camera.near_distance;
    const float least_far = near + std::max(std::abs(near), 1.0F) * 1e-3F;
    const float far = std::max(std::min(desc.far_distance, camera.far_distance), least_far);
    const dmat3 axes = light_axes(toward_light);
    const mat4 camera_to_world = glm::inverse(camera.view);

    Cascades cascades{.count = count, .splits = practical_splits(near, far, desc.split_lambda, count)};
    float from = near;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Sphere sphere = bounding_sphere(camera.projection, from, cascades.splits[i]);
        const double radius = round_up(sphere.radius);
        const std::uint32_t used = resolution - 2 * std::min(border, resolution / 4);
        const double texel = 2 * radius / used;
        dvec3 center = glm::transpose(axes) * dvec3(camera_to_world * scene::vec4(sphere.center, 1));
        // Whole texels: a point that stands still keeps its place within its texel.
        center.x = std::round(center.x / texel) * texel;
        center.y = std::round(center.y / texel) * texel;
        const double pull_back = std::max(radius, static_cast<double>(desc.least_pull_back));
        cascades.world_to_cascade[i] =
            light_matrix(axes, center, texel * resolution / 2, pull_back, pull_back + radius);
        cascades.texel[i] = static_cast<float>(texel);
        // The next slice starts where the shader starts to blend into it.
        const float before = i == 0 ? near : cascades.splits[i - 1];
        from = cascades.splits[i] - (cascades.splits[i] - before) * cascade_blend;
    }
    return cascades;
}

}  // namespace darkroom::render
