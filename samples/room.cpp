// SPDX-License-Identifier: MIT
#include "room.hpp"

#include <algorithm>
#include <utility>

namespace darkroom::samples {
namespace {

constexpr float pi = 3.14159265f;
constexpr float far_away = 1.0e9f;
constexpr float surface_offset = 1.0e-3f;  // of secondary rays, in metres

const Vec3 to_sun = normalize({-0.40f, 0.56f, -0.74f});
constexpr Vec3 sun_irradiance = {34.0f, 29.0f, 22.0f};
constexpr Vec3 window_radiance = {4.4f, 5.4f, 7.0f};
constexpr Vec3 ambient = {0.030f, 0.034f, 0.042f};

constexpr float back = -4.0f;
constexpr float half_width = 4.2f;
constexpr float ceiling = 4.4f;
constexpr float window_half_width = 2.0f;
constexpr float window_low = 0.8f;
constexpr float window_high = 3.7f;

struct Lamp {
    Vec3 position;
    float radius = 0.0f;
    Vec3 radiance;
};
// Lamps over the left aisle, and two candles on the table.
constexpr std::array<Lamp, 5> lamps = {{{{-1.95f, 2.75f, -2.3f}, 0.070f, {200.0f, 128.0f, 58.0f}},
                                        {{-1.95f, 2.75f, 0.1f}, 0.070f, {200.0f, 128.0f, 58.0f}},
                                        {{-1.95f, 2.75f, 2.5f}, 0.070f, {200.0f, 128.0f, 58.0f}},
                                        {{0.10f, 1.135f, -0.75f}, 0.022f, {90.0f, 50.0f, 16.0f}},
                                        {{0.34f, 1.065f, -0.62f}, 0.022f, {90.0f, 50.0f, 16.0f}}}};

/// Point `index` of a rank-1 lattice: sixteen different places along either side of the light.
std::array<float, 2> grid_point(std::uint32_t index) {
    return {(static_cast<float>(index) + 0.5f) / 16.0f, (static_cast<float>(index * 7U % 16U) + 0.5f) / 16.0f};
}

float fraction(float x) { return x - std::floor(x); }

/// Where a ray enters and leaves a box; it misses if it leaves before it enters.
std::pair<float, float> slab(Vec3 low, Vec3 high, Vec3 origin, Vec3 inverse) {
    const Vec3 a = (low - origin) * inverse;
    const Vec3 b = (high - origin) * inverse;
    return {std::max(std::max(std::min(a.x, b.x), std::min(a.y, b.y)), std::min(a.z, b.z)),
            std::min(std::min(std::max(a.x, b.x), std::max(a.y, b.y)), std::max(a.z, b.z))};
}

float smoothstep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace

Vec3 Camera::to_view(Vec3 world) const {
    const Vec3 d = world - position;
    const float c = std::cos(pitch_rad);
    const float s = std::sin(pitch_rad);
    return {d.x, c * d.y + s * d.z, -s * d.y + c * d.z};
}

Vec3 Camera::ray(float u, float v) const {
    const float t = std::tan(0.5f * vertical_fov_rad);
    const float x = (2.0f * u - 1.0f) * t * aspect;
    const float y = (1.0f - 2.0f * v) * t;
    const float c = std::cos(pitch_rad);
    const float s = std::sin(pitch_rad);
    return {x, c * y + s, s * y - c};
}

std::array<float, 2> Camera::project(Vec3 view) const {
    const float t = std::tan(0.5f * vertical_fov_rad);
    return {0.5f + 0.5f * view.x / (-view.z * t * aspect), 0.5f - 0.5f * view.y / (-view.z * t)};
}

Room::Room() {
    build_shell();
    build_furniture();
    outside_ = groups_.size();
    build_outside();
    close_groups();
}

void Room::close_groups() {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        Group& group = groups_[i];
        group.end = i + 1 < groups_.size() ? groups_[i + 1].first : shapes_.size();
        group.low = {far_away, far_away, far_away};
        group.high = group.low * -1.0f;
        for (std::size_t k = group.first; k < group.end; ++k) {
            const Shape& shape = shapes_[k];
            Vec3 low = shape.low;
            Vec3 high = shape.high;
            const float radius = shape.high.x;
            if (shape.kind == Kind::Sphere) {
                low = shape.low - Vec3{radius, radius, radius};
                high = shape.low + Vec3{radius, radius, radius};
            } else if (shape.kind == Kind::Cylinder) {
                low = shape.low - Vec3{radius, 0.0f, radius};
                high = shape.low + Vec3{radius, shape.high.y, radius};
            }
            group.low = {std::min(group.low.x, low.x), std::min(group.low.y, low.y), std::min(group.low.z, low.z)};
            group.high = {std::max(group.high.x, high.x), std::max(group.high.y, high.y),
                          std::max(group.high.z, high.z)};
        }
    }
}

void Room::box(Vec3 low, Vec3 high, const Material& material) {
    shapes_.push_back({.kind = Kind::Box, .low = low, .high = high, .material = material});
}
void Room::sphere(Vec3 centre, float radius, const Material& material, Vec3 motion) {
    shapes_.push_back(
        {.kind = Kind::Sphere, .low = centre, .high = {radius, 0.0f, 0.0f}, .material = material, .motion = motion});
}
void Room::cylinder(Vec3 foot, float radius, float height, const Material& material) {
    shapes_.push_back({.kind = Kind::Cylinder, .low = foot, .high = {radius, height, 0.0f}, .material = material});
}

void Room::build_shell() {
    const Material floor = {.albedo = {0.52f, 0.47f, 0.40f}, .reflectance = 0.05f, .texture = 1};
    const Material plaster = {.albedo = {0.66f, 0.60f, 0.52f}, .texture = 3};
    const Material stone = {.albedo = {0.62f, 0.58f, 0.52f}};
    const Material frame = {.albedo = {0.10f, 0.075f, 0.055f}, .reflectance = 0.04f};
    const float front = 8.0f;
    begin_group();
    box({-half_width, -0.3f, back - 0.3f}, {half_width, 0.0f, front}, floor);
    box({-half_width, ceiling, back - 0.3f}, {half_width, ceiling + 0.3f, front}, plaster);
    box({-half_width - 0.3f, 0.0f, back - 0.3f}, {-half_width, ceiling, front}, plaster);
    box({half_width, 0.0f, back - 0.3f}, {half_width + 0.3f, ceiling, front}, plaster);
    box({-half_width, 0.0f, front}, {half_width, ceiling, front + 0.3f}, plaster);
    // The back wall is what is left around the window.
    box({-half_width, 0.0f, back - 0.3f}, {half_width, window_low, back}, plaster);
    box({-half_width, window_high, back - 0.3f}, {half_width, ceiling, back}, plaster);
    box({-half_width, window_low, back - 0.3f}, {-window_half_width, window_high, back}, plaster);
    box({window_half_width, window_low, back - 0.3f}, {half_width, window_high, back}, plaster);
    begin_group();
    box({-2.15f, 0.72f, back}, {2.15f, 0.80f, back + 0.16f}, stone);
    for (const float x : {-1.97f, -1.0f, 0.0f, 1.0f, 1.97f}) {
        box({x - 0.035f, window_low, -4.20f}, {x + 0.035f, window_high, -4.12f}, frame);
    }
    for (const float y : {0.83f, 1.75f, 2.70f, 3.67f}) {
        box({-window_half_width, y - 0.03f, -4.19f}, {window_half_width, y + 0.03f, -4.13f}, frame);
    }
    for (const float side : {-1.0f, 1.0f}) {
        for (const float z : {-2.6f, -0.2f, 2.2f}) {
            const float x = side * 2.95f;
            begin_group();
            cylinder({x, 0.24f, z}, 0.21f, 3.66f, stone);
            cylinder({x, 0.16f, z}, 0.26f, 0.08f, stone);
            cylinder({x, 3.82f, z}, 0.26f, 0.08f, stone);
            box({x - 0.31f, 0.0f, z - 0.31f}, {x + 0.31f, 0.16f, z + 0.31f}, stone);
            box({x - 0.31f, 3.90f, z - 0.31f}, {x + 0.31f, 4.05f, z + 0.31f}, stone);
        }
    }
    begin_group();
    for (const float side : {-1.0f, 1.0f}) {
        box({side * 2.95f - 0.22f, 4.05f, back}, {side * 2.95f + 0.22f, ceiling, front}, stone);
    }
    for (const float z : {-2.6f, -0.2f, 2.2f, 4.6f}) {
        box({-2.73f, 4.18f, z - 0.12f}, {2.73f, ceiling, z + 0.12f}, {.albedo = {0.20f, 0.12f, 0.07f}, .texture = 2});
    }
}

void Room::build_furniture() {
    const Material wood = {.albedo = {0.34f, 0.19f, 0.10f}, .reflectance = 0.04f, .texture = 2};
    const Material iron = {.albedo = {0.06f, 0.06f, 0.065f}, .reflectance = 0.05f};
    const Material gold = {.albedo = {0.95f, 0.70f, 0.33f}, .reflectance = 0.8f, .is_metal = true};
    const Material silver = {.albedo = {0.88f, 0.90f, 0.93f}, .reflectance = 0.8f, .is_metal = true};
    const Material wax = {.albedo = {0.80f, 0.74f, 0.62f}, .emission = {0.5f, 0.3f, 0.12f}};
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const Lamp& lamp = lamps[i];
        if (i < 4) begin_group();
        sphere(lamp.position, lamp.radius, {.emission = lamp.radiance});
        const Vec3 p = lamp.position;
        if (i < 3) {
            cylinder({p.x, p.y + 0.07f, p.z}, 0.012f, ceiling - p.y - 0.07f, iron);
            cylinder({p.x, p.y + 0.06f, p.z}, 0.13f, 0.03f, gold);
        } else {
            cylinder({p.x, 0.80f, p.z}, 0.035f, p.y - 0.825f, wax);
        }
    }
    box({-0.45f, 0.74f, -1.25f}, {1.45f, 0.80f, -0.35f}, wood);
    for (const float x : {-0.35f, 1.27f}) {
        for (const float z : {-1.15f, -0.53f}) box({x, 0.0f, z}, {x + 0.08f, 0.74f, z + 0.08f}, wood);
    }
    sphere({0.98f, 0.98f, -0.80f}, 0.18f, gold);
    sphere({0.62f, 0.90f, -0.60f}, 0.10f, {.albedo = {0.05f, 0.22f, 0.30f}, .reflectance = 0.06f});
    box({-0.38f, 0.80f, -1.10f}, {-0.06f, 0.86f, -0.88f}, {.albedo = {0.36f, 0.06f, 0.05f}});
    box({-0.35f, 0.86f, -1.08f}, {-0.09f, 0.91f, -0.90f}, {.albedo = {0.07f, 0.16f, 0.10f}});
    begin_group();
    // A crate, a large mirror ball, a vase, and the ball that flies.
    box({1.75f, 0.0f, -2.35f}, {2.45f, 0.70f, -1.65f}, wood);
    cylinder({2.1f, 0.70f, -2.0f}, 0.11f, 0.26f, {.albedo = {0.16f, 0.24f, 0.42f}, .reflectance = 0.06f});
    sphere({2.1f, 1.06f, -2.0f}, 0.20f, {.albedo = {0.10f, 0.26f, 0.07f}});
    begin_group();
    sphere({-1.35f, 0.42f, -1.75f}, 0.42f, silver);
    sphere({-0.98f, 1.62f, 1.35f}, 0.19f, {.albedo = {0.62f, 0.045f, 0.03f}, .reflectance = 0.05f},
           {0.16f, 0.05f, 0.0f});
    begin_group();
    // A bench near the camera, and neon along the right wall.
    box({0.85f, 0.42f, 2.35f}, {2.35f, 0.50f, 2.85f}, wood);
    for (const float x : {0.95f, 2.15f}) box({x, 0.0f, 2.45f}, {x + 0.10f, 0.42f, 2.75f}, wood);
    sphere({1.75f, 0.66f, 2.60f}, 0.16f, {.albedo = {0.70f, 0.42f, 0.06f}, .reflectance = 0.05f});
    begin_group();
    box({4.14f, 2.30f, -3.5f}, {4.18f, 2.36f, 1.6f}, {.emission = {3.0f, 20.0f, 26.0f}});
}

