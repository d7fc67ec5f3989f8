// SPDX-License-Identifier: MIT
// What bias and filter may cost, on the renderer's own cascades: no light inside closed rooms, no shadow of its own on
// a lit plane, and how far from its foot a shadow begins.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render/shadow/shadow_test_support.hpp"

namespace darkroom::render {

namespace {

using namespace test;

/// Inside of the rooms below.
constexpr vec3 inner_low(-3, 0, -3), inner_high(3, 3, 3);

const std::array<vec3, 10> suns{
    vec3(0.4F, 0.6F, 0.05F), vec3(0.4F, 0.4F, 0.05F), vec3(0, 1, 0), vec3(1, 0.2F, 0.3F),   vec3(-0.7F, 0.5F, -0.6F),
    vec3(-0.1F, 0.15F, 1),   vec3(0.5F, 2, -0.4F),    vec3(1, 1, 1), vec3(-1, 0.4F, 0.02F), vec3(0.02F, 1, -0.15F)};

/// Walls, floor and ceiling overlap at their edges. In the open there are a wide ceiling and ground too, so that the
/// cascades cannot be those of the room alone.
scene::Snapshot closed_room(const scene::CameraState& camera, float thickness, bool is_wide) {
    scene::Snapshot snapshot = empty_scene(camera);
    const vec3 low = inner_low - thickness, high = inner_high + thickness;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 end = high, begin = low;
        end[axis] = inner_low[axis];
        begin[axis] = inner_high[axis];
        add_box(snapshot, low, end);
        add_box(snapshot, begin, high);
    }
    if (is_wide) {
        add_box(snapshot, vec3(-50, inner_high.y, -50), vec3(3, high.y, 50));
        add_box(snapshot, vec3(-40, -2, -40), vec3(40, low.y + 0.5F * thickness, 40));
    }
    return snapshot;
}

/// Places on the inside of a face, or in the air along it.
Grid inside_grid(int axis, bool is_high, float away) {
    constexpr std::uint32_t count = 96;
    Grid grid{.width = count, .height = count, .normal = vec3(0)};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const vec3 size = inner_high - inner_low;
    // Closest to the edges, where light comes through if it does at all.
    constexpr float edge = 1e-3F;
    grid.normal[axis] = is_high ? -1.0F : 1.0F;
    grid.first = inner_low;
    grid.first[axis] = is_high ? inner_high[axis] - away : inner_low[axis] + away;
    grid.first[u] += edge;
    grid.first[v] += edge;
    grid.right[u] = (size[u] - 2 * edge) / (count - 1);
    grid.down[v] = (size[v] - 2 * edge) / (count - 1);
    return grid;
}

bool is_in_view(const scene::CameraState& camera, vec3 point) {
    const vec4 clip = camera.projection * camera.view * vec4(point, 1);
    return clip.w > 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z >= 0 && clip.z <= clip.w;
}

/// The largest texel of the cascades that a point is looked up in.
float texel_at(const scene::CameraState& camera, const Cascades& cascades, vec3 point) {
    const float distance = -(camera.view * vec4(point, 1)).z;
    std::uint32_t cascade = 0;
    while (cascade + 1 < cascades.count && distance > cascades.splits[cascade]) ++cascade;
    const float before = cascade == 0 ? camera.near_distance : cascades.splits[cascade - 1];
    const float end = cascades.splits[cascade];
    const bool is_blended = cascade + 1 < cascades.count && distance > end - (end - before) * cascade_blend;
    return std::max(cascades.texel[cascade], is_blended ? cascades.texel[cascade + 1] : 0.0F);
}

struct Leaks {
    std::uint64_t points = 0, lit = 0, air_points = 0, air = 0;
    float worst = 0;
};

/// Behind walls of at least a texel, and behind thinner ones.
struct RoomLeaks {
    Leaks thick, thin;
};

void add_leaks(RoomLeaks& leaks, ShadowRig& rig, const scene::Snapshot& snapshot, const Grid& grid, float thickness,
               bool is_in_air) {
    const Visibility seen = rig.evaluate_again(grid);
    const bool faces_light = glm::dot(grid.normal, snapshot.lights[0].direction) > 0;
    for (std::uint32_t y = 0; y < grid.height; ++y) {
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            const vec3 point = grid.point(x, y);
            if (!is_in_view(snapshot.camera, point)) continue;
            const float texel = texel_at(snapshot.camera, rig.pass.cascades(0), point);
            const bool is_thick = thickness >= texel;
            const bool is_at_edge = x == 0 || y == 0 || x + 1 == grid.width || y + 1 == grid.height;
            // A share is that of an even grid, without the edges, which are there for the worst case.
            if (!is_thick && is_at_edge) continue;
            Leaks& kind = is_thick ? leaks.thick : leaks.thin;
            ++kind.points;
            const float direct = faces_light ? seen.at(x, y) : 0;
            if (direct > 0) ++kind.lit;
            // On a face itself only for the worst case.
            if (is_in_air) ++kind.air_points;
            if ((is_in_air || is_thick) && seen.one_tap[y * grid.width + x] > 0) ++kind.air;
            kind.worst = std::max(kind.worst, direct);
        }
    }
}

