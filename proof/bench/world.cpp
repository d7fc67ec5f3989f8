// SPDX-License-Identifier: MIT
#include "world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "upload.hpp"

namespace darkroom::bench {

namespace {

using Vector = std::array<float, 3>;
struct Box {
    Vector low{}, high{};
};
struct Hit {
    float distance = std::numeric_limits<float>::infinity();  ///< in lengths of the direction
    std::size_t axis = 0;                                     ///< across the face that was hit
    [[nodiscard]] bool is_sky() const { return std::isinf(distance); }
};

constexpr float sky_distance = 1e10F;
constexpr Vector eye{0, 1.7F, 8};
/// Of a camera that walks on and looks to the side, from frame to frame: metres, and radians of some 120 degrees a
/// second.
constexpr float walked = 0.05F, turned = 0.035F;
constexpr std::uint32_t cascade_size = 2048;
/// Texels that share a ray, in each direction: the cascades cost as much to read, and a sixteenth to make.
constexpr std::uint32_t texels_per_ray = 4;

/// Metres: a floor, a wall across the far end, and eight columns on each side.
std::vector<Box> street() {
    std::vector<Box> out{{{-500, -1, -500}, {500, 0, 500}}, {{-30, 0, -62}, {30, 12, -60}}};
    for (int row = 0; row < 8; ++row)
        for (const float x : {-4.0F, 4.0F}) {
            const float z = -5.0F * static_cast<float>(row);
            out.push_back({{x - 0.5F, 0, z - 0.5F}, {x + 0.5F, 6, z + 0.5F}});
        }
    return out;
}

Hit trace(const std::vector<Box>& world, const Vector& from, const Vector& direction) {
    Hit nearest;
    const Vector inverse{1 / direction[0], 1 / direction[1], 1 / direction[2]};
    for (const Box& box : world) {
        Hit enter{.distance = 0};
        float leave = nearest.distance;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float a = (box.low[axis] - from[axis]) * inverse[axis];
            const float b = (box.high[axis] - from[axis]) * inverse[axis];
            if (std::min(a, b) > enter.distance) enter = {std::min(a, b), axis};
            leave = std::min(leave, std::max(a, b));
        }
        if (enter.distance < leave) nearest = enter;
    }
    return nearest;
}

/// Looks along -z, 60 degrees high, reversed depth, y down.
Camera street_camera(VkExtent2D extent) {
    Camera camera{.depth = DepthKind::Reversed};
    for (std::size_t axis = 0; axis < 3; ++axis) camera.view[12 + axis] = -eye[axis];
    const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    const float scale = std::sqrt(3.0F), near = camera.near_distance, far = camera.far_distance;
    camera.projection = {};
    camera.projection[0] = scale / aspect;
    camera.projection[5] = -scale;
    camera.projection[10] = near / (far - near);
    camera.projection[11] = -1;
    camera.projection[14] = near * far / (far - near);
    camera.previous_view = camera.view;
    camera.previous_view[0] = camera.previous_view[10] = std::cos(turned);
    camera.previous_view[8] = std::sin(turned);
    camera.previous_view[2] = -camera.previous_view[8];
    const float behind = eye[2] + walked;
    camera.previous_view[12] = -camera.previous_view[8] * behind;
    camera.previous_view[14] = -camera.previous_view[10] * behind;
    camera.previous_projection = camera.projection;
    return camera;
}

/// Previous minus current place of a point that stands still, x and y of the picture that is 2 wide and 2 high.
std::array<float, 2> moved(const Camera& camera, const Vector& place, float right, float down) {
    const Matrix& view = camera.previous_view;
    Vector seen{view[12], view[13], view[14]};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t axis = 0; axis < 3; ++axis) seen[row] += view[axis * 4 + row] * place[axis];
    const Matrix& projection = camera.previous_projection;
    return {projection[0] * seen[0] / -seen[2] - right, projection[5] * seen[1] / -seen[2] - down};
}