void Room::build_outside() {
    begin_group();
    box({-400.0f, -1.2f, -400.0f}, {400.0f, -0.7f, back - 0.3f}, {.albedo = {0.16f, 0.22f, 0.08f}});
    const Material leaves = {.albedo = {0.09f, 0.17f, 0.05f}};
    const Material trunk = {.albedo = {0.12f, 0.08f, 0.05f}};
    struct Tree {
        float x, z, size;
    };
    for (const Tree tree : {Tree{-5.2f, -17.0f, 1.5f}, Tree{3.8f, -22.0f, 1.9f}, Tree{-1.5f, -38.0f, 2.3f},
                            Tree{9.5f, -46.0f, 3.0f}, Tree{-14.0f, -52.0f, 3.4f}}) {
        begin_group();
        const float crown = -0.7f + 1.7f * tree.size;
        cylinder({tree.x, -0.7f, tree.z}, 0.12f * tree.size, 1.4f * tree.size, trunk);
        sphere({tree.x, crown, tree.z}, tree.size, leaves);
        sphere({tree.x + 0.7f * tree.size, crown - 0.2f * tree.size, tree.z + 0.3f}, 0.7f * tree.size, leaves);
        sphere({tree.x - 0.6f * tree.size, crown + 0.4f * tree.size, tree.z}, 0.65f * tree.size, leaves);
    }
    begin_group();
    const Material hill = {.albedo = {0.13f, 0.17f, 0.09f}};
    sphere({-60.0f, -105.0f, -190.0f}, 120.0f, hill);
    sphere({55.0f, -150.0f, -260.0f}, 170.0f, hill);
    sphere({-10.0f, -275.0f, -390.0f}, 305.0f, hill);
}