RoomLeaks leaks_of(ShadowRig& rig, const scene::Snapshot& snapshot, float thickness) {
    RoomLeaks leaks;
    rig.prepare(snapshot);
    rig.evaluate({});
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_high : {false, true}) {
            add_leaks(leaks, rig, snapshot, inside_grid(axis, is_high, 0), thickness, false);
            add_leaks(leaks, rig, snapshot, inside_grid(axis, is_high, 0.7F), thickness, true);
        }
    }
    return leaks;
}

/// All suns, each with another far plane and another wall, of rooms alone or under a wide ceiling.
void expect_dark(std::uint32_t resolution, ShadowFilter filter, bool is_wide) {
    constexpr std::array<float, 6> fars{20, 100, 200, 500, 1000, 5000};
    constexpr std::array<float, 4> walls{0.05F, 0.1F, 0.3F, 0.5F};
    ShadowRig rig({.resolution = resolution, .filter = filter});
    RoomLeaks all;
    for (std::size_t i = 0; i < suns.size(); ++i) {
        for (const std::size_t turn : {std::size_t{0}, std::size_t{1}}) {
            const float far = fars[(i + 3 * turn) % fars.size()], thickness = walls[(i + turn) % walls.size()];
            const vec3 eye = turn == 0 ? vec3(-2, 0.5F, -2.5F) : vec3(2.5F, 1.6F, 2);
            scene::Snapshot snapshot = closed_room(look(eye, vec3(0, 2.5F, 0), 80, far), thickness, is_wide);
            add_light(snapshot, suns[i]);
            const RoomLeaks here = leaks_of(rig, snapshot, thickness);
            EXPECT_EQ(here.thick.lit, 0U) << "of " << here.thick.points << ", " << here.thick.worst << " at worst; sun "
                                          << i << ", far " << far << ", wall " << thickness;
            EXPECT_EQ(here.thick.air, 0U)
                << "of " << here.thick.points << " in the air; sun " << i << ", far " << far << ", wall " << thickness;
            for (const auto& [from, to] : {std::pair(&here.thick, &all.thick), std::pair(&here.thin, &all.thin)}) {
                to->points += from->points;
                to->lit += from->lit;
                to->air_points += from->air_points;
                to->air += from->air;
                to->worst = std::max(to->worst, from->worst);
            }
        }
    }
    EXPECT_GT(all.thick.points, 10000U);
    const auto share = [](std::uint64_t part, std::uint64_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    EXPECT_LE(share(all.thin.lit, all.thin.points), 0.001) << "of " << all.thin.points << ", " << all.thin.worst;
    EXPECT_LE(share(all.thin.air, all.thin.air_points), 0.001) << "of " << all.thin.air_points;
}

}  // namespace

class RenderGpuShadowRoom : public testing::TestWithParam<std::tuple<std::uint32_t, ShadowFilter>> {
  protected:
    static void expect_dark(bool is_wide) {
        const auto& [resolution, filter] = GetParam();
        render::expect_dark(resolution, filter, is_wide);
    }
};
INSTANTIATE_TEST_SUITE_P(Soft, RenderGpuShadowRoom,
                         testing::Combine(testing::Values(512U, 1024U, 2048U, 4096U),
                                          testing::Values(ShadowFilter::Soft)));