Vector normalized(const Vector& v) {
    const float length = std::hypot(v[0], v[1], v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
float dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector along(const Vector& from, const Vector& direction, float way) {
    return {from[0] + direction[0] * way, from[1] + direction[1] * way, from[2] + direction[2] * way};
}

/// The sun stands in the picture, over the wall, so that shafts and god rays have their work.
Light sun() {
    Light light{.direction = normalized({0.3F, 0.35F, -1}),
                .color = {3, 2.8F, 2.5F},
                .volumetric_intensity = 1,
                .cascade_count = Light::max_cascades,
                .splits = {8, 20, 50, 120}};
    return light;
}

/// Fills the light's matrices, each of a cube around its part of what the camera sees, and returns all depths.
std::vector<float> shadows(const std::vector<Box>& world, Light& light) {
    const Vector back = light.direction, right = normalized(cross({0, 1, 0}, back)), down = cross(right, back);
    const Vector into{-back[0], -back[1], -back[2]};
    std::vector<float> out;
    out.reserve(std::size_t{cascade_size} * cascade_size * light.cascade_count);
    float near = 0;
    for (std::size_t cascade = 0; cascade < light.cascade_count; ++cascade) {
        const float radius = 0.8F * light.splits[cascade];
        const Vector centre{eye[0], eye[1], eye[2] - 0.5F * (near + light.splits[cascade])};
        near = light.splits[cascade];
        Matrix& m = light.world_to_cascade[cascade];
        m = {};
        std::size_t row = 0;
        for (const Vector& axis : {right, down, into}) {
            const float scale = row == 2 ? 0.5F / radius : 1 / radius;
            for (std::size_t column = 0; column < 3; ++column) m[column * 4 + row] = axis[column] * scale;
            m[12 + row] = (row == 2 ? 0.5F : 0.0F) - dot(axis, centre) * scale;
            ++row;
        }
        m[15] = 1;
        constexpr std::uint32_t rays = cascade_size / texels_per_ray;
        for (std::uint32_t y = 0; y < rays; ++y) {
            const std::size_t line = out.size();
            for (std::uint32_t x = 0; x < rays; ++x) {
                const auto place = [&](std::uint32_t ray) {
                    return ((static_cast<float>(ray) + 0.5F) / rays * 2 - 1) * radius;
                };
                const Vector from = along(along(along(centre, right, place(x)), down, place(y)), back, radius);
                const float depth = std::min(trace(world, from, into).distance / (2 * radius), 1.0F);
                out.insert(out.end(), texels_per_ray, depth);
            }
            for (std::uint32_t copy = 1; copy < texels_per_ray; ++copy)
                out.insert(out.end(), out.begin() + static_cast<std::ptrdiff_t>(line),
                           out.begin() + static_cast<std::ptrdiff_t>(line + cascade_size));
        }
    }
    return out;
}

}  // namespace

StreetView view_street(VkExtent2D extent) {
    const std::vector<Box> world = street();
    StreetView out{.camera = street_camera(extent)};
    const Matrix& projection = out.camera.projection;
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const float right = (static_cast<float>(x) + 0.5F) / static_cast<float>(extent.width) * 2 - 1;
            const float down = (static_cast<float>(y) + 0.5F) / static_cast<float>(extent.height) * 2 - 1;
            const Vector direction{right / projection[0], down / projection[5], -1};
            const Hit hit = trace(world, eye, direction);
            out.distance.push_back(hit.is_sky() ? sky_distance : hit.distance);
            out.depth.push_back(hit.is_sky() ? 0 : std::max(projection[14] / hit.distance - projection[10], 0.0F));
            for (std::size_t axis = 0; axis < 3; ++axis)
                out.normals.push_back(hit.is_sky() || axis != hit.axis ? 0 : std::copysign(1.0F, -direction[axis]));
            const Vector place = along(eye, direction, hit.is_sky() ? 1e6F : hit.distance);
            const auto [x_moved, y_moved] = moved(out.camera, place, right, down);
            out.velocity.push_back(x_moved * static_cast<float>(extent.width) / 2);
            out.velocity.push_back(y_moved * static_cast<float>(extent.height) / 2);
        }
    return out;
}

Result<World> World::create(gpu::Context& context, VkExtent2D extent) {
    const StreetView seen = view_street(extent);
    std::vector<std::uint16_t> normals;
    for (std::size_t i = 0; i < seen.normals.size(); ++i) {
        normals.push_back(half_bits(seen.normals[i]));
        if (i % 3 == 2) normals.push_back(0);
    }
    std::vector<std::uint16_t> velocity;
    for (const float number : seen.velocity) velocity.push_back(half_bits(number));
    std::vector<std::uint8_t> ui(std::size_t{4} * extent.width * extent.height);
    for (std::size_t i = 0; i < ui.size() / 4; ++i) {
        const std::size_t x = i % extent.width, y = i / extent.width;
        const bool is_pane = (y / 64 + x / 160) % 4 == 0;
        const std::uint8_t alpha = !is_pane ? 0 : x % 160 < 120 ? 255 : 128;
        for (std::size_t k = 0; k < 4; ++k)
            ui[4 * i + k] = k == 3 ? alpha : static_cast<std::uint8_t>(alpha * (k + 1) / 4);
    }
    World world{.camera = seen.camera, .light = sun()};
    const auto make = [&](gpu::Image& image, const char* name, VkFormat format, VkExtent2D size, std::uint32_t layers,
                          const auto& numbers) -> Result<> {
        const bool has_storage = format != VK_FORMAT_D32_SFLOAT;
        DARKROOM_TRY_VALUE(image, upload(context,
                                         {.name = name,
                                          .format = format,
                                          .extent = {size.width, size.height, 1},
                                          .array_layers = layers,
                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                   (has_storage ? VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT} : 0)},
                                         std::as_bytes(std::span(numbers)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL));
        return {};
    };
    auto done = make(world.depth, "depth", VK_FORMAT_D32_SFLOAT, extent, 1, seen.depth);
    if (done) done = make(world.distance, "distance", VK_FORMAT_R32_SFLOAT, extent, 1, seen.distance);
    if (done) done = make(world.normals, "normals", VK_FORMAT_R16G16B16A16_SFLOAT, extent, 1, normals);
    if (done) done = make(world.velocity, "velocity", VK_FORMAT_R16G16_SFLOAT, extent, 1, velocity);
    if (done) done = make(world.ui, "ui", VK_FORMAT_R8G8B8A8_UNORM, extent, 1, ui);
    if (done)
        done = make(world.cascades, "cascades", VK_FORMAT_D32_SFLOAT, {cascade_size, cascade_size}, Light::max_cascades,
                    shadows(street(), world.light));
    if (!done) return failure(std::move(done));
    world.light.cascades = {.image = world.cascades.handle,
                            .view = world.cascades.view,
                            .format = world.cascades.info.format,
                            .extent = {cascade_size, cascade_size},
                            .layer_count = Light::max_cascades,
                            .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            .final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    return world;
}

}  // namespace darkroom::bench