float Room::intersect(const Shape& shape, const Ray& ray, float nearest) {
    const Vec3 direction = ray.direction;
    switch (shape.kind) {
        case Kind::Box: {
            const auto [enter, leave] = slab(shape.low, shape.high, ray.origin, ray.inverse);
            return enter <= leave && enter > 0.0f && enter < nearest ? enter : nearest;
        }
        case Kind::Sphere: {
            const Vec3 offset = ray.origin - shape.low;
            const float a = dot(direction, direction);
            const float b = dot(offset, direction);
            // The distance of the ray from the centre by the perpendicular: far spheres keep their precision.
            const Vec3 closest = offset - direction * (b / a);
            const float rest = shape.high.x * shape.high.x - dot(closest, closest);
            if (rest < 0.0f) return nearest;
            const float t = (-b - std::sqrt(rest * a)) / a;
            return t > 0.0f && t < nearest ? t : nearest;
        }
        case Kind::Cylinder:
            break;
    }
    const Vec3 offset = ray.origin - shape.low;
    const float height = shape.high.y;
    const float radius2 = shape.high.x * shape.high.x;
    const float a = direction.x * direction.x + direction.z * direction.z;
    const float b = offset.x * direction.x + offset.z * direction.z;
    const float c = offset.x * offset.x + offset.z * offset.z - radius2;
    const float discriminant = b * b - a * c;
    if (discriminant < 0.0f) return nearest;
    const float side = (-b - std::sqrt(discriminant)) / a;
    const float y = offset.y + side * direction.y;
    if (side > 0.0f && y >= 0.0f && y <= height) return std::min(side, nearest);
    const float cap = ((direction.y < 0.0f ? height : 0.0f) - offset.y) / direction.y;
    const float cap_x = offset.x + cap * direction.x;
    const float cap_z = offset.z + cap * direction.z;
    return cap > 0.0f && cap_x * cap_x + cap_z * cap_z <= radius2 ? std::min(cap, nearest) : nearest;
}

