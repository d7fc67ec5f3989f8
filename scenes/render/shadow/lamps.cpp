// SPDX-License-Identifier: MIT
#include "render/shadow/lamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/pass/draw_list.hpp"

namespace darkroom::render {

namespace {

using scene::LightState;
using scene::LightType;
using scene::mat4;
using scene::vec3;
using scene::vec4;

constexpr std::uint32_t cube_faces = 6;
/// Half of the widest cone that one tile holds, radians: its texels are 1.7 times those of a cube's faces then.
constexpr float widest_cone = 1.0472F;

std::uint32_t tiles_of(const scene::Light& light) {
    return light.type == LightType::Spot && light.outer_angle <= widest_cone ? 1 : cube_faces;
}

/// Places in Snapshot::lights of lamps that are drawn and cast.
std::vector<std::uint32_t> casting_lamps(const scene::Snapshot& snapshot) {
    std::vector<std::uint32_t> out;
    std::uint32_t points = 0, spots = 0;
    for (std::uint32_t i = 0; i < snapshot.lights.size(); ++i) {
        const scene::Light& light = snapshot.lights[i].light;
        if (light.type == LightType::Directional) continue;
        const bool is_drawn = light.type == LightType::Point ? points++ < max_point_lights : spots++ < max_spot_lights;
        if (is_drawn && light.casts_shadow && light.intensity > 0) out.push_back(i);
    }
    return out;
}

float light_at(const LightState& lamp, vec3 eye) {
    const vec3 away = lamp.position - eye;
    // Rec. 709.
    const float luminance = glm::dot(lamp.light.color, vec3(0.2126F, 0.7152F, 0.0722F)) * lamp.light.intensity;
    return luminance / std::max(glm::dot(away, away), 1.0F);
}

/// How far a lamp's shadows go: to its range, or to the farthest corner of what is drawn, which is nearer where a light
/// of a model has no range.
float reach_of(const LightState& lamp, const scene::Box& drawn) {
    const vec3 farthest = glm::max(glm::abs(drawn.low - lamp.position), glm::abs(drawn.high - lamp.position));
    return drawn.is_empty() ? lamp.light.range : std::min(lamp.light.range, glm::length(farthest));
}

/// From a lamp along `axis`; `tangent` of half the angle that the tile without its border sees.
mat4 tile_matrix(const LightState& lamp, float reach, vec3 axis, float tangent, std::uint32_t side) {
    const vec3 helper = std::abs(axis.y) > 0.9F ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const auto texels = static_cast<float>(side);
    const float wide = tangent * texels / (texels - 2.0F * tile_border);
    const float far = reach, near = far * lamp_near_share;
    mat4 projection(0);
    projection[0][0] = 1 / wide;
    projection[1][1] = -1 / wide;
    projection[2][2] = -far / (far - near);
    projection[2][3] = -1;
    projection[3][2] = -far * near / (far - near);
    return projection * glm::lookAt(lamp.position, lamp.position + axis, helper);
}

/// As face_of() in shaders/light/shadow.glsl numbers them.
constexpr std::array<std::array<float, 3>, cube_faces> face_axes{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

}  // namespace

std::uint32_t tile_side(std::uint32_t cascade_resolution) { return std::clamp(cascade_resolution / 4, 64U, 1024U); }

std::uint32_t tiles_needed(const scene::Snapshot& snapshot) {
    std::vector<std::uint32_t> tiles;
    for (const std::uint32_t place : casting_lamps(snapshot)) tiles.push_back(tiles_of(snapshot.lights[place].light));
    std::ranges::sort(tiles, std::greater());
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(tiles.size(), max_lamps_with_shadows); ++i) sum += tiles[i];
    return sum;
}

LampShadows choose_lamps(const scene::Snapshot& snapshot, std::uint32_t side) {
    const scene::CameraState& camera = snapshot.camera;
    const Frustum seen(camera.projection * camera.view);
    std::vector<std::uint32_t> places = casting_lamps(snapshot);
    std::erase_if(places, [&](std::uint32_t place) {
        const LightState& lamp = snapshot.lights[place];
        return !seen.touches({lamp.position - lamp.light.range, lamp.position + lamp.light.range});
    });
    std::ranges::stable_sort(places, [&](std::uint32_t a, std::uint32_t b) {
        return light_at(snapshot.lights[a], camera.position) > light_at(snapshot.lights[b], camera.position);
    });
    places.resize(std::min<std::size_t>(places.size(), max_lamps_with_shadows));
    std::ranges::sort(places);

    scene::Box drawn;
    for (const scene::Instance& instance : snapshot.instances)
        if (!instance.bounds.is_empty()) drawn.add(instance.bounds);
    LampShadows out;
    for (const std::uint32_t place : places) {
        const LightState& lamp = snapshot.lights[place];
        const float reach = reach_of(lamp, drawn);
        const auto first = static_cast<std::uint32_t>(out.world_to_tile.size());
        out.lamps.push_back({.light = place, .first = first, .count = tiles_of(lamp.light)});
        if (out.lamps.back().count == 1) {
            const float tangent = std::tan(std::max(lamp.light.outer_angle, 0.01F));
            out.world_to_tile.push_back(tile_matrix(lamp, reach, lamp.direction, tangent, side));
            continue;
        }
        for (const auto& [x, y, z] : face_axes)
            out.world_to_tile.push_back(tile_matrix(lamp, reach, vec3(x, y, z), 1, side));
    }
    return out;
}

}  // namespace darkroom::render