INSTANTIATE_TEST_SUITE_P(Plain, RenderGpuShadowRoom,
                         testing::Combine(testing::Values(512U, 2048U), testing::Values(ShadowFilter::Plain)));

TEST_P(RenderGpuShadowRoom, IsDarkAlone) { expect_dark(false); }
TEST_P(RenderGpuShadowRoom, IsDarkUnderAWideCeiling) { expect_dark(true); }

TEST(RenderGpuShadow, LitPlanesDoNotShadeThemselves) {
    const vec3 light = glm::normalize(vec3(0.3F, 1, 0.2F));
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), light)), up = glm::cross(light, right);
    for (const auto& [resolution, filter] :
         {std::pair(512U, ShadowFilter::Soft), {4096U, ShadowFilter::Soft}, {512U, ShadowFilter::Plain}}) {
        ShadowRig rig({.resolution = resolution, .filter = filter});
        for (const float degrees : {5.0F, 30.0F, 60.0F, 75.0F, 80.0F, 83.0F, 85.0F}) {
            for (const vec3& across : {up, right, glm::normalize(right + up), glm::normalize(right * 0.4F - up)}) {
                const float angle = glm::radians(degrees);
                const vec3 normal = light * std::cos(angle) + across * std::sin(angle);
                const vec3 side = glm::normalize(glm::cross(across, normal)), along = glm::cross(side, normal);
                for (const float distance : {3.0F, 25.0F, 70.0F}) {
                    const vec3 center(0, 0, -distance);
                    scene::Snapshot snapshot = empty_scene(look(vec3(0), vec3(0, 0, -1), 45, distance * 8));
                    add_light(snapshot, light);
                    add_box(snapshot, vec3(-300), vec3(300));
                    const mat4 turn(vec4(side, 0), vec4(normal, 0), vec4(along, 0), vec4(center, 1));
                    snapshot.instances[0].world =
                        turn * glm::scale(mat4(1), vec3(200, 1, 200)) * glm::translate(mat4(1), vec3(-0.5F, -1, -0.5F));
                    const Visibility seen = rig.run(snapshot, {.width = 48,
                                                               .height = 48,
                                                               .first = center - (side + along) * 0.5F,
                                                               .right = side * 0.021F,
                                                               .down = along * 0.023F,
                                                               .normal = normal});
                    EXPECT_EQ(std::ranges::min(seen.filtered), 1)
                        << resolution << ", " << degrees << " degrees, " << distance << " m";
                }
            }
        }
    }
}

// Across the light, from where the caster stands to where half of its shadow is there.
TEST(RenderGpuShadow, GapsAtContactsAreTwoTexelsAndTheFilter) {
    ShadowRig rig({.resolution = 1024, .far_distance = 30});
    for (const int degrees : {10, 20, 45, 60, 70, 80, 85}) {
        const float angle = glm::radians(static_cast<float>(degrees));
        scene::Snapshot snapshot = empty_scene(look(vec3(0, 3, 2), vec3(0)));
        add_box(snapshot, vec3(-40, -1, -40), vec3(40, 0, 40));
        add_light(snapshot, vec3(std::sin(angle), std::cos(angle), 0.1F));
        rig.prepare(snapshot);
        const float texel = texel_at(snapshot.camera, rig.pass.cascades(0), vec3(0));
        add_box(snapshot, vec3(0, 0, -2), vec3(2.5F * texel, 12 * texel / std::sin(angle), 2));
        const float step = 0.1F / snapshot.lights[0].direction.y;
        const Visibility seen = rig.run(snapshot, {.width = 80, .right = vec3(-step * texel, 0, 0)});
        float light = 0;
        for (const float value : seen.filtered) light += value * 0.1F;
        EXPECT_LE(light, 2.0F) << "texels across the light, at " << degrees << " degrees";
        EXPECT_EQ(seen.filtered.back(), 0);
    }
}

}  // namespace darkroom::render