void Room::trace(Hit& hit, const Ray& ray, std::size_t first_group, std::size_t end_group) const {
    for (std::size_t i = first_group; i < end_group; ++i) {
        const Group& group = groups_[i];
        const auto [enter, leave] = slab(group.low, group.high, ray.origin, ray.inverse);
        if (enter > leave || leave < 0.0f || enter > hit.distance) continue;
        for (std::size_t k = group.first; k < group.end; ++k) {
            const float distance = intersect(shapes_[k], ray, hit.distance);
            if (distance < hit.distance) hit = {.distance = distance, .shape = &shapes_[k]};
        }
    }
}

Room::Hit Room::trace(const Ray& ray) const {
    Hit hit{.distance = far_away};
    trace(hit, ray, 0, outside_);
    if (hit.shape == nullptr) trace(hit, ray, outside_, groups_.size());
    return hit;
}

bool Room::is_free(Vec3 from, Vec3 to, std::size_t first_group, std::size_t end_group) const {
    const Ray ray(from, to - from);
    for (std::size_t i = first_group; i < end_group; ++i) {
        const Group& group = groups_[i];
        const auto [enter, leave] = slab(group.low, group.high, ray.origin, ray.inverse);
        if (enter > leave || leave < 0.0f || enter > 1.0f) continue;
        for (std::size_t k = group.first; k < group.end; ++k) {
            // The lamps themselves are what shadow rays aim at.
            if (shapes_[k].material.emission.x < 2.0f && intersect(shapes_[k], ray, 1.0f) < 1.0f) return false;
        }
    }
    return true;
}

