// SPDX-License-Identifier: MIT
#include "scene/walk/free_camera.hpp"

#include <cmath>

namespace darkroom::scene {

namespace {

constexpr float min_distance = 1e-3F, max_distance = 1e6F;
constexpr float fitted_margin = 1.1F;

double radians(float degrees) { return glm::radians(static_cast<double>(degrees)); }

vec3 row(const mat4& matrix, int index) { return {matrix[0][index], matrix[1][index], matrix[2][index]}; }

float clamped_distance(float distance) { return std::clamp(distance, min_distance, max_distance); }

}  // namespace

vec3 FreeCamera::forward() const {
    const double level = std::cos(radians(pitch));
    return {static_cast<float>(-level * std::sin(radians(yaw))), static_cast<float>(-std::sin(radians(pitch))),
            static_cast<float>(-level * std::cos(radians(yaw)))};
}

vec3 FreeCamera::right() const {
    return {static_cast<float>(std::cos(radians(yaw))), 0, static_cast<float>(-std::sin(radians(yaw)))};
}

vec3 FreeCamera::up() const { return glm::cross(right(), forward()); }

FreeCamera free_camera(const CameraState& camera) {
    const vec3 outward = row(camera.view, 2), up = row(camera.view, 1);
    const float level = glm::length(vec2(outward.x, outward.z));
    // A vertical view has no heading but that of the top of its picture.
    const vec3 heading = level > 1e-6F ? outward : up * (outward.y < 0 ? 1.0F : -1.0F);
    return {.eye = camera.position,
            .yaw = glm::degrees(std::atan2(heading.x, heading.z)),
            .pitch = glm::degrees(std::atan2(outward.y, level)),
            .distance = clamped_distance(-glm::dot(camera.target - camera.position, outward)),
            .kind = camera.kind,
            .field_of_view = camera.field_of_view,
            .ortho_height = camera.ortho_height};
}

OrbitOverride override_of(const FreeCamera& camera, const Box& bounds) {
    // An orbit of no distance around the eye is the eye itself, to the bit.
    OrbitOverride out{.distance = 0.0F,
                      .yaw = camera.yaw,
                      .pitch = camera.pitch,
                      .target = camera.eye,
                      .field_of_view = camera.field_of_view,
                      .ortho_height = camera.ortho_height};
    if (!bounds.is_empty())
        out.least_far_distance = glm::length(glm::max(bounds.high - camera.eye, camera.eye - bounds.low));
    return out;
}

void look_around(FreeCamera& camera, float yaw, float pitch) {
    camera.yaw = std::remainder(camera.yaw + yaw, 360.0F);
    camera.pitch = std::clamp(camera.pitch + pitch, -90.0F, 90.0F);
}

void orbit(FreeCamera& camera, float yaw, float pitch) {
    const vec3 target = camera.target();
    look_around(camera, yaw, pitch);
    camera.eye = target - camera.distance * camera.forward();
}

void pan(FreeCamera& camera, vec2 moved) {
    const float height = camera.kind == Projection::Orthographic
                             ? camera.ortho_height
                             : 2 * camera.distance * static_cast<float>(std::tan(radians(camera.field_of_view) / 2));
    camera.eye += height * (moved.y * camera.up() - moved.x * camera.right());
}

void dolly(FreeCamera& camera, float factor) {
    const vec3 target = camera.target();
    camera.distance = clamped_distance(camera.distance * factor);
    camera.ortho_height = clamped_distance(camera.ortho_height * factor);
    camera.eye = target - camera.distance * camera.forward();
}

void fly(FreeCamera& camera, vec3 right_up_forward) {
    camera.eye +=
        right_up_forward.x * camera.right() + vec3(0, right_up_forward.y, 0) + right_up_forward.z * camera.forward();
}

void frame_all(FreeCamera& camera, const Box& bounds, float aspect) {
    if (bounds.is_empty()) return;
    const float radius = radius_of(bounds);
    camera.distance = clamped_distance(fitting_distance(radius, camera.field_of_view, aspect));
    camera.ortho_height = clamped_distance(2 * fitted_margin * radius / std::min(aspect, 1.0F));
    camera.eye = bounds.center() - camera.distance * camera.forward();
}

float radius_of(const Box& bounds) {
    const float radius = glm::length(bounds.size()) * 0.5F;
    return radius > 0 ? radius : 1.0F;
}

float fitting_distance(float radius, float field_of_view, float aspect) {
    const float half_height = glm::radians(field_of_view) * 0.5F;
    const float half_width = std::atan(std::tan(half_height) * aspect);
    return fitted_margin * radius / std::sin(std::min(half_height, half_width));
}

}  // namespace darkroom::scene