bool Room::sees_sun(Vec3 from, Vec3 direction) const {
    const Vec3 far_end = from + direction * 100.0f;
    if (from.z < back - 0.3f) return is_free(from, far_end, outside_, groups_.size());
    // The sun comes in by the window only, through the whole thickness of the wall.
    for (const float z : {back, back - 0.3f}) {
        const Vec3 p = from + direction * std::max(0.0f, (z - from.z) / direction.z);
        if (std::abs(p.x) > window_half_width || p.y < window_low || p.y > window_high) return false;
    }
    return is_free(from, far_end, 1, outside_);
}

Vec3 Room::normal_of(const Shape& shape, Vec3 position) {
    if (shape.kind == Kind::Sphere) return normalize(position - shape.low);
    if (shape.kind == Kind::Cylinder) {
        const Vec3 offset = position - shape.low;
        const float slack = 1.0e-4f;
        if (offset.y < slack) return {0.0f, -1.0f, 0.0f};
        if (offset.y > shape.high.y - slack) return {0.0f, 1.0f, 0.0f};
        return normalize({offset.x, 0.0f, offset.z});
    }
    // The side of the box that the position is closest to.
    const std::array<float, 6> gaps = {position.x - shape.low.x,  shape.high.x - position.x, position.y - shape.low.y,
                                       shape.high.y - position.y, position.z - shape.low.z,  shape.high.z - position.z};
    constexpr std::array<Vec3, 6> normals = {{{-1.0f, 0.0f, 0.0f},
                                              {1.0f, 0.0f, 0.0f},
                                              {0.0f, -1.0f, 0.0f},
                                              {0.0f, 1.0f, 0.0f},
                                              {0.0f, 0.0f, -1.0f},
                                              {0.0f, 0.0f, 1.0f}}};
    std::size_t best = 0;
    for (std::size_t i = 1; i < gaps.size(); ++i) {
        if (std::abs(gaps[i]) < std::abs(gaps[best])) best = i;
    }
    return normals[best];
}

Vec3 Room::sky(Vec3 direction) {
    const float up = std::max(direction.y, 0.0f);
    const Vec3 clear = mix({2.3f, 2.6f, 3.0f}, {0.40f, 1.05f, 2.7f}, smoothstep(-0.02f, 0.22f, up));
    // Long, soft clouds: a few waves across the dome.
    const float x = direction.x / (up + 0.25f);
    const float z = direction.z / (up + 0.25f);
    const float waves = std::sin(2.1f * x + 0.8f * std::sin(1.7f * z)) + 0.5f * std::sin(5.3f * x + 3.1f * z) +
                        0.25f * std::sin(11.0f * x - 7.0f * z + 1.3f);
    const float cloud = smoothstep(0.1f, 1.3f, waves) * smoothstep(0.02f, 0.15f, up);
    return mix(clear, {5.0f, 4.7f, 4.4f}, 0.8f * cloud);
}

Vec3 Room::textured(const Material& material, Vec3 position) {
    switch (material.texture) {
        case 1: {
            const float tile = 0.8f;
            const float u = fraction(position.x / tile + 0.5f);
            const float v = fraction(position.z / tile);
            if (std::min({u, v, 1.0f - u, 1.0f - v}) < 0.012f) return material.albedo * 0.35f;
            const bool is_dark =
                fraction(0.5f * (std::floor(position.x / tile + 0.5f) + std::floor(position.z / tile))) > 0.25f;
            return is_dark ? material.albedo * Vec3{0.42f, 0.40f, 0.40f} : material.albedo;
        }
        case 2: {
            const float grain = std::sin(38.0f * position.y + 55.0f * position.z + 3.0f * std::sin(5.0f * position.x));
            return material.albedo * (0.86f + 0.14f * grain);
        }
        case 3: {
            // Wainscot: darker below, with a rail.
            if (position.y < 1.02f) return {0.20f, 0.13f, 0.085f};
            if (position.y < 1.09f) return {0.13f, 0.08f, 0.05f};
            return material.albedo;
        }
        default:
            return material.albedo;
    }
}

Vec3 Room::direct_light(Vec3 position, Vec3 normal, std::uint32_t sample) const {
    const Vec3 from = position + normal * surface_offset;
    const std::array<float, 2> grid = grid_point(sample);
    Vec3 light = ambient * pi;
    const float sun_cosine = dot(normal, to_sun);
    if (sun_cosine > 0.0f) {
        // The sun's disc, enlarged to 0.8 degrees so that the penumbra of the bars is visible at this size.
        const Vec3 wobble = Vec3{grid[0] - 0.5f, grid[1] - 0.5f, 0.0f} * 0.014f;
        if (sees_sun(from, to_sun + wobble)) light = light + sun_irradiance * sun_cosine;
    }
    if (position.z < back - 0.2f) return light + window_radiance * (pi * (0.12f + 0.12f * normal.y));

    const auto area_light = [&](Vec3 point, Vec3 facing, float area, Vec3 radiance) {
        const Vec3 path = point - from;
        const float square = dot(path, path);
        const Vec3 direction = path * (1.0f / std::sqrt(square));
        const float cosines = dot(normal, direction) * -dot(facing, direction);
        if (dot(normal, direction) <= 0.0f || cosines <= 0.0f || !is_free(from, point, 1, outside_)) return;
        // One point stands for a sixteenth of the light: its own extent bounds how bright it gets close by.
        light = light + radiance * (area * cosines / (square + area / 16.0f));
    };
    const float window_area = 2.0f * window_half_width * (window_high - window_low);
    area_light(
        {(2.0f * grid[0] - 1.0f) * window_half_width, window_low + grid[1] * (window_high - window_low), back + 0.02f},
        {0.0f, 0.0f, 1.0f}, window_area, window_radiance);
    // Light that the sunlit part of the floor sends back into the room.
    area_light({-1.4f + 4.6f * grid[0], 0.02f, -2.9f + 3.8f * grid[1]}, {0.0f, 1.0f, 0.0f}, 17.5f, {1.7f, 1.3f, 0.9f});
    for (const Lamp& lamp : lamps) {
        const Vec3 path = lamp.position - from;
        const float square = dot(path, path);
        const float cosine = dot(normal, path) / std::sqrt(square);
        const Vec3 irradiance = lamp.radiance * (pi * lamp.radius * lamp.radius * cosine / square);
        if (irradiance.x > 0.01f && is_free(from, lamp.position, 1, outside_)) light = light + irradiance;
    }
    // The neon tube, by its irradiance as an endless line.
    const float dx = 4.16f - from.x;
    const float dy = 2.33f - from.y;
    const float square = dx * dx + dy * dy + 0.01f;
    const float cosine = std::max(0.0f, (normal.x * dx + normal.y * dy) / std::sqrt(square));
    const float reach = smoothstep(3.6f, 0.6f, from.z);
    return light + Vec3{3.0f, 20.0f, 26.0f} * (0.05f * cosine * reach / std::sqrt(square));
}

Vec3 Room::radiance(Vec3 origin, Vec3 direction, std::uint32_t sample, int bounces) const {
    const Hit hit = trace({origin, direction});
    const Vec3 view = normalize(direction);
    if (hit.shape == nullptr) return sky(view);
    const Material& material = hit.shape->material;
    const Vec3 position = origin + direction * hit.distance;
    if (material.emission.x > 2.0f) return material.emission;
    const Vec3 normal = normal_of(*hit.shape, position);
    const Vec3 albedo = textured(material, position);
    Vec3 out = material.emission;
    if (!material.is_metal) out = out + albedo * direct_light(position, normal, sample) * (1.0f / pi);
    if (material.reflectance > 0.0f && bounces > 0) {
        // Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
        const float grazing = std::pow(1.0f - std::clamp(-dot(normal, view), 0.0f, 1.0f), 5.0f);
        const Vec3 mirrored = view - normal * (2.0f * dot(normal, view));
        const Vec3 seen = radiance(position + normal * surface_offset, mirrored, sample, bounces - 1);
        const float fresnel = material.reflectance + (1.0f - material.reflectance) * grazing;
        // The floor is worn: it mirrors less than polished stone would.
        const float polish = material.texture == 1 ? 0.6f : 1.0f;
        out = material.is_metal ? out + seen * mix(albedo, {1.0f, 1.0f, 1.0f}, grazing)
                                : out * (1.0f - fresnel) + seen * (fresnel * polish);
    } else if (material.is_metal) {
        out = out + albedo * 0.3f;
    }
    if (position.z > back - 0.5f) return out;
    // Haze between the window and the hills.
    const float haze = 1.0f - std::exp(-std::sqrt(dot(position - origin, position - origin)) / 320.0f);
    return mix(out, {1.9f, 2.3f, 2.8f}, haze);
}

Vec3 Room::radiance(Vec3 origin, Vec3 direction, std::uint32_t sample) const {
    return radiance(origin, direction, sample, 2);
}

Surface Room::surface(Vec3 origin, Vec3 direction) const {
    const Hit hit = trace({origin, direction});
    if (hit.shape == nullptr) return {};
    const Vec3 position = origin + direction * hit.distance;
    return {.is_sky = false,
            .position = position,
            .previous_position = position - hit.shape->motion,
            .normal = normal_of(*hit.shape, position)};
}

}  // namespace darkroom::samples
