// SPDX-License-Identifier: MIT
#include "render/shadow/lamps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/renderer_test_support.hpp"
#include "render/shadow/shadow_pass.hpp"

namespace darkroom::render {

namespace {

// Not by using: tests of cascades have an add_box() of their own.

using test::Pixels;
using test::vec3;
using test::vec4;

constexpr VkExtent2D lamp_extent{160, 120};

scene::LightState point_lamp(vec3 position, float intensity = 10, float range = 12) {
    scene::LightState out{.light = {.type = scene::LightType::Point, .intensity = intensity, .range = range}};
    out.position = position;
    return out;
}

scene::LightState spot_lamp(vec3 position, vec3 direction, float outer_angle = 0.6F) {
    scene::LightState out = point_lamp(position, 30);
    out.light.type = scene::LightType::Spot;
    out.light.outer_angle = outer_angle;
    out.light.inner_angle = outer_angle * 0.9F;
    out.direction = glm::normalize(direction);
    return out;
}

scene::SnapshotMaterial chalk() {
    scene::SnapshotMaterial out;
    out.surface.base_color = vec4(1);
    out.surface.metallic = 0;
    out.surface.roughness = 1;
    return out;
}

void add_chalk(scene::Snapshot& snapshot, vec3 low, vec3 high) { test::add_box(snapshot, low, high, chalk()); }

/// As an entity of a scene, from which a renderer takes how many tiles there may be.
scene::Scene lit_by(const std::vector<scene::LightState>& lights) {
    scene::Scene out = test::dark_scene();
    out.environment.ambient_intensity = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        scene::Entity entity;
        entity.name = "lamp " + std::to_string(i);
        entity.light = lights[i].light;
        out.entities.push_back(entity);
    }
    return out;
}

Pixels shot(const scene::Snapshot& snapshot, bool has_shadows = true, ShadowFilter filter = ShadowFilter::Soft,
            const scene::Assets& assets = {}) {
    Renderer renderer = test::renderer_for(
        {.extent = lamp_extent, .cascades = {.filter = filter}, .draw = {.has_shadows = has_shadows}}, assets,
        lit_by(snapshot.lights));
    return test::shoot(renderer, snapshot).color;
}

float brightest(const Pixels& pixels) {
    float out = 0;
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) out = std::max(out, pixels.rgba[i]);
    return out;
}

/// The inside of six slabs around a point, `thick` metres thick.
void add_shell(scene::Snapshot& snapshot, vec3 center, float half, float thick) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            vec3 low = center - half - thick, high = center + half + thick;
            (side < 0 ? high : low)[axis] = center[axis] + side * half;
            add_chalk(snapshot, low, high);
        }
    }
}

/// The inside of a room from the camera in it.
constexpr float room_half_width = 2.5F, room_half_height = 1.5F, room_back = -6.5F;

/// Where two walls meet, within two texels of each, here 2.4 cm.
bool is_in_a_corner(std::uint32_t x, std::uint32_t y) {
    const vec3 ray((static_cast<float>(x) + 0.5F - 80) / 60, (60 - static_cast<float>(y) - 0.5F) / 60, -1);
    const vec3 walls = vec3(room_half_width, room_half_height, -room_back) / glm::abs(ray);
    const vec3 point = ray * std::min({walls.x, walls.y, walls.z});
    std::array gaps{room_half_width - std::abs(point.x), room_half_height - std::abs(point.y), point.z - room_back};
    std::ranges::sort(gaps);
    return gaps[1] < 0.048F;
}

/// Largest differences in sRGB codes, of values below 1.
struct CodesApart {
    float in_corners = 0, elsewhere = 0;
};

CodesApart codes_apart(const Pixels& a, const Pixels& b) {
    const auto code = [](float x) { return 255 * std::pow(std::clamp(x, 0.0F, 1.0F), 1 / 2.2F); };
    CodesApart out;
    for (std::uint32_t y = 0; y < lamp_extent.height; ++y)
        for (std::uint32_t x = 0; x < lamp_extent.width; ++x) {
            float& most = is_in_a_corner(x, y) ? out.in_corners : out.elsewhere;
            most = std::max(most, std::abs(code(a.at(x, y)[0]) - code(b.at(x, y)[0])));
        }
    return out;
}

}  // namespace

TEST(RenderLampShadows, TilesAreOneASpotAndSixAPoint) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    EXPECT_EQ(tiles_needed(snapshot), 0U);
    snapshot.lights = {spot_lamp({0, 0, -3}, {0, -1, 0}), point_lamp({0, 0, -3}),
                       spot_lamp({0, 0, -3}, {0, -1, 0}, 1.4F)};
    EXPECT_EQ(tiles_needed(snapshot), 13U);
    const LampShadows chosen = choose_lamps(snapshot, 512);
    ASSERT_EQ(chosen.lamps.size(), 3U);
    EXPECT_EQ(chosen.lamps[1].first, 1U);
    EXPECT_EQ(chosen.lamps[2].first, 7U) << "too wide for one tile";
    snapshot.lights[1].light.casts_shadow = false;
    snapshot.lights[2].light.intensity = 0;
    EXPECT_EQ(tiles_needed(snapshot), 1U);
    for (int i = 0; i < 20; ++i) snapshot.lights.push_back(point_lamp({0, 0, -3}));
    EXPECT_EQ(tiles_needed(snapshot), max_tiles);
    EXPECT_EQ(tile_side(2048), 512U);
    EXPECT_EQ(tile_side(16), 64U);
    EXPECT_EQ(tile_side(16384), 1024U);
}

TEST(RenderLampShadows, TheBudgetGoesToThoseWithTheMostLightAtTheCamera) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    for (int i = 0; i < 10; ++i) snapshot.lights.push_back(point_lamp({0, 0, -4 - i}));
    snapshot.lights[0].light.intensity = 0.1F;
    snapshot.lights[9].light.intensity = 100;
    snapshot.lights[2].position = {0, 0, 20};
    const LampShadows chosen = choose_lamps(snapshot, 512);
    std::vector<std::uint32_t> places;
    for (const LampTiles& lamp : chosen.lamps) places.push_back(lamp.light);
    EXPECT_EQ(places, (std::vector<std::uint32_t>{1, 3, 4, 5, 6, 7, 8, 9})) << "0 is weak, 2 shines behind the camera";
    EXPECT_EQ(chosen.world_to_tile.size(), max_tiles);
}

TEST(RenderGpuLampShadows, TheImageIsAsLargeAsTheLampsNeedAndHoldsWhatTheyReach) {
    gpu::Context& context = gpu::test::context();
    GpuScene scene = test::must(GpuScene::create(context, {}));
    const gpu::SetLayout layout = test::must(create_frame_layout(context));
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-1, -1, -5}, {1, 1, -4});
    add_chalk(snapshot, {11, -1, -14}, {13, 1, -12});  // in a corner of the tile, beyond the range
    const auto pass_for = [&](const scene::Snapshot& lit) {
        ShadowPass pass =
            test::must(ShadowPass::create(context, layout.handle, scene, {}, {.tiles = tiles_needed(lit)}));
        test::must(pass.prepare(lit));
        return pass;
    };
    const ShadowPass without = pass_for(snapshot);
    EXPECT_EQ(without.atlas().info.extent.width, 1U) << "no lamp, no image";
    EXPECT_TRUE(without.caster_lists().empty());
    snapshot.lights = {point_lamp({0, 0, -2})};
    const ShadowPass six = pass_for(snapshot);
    EXPECT_EQ(six.atlas().info.extent.width, 6 * 512U);
    EXPECT_EQ(six.atlas().info.extent.height, 512U);
    ASSERT_EQ(six.caster_lists().size(), 6U);
    EXPECT_EQ(six.caster_lists()[5].order, std::vector<std::uint32_t>{0});
    for (std::size_t face = 0; face < 5; ++face) EXPECT_TRUE(six.caster_lists()[face].order.empty()) << face;
    snapshot.lights.resize(3, snapshot.lights[0]);
    const ShadowPass eighteen = pass_for(snapshot);
    EXPECT_EQ(eighteen.atlas().info.extent.width, 8 * 512U);
    EXPECT_EQ(eighteen.atlas().info.extent.height, 3 * 512U);
}

TEST(RenderGpuLampShadows, LampInAClosedBoxLightsNothingOutside) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-6, -2, -12}, {6, -1.5F, 0});
    add_chalk(snapshot, {-6, -2, -9}, {6, 4, -8.5F});
    snapshot.lights = {point_lamp({0.13F, 0.1F, -4})};
    EXPECT_GT(brightest(shot(snapshot)), 0.1F);
    add_shell(snapshot, {0, 0, -4}, 0.7F, 0.1F);
    EXPECT_GT(brightest(shot(snapshot, false)), 0.1F) << "the floor around the box is in view";
    for (const ShadowFilter filter : {ShadowFilter::Plain, ShadowFilter::Soft})
        EXPECT_EQ(brightest(shot(snapshot, true, filter)), 0);
    // As far as lights of models reach that have no range.
    snapshot.lights[0].light.range = 1e4F;
    EXPECT_GT(brightest(shot(snapshot, false)), 0.1F);
    EXPECT_EQ(brightest(shot(snapshot)), 0);
}

// A screen two metres before the camera, a lamp three metres behind it, and a board between them that neither sees from
// the front: a metre from the lamp, then halfway. The bulb's penumbra would be 0.2 and 0.05 m to either side; six
// texels are 0.12 m.
TEST(RenderGpuLampShadows, PenumbrasWidenWithDistance) {
    const auto width_of = [](float board, ShadowFilter filter) {
        scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
        add_chalk(snapshot, {-9, -9, -2.1F}, {9, 9, -2});
        snapshot.lights = {point_lamp({0.3F, 0, 3}, 30)};
        const Pixels open = shot(snapshot, true, filter);
        add_chalk(snapshot, {0.3F, -3, board - 0.02F}, {4, 3, board});
        const Pixels cut = shot(snapshot, true, filter);
        int partly = 0;
        for (std::uint32_t x = 0; x < lamp_extent.width; ++x) {
            const float share = cut.at(x, 60)[0] / open.at(x, 60)[0];
            if (share > 0.02F && share < 0.98F) ++partly;
        }
        return static_cast<float>(partly) * 4.0F / static_cast<float>(lamp_extent.height);
    };
    EXPECT_NEAR(width_of(2, ShadowFilter::Soft), 0.24F, 0.05F);
    EXPECT_NEAR(width_of(0.5F, ShadowFilter::Soft), 0.1F, 0.035F);
    EXPECT_NEAR(width_of(2, ShadowFilter::Plain), width_of(0.5F, ShadowFilter::Plain), 0.035F);
}

TEST(RenderGpuLampShadows, FacesMeetWithoutALine) {
    // Inside a room all of whose walls the lamp sees nothing may be dark: not at the edges of a cube's faces, which
    // cross the walls of a room that is no cube, and not at grazing angles.
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-3, -2, -7}, {3, -room_half_height, 1});
    add_chalk(snapshot, {-3, room_half_height, -7}, {3, 2, 1});
    add_chalk(snapshot, {-3, -2, -7}, {-room_half_width, 2, 1});
    add_chalk(snapshot, {room_half_width, -2, -7}, {3, 2, 1});
    add_chalk(snapshot, {-3, -2, -7}, {3, 2, room_back});
    for (const vec3& place : {vec3(0, 0, -4), vec3(0.7F, -0.6F, -3.1F), vec3(-1.9F, 0.9F, -5.2F)}) {
        snapshot.lights = {point_lamp(place, 2)};
        EXPECT_GT(brightest(shot(snapshot, false)), 0.1F);
        for (const ShadowFilter filter : {ShadowFilter::Plain, ShadowFilter::Soft}) {
            const CodesApart apart = codes_apart(shot(snapshot, true, filter), shot(snapshot, false));
            EXPECT_LE(apart.elsewhere, 1) << place.x;
            // The last lamp grazes the wall behind, 16 degrees off it, where it meets the one to the right.
            EXPECT_LE(apart.in_corners, 7) << place.x << ", " << int(filter);
        }
    }
}

namespace {

/// `side`: of the floor that a tile sees at a metre's distance.
void expect_shadow_of_a_post(const scene::LightState& light, float side) {
    // Seen from above: the picture's rows go along the floor, which lies 4 m below the camera.
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    const vec3 low(-0.2F, -0.15F, -3.95F), high(0.15F, 0.2F, -2.9F);  // stands on the floor, nearly
    add_chalk(snapshot, {-8, -8, -5}, {8, 8, -4});
    const vec3 lamp = light.position;
    snapshot.lights = {light};
    const Pixels open = shot(snapshot);
    add_chalk(snapshot, low, high);
    const Pixels posted = shot(snapshot);
    const float texel = side * (lamp.z + 4) / 500;
    int lit = 0, shaded = 0;
    for (std::uint32_t y = 0; y < lamp_extent.height; ++y) {
        for (std::uint32_t x = 0; x < lamp_extent.width; ++x) {
            const vec3 ray((static_cast<float>(x) + 0.5F - 80) / 60, (60 - static_cast<float>(y) - 0.5F) / 60, -1);
            const vec3 point = ray * 4.0F;
            // Slabs (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986), of a post so much larger or smaller.
            const auto meets = [&](vec3 from, vec3 to, float larger) {
                const vec3 a = (low - larger - from) / (to - from), b = (high + larger - from) / (to - from);
                const vec3 enter = glm::min(a, b), leave = glm::max(a, b);
                const float first = std::max({enter.x, enter.y, enter.z, 0.0F});
                return first < std::min({leave.x, leave.y, leave.z, 0.9999F});
            };
            if (open.at(x, y)[0] < 0.01F || meets(vec3(0), point, 0.02F)) continue;
            // Two texels for the gap where it stands, and what the soft filter reaches.
            const bool is_shaded = meets(point, lamp, -2 * texel), is_lit = !meets(point, lamp, 4 * texel);
            const float share = posted.at(x, y)[0] / open.at(x, y)[0];
            if (is_shaded) {
                ++shaded;
                EXPECT_LE(share, 0.5F) << x << ", " << y;
            }
            if (is_lit) {
                ++lit;
                EXPECT_EQ(share, 1) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(lit, 2000);
    EXPECT_GT(shaded, 100);
}

}  // namespace

TEST(RenderGpuLampShadows, PostBetweenASpotAndTheFloorShadesWhereRaysSay) {
    const vec3 lamp(-1.6F, 0.3F, -1.9F);
    expect_shadow_of_a_post(spot_lamp(lamp, vec3(0.3F, -0.1F, -4) - lamp, 0.8F), 2 * std::tan(0.8F));
}

// Half of what is shaded lies in another face than the post.
TEST(RenderGpuLampShadows, PostBetweenAPointAndTheFloorShadesWhereRaysSay) {
    expect_shadow_of_a_post(point_lamp({-1.6F, 0.3F, -1.9F}), 2);
    expect_shadow_of_a_post(point_lamp({-0.9F, -1.1F, -1.7F}), 2);
}

namespace {

/// A screen two metres before the camera, and three behind the camera a lamp that shines at it.
scene::Snapshot screen_scene(scene::LightType type) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-9, -9, -2.1F}, {9, 9, -2});
    const vec3 lamp(0, 0, 3);
    snapshot.lights = {type == scene::LightType::Point ? point_lamp(lamp, 30) : spot_lamp(lamp, vec3(0, 0, -1), 0.9F)};
    return snapshot;
}

constexpr int all_of_half = 50 * 20;

/// Of what a board of one metre halfway, behind the camera, would shade: pixels left and right of the middle.
std::array<int, 2> shaded_halves(const scene::Snapshot& snapshot, const scene::Assets& assets, const Pixels& open) {
    const Pixels cut = shot(snapshot, true, ShadowFilter::Plain, assets);
    std::array<int, 2> out{};
    // The shadow is 2 m wide, 60 pixels at 2 m; some pixels of its edges and of its middle are left out.
    for (std::uint32_t y = 35; y < 85; ++y)
        for (std::uint32_t x = 55; x < 105; ++x)
            if (std::abs(static_cast<float>(x) - 79.5F) > 5 && cut.at(x, y)[0] < 0.5F * open.at(x, y)[0])
                ++out[x < 80 ? 0 : 1];
    return out;
}

}  // namespace

TEST(RenderGpuLampShadows, HolesOfMaskedMaterialsLetLightThrough) {
    scene::Assets assets;
    assets.images.push_back({.name = "half", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}});
    for (const scene::LightType type : {scene::LightType::Point, scene::LightType::Spot}) {
        scene::Snapshot snapshot = screen_scene(type);
        const Pixels open = shot(snapshot, true, ShadowFilter::Plain, assets);
        scene::SnapshotMaterial material = chalk();
        material.entity_texture = 0;
        material.surface.base_color_texture.is_nearest = true;
        test::add_box(snapshot, {-0.5F, -0.5F, 0.48F}, {0.5F, 0.5F, 0.5F}, material);
        EXPECT_EQ(shaded_halves(snapshot, assets, open), (std::array{all_of_half, all_of_half}))
            << "opaque: alpha means nothing";
        snapshot.materials.back().surface.blend = scene::SurfaceBlend::Mask;
        const auto [left, right] = shaded_halves(snapshot, assets, open);
        EXPECT_EQ(std::max(left, right), all_of_half) << int(type);
        EXPECT_EQ(std::min(left, right), 0) << int(type);
        snapshot.materials.back().surface.alpha_cutoff = 0;
        EXPECT_EQ(shaded_halves(snapshot, assets, open), (std::array{all_of_half, all_of_half}));
    }
}

// A board of half the width, whose joint moves it from the left to the right.
TEST(RenderGpuLampShadows, SkinnedMeshesCastWhereTheirJointsAre) {
    scene::Primitive primitive;
    for (const float y : {-0.5F, 0.5F})
        for (const float x : {-0.5F, 0.0F}) primitive.vertices.push_back({.position = vec3(x, y, 0.5F)});
    primitive.indices = {0, 1, 2, 2, 1, 3};
    primitive.skin.resize(4);
    scene::Model model;
    model.meshes = {{.primitives = {primitive}}};
    scene::Assets assets;
    assets.models = {model};
    for (const scene::LightType type : {scene::LightType::Point, scene::LightType::Spot}) {
        scene::Snapshot snapshot = screen_scene(type);
        const Pixels open = shot(snapshot, true, ShadowFilter::Plain, assets);
        snapshot.materials.push_back(chalk());
        snapshot.materials.back().surface.is_double_sided = true;
        scene::Instance board{.mesh = {.model = 0, .mesh = 0, .primitive = 0}};
        board.material = 1;
        board.bounds.add(vec3(-1, -1, 0.4F));
        board.bounds.add(vec3(1, 1, 0.6F));
        snapshot.instances.push_back(board);
        EXPECT_EQ(shaded_halves(snapshot, assets, open), (std::array{all_of_half, 0})) << int(type);
        snapshot.joints = {glm::translate(test::mat4(1), vec3(0.5F, 0, 0))};
        snapshot.instances.back().first_joint = 0;
        snapshot.instances.back().joint_count = 1;
        EXPECT_EQ(shaded_halves(snapshot, assets, open), (std::array{0, all_of_half})) << int(type);
    }
}

TEST(RenderGpuLampShadows, BeyondTheBudgetLampsShineWithoutAShadow) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-6, -3, -9}, {6, 3, -8});
    add_shell(snapshot, {0, 0, -4}, 0.7F, 0.1F);
    for (int i = 0; i < 9; ++i) snapshot.lights.push_back(point_lamp({0, 0, -4}, 5));
    EXPECT_GT(brightest(shot(snapshot)), 0.01F) << "the ninth";
    snapshot.lights.pop_back();
    EXPECT_EQ(brightest(shot(snapshot)), 0);
    snapshot.lights[3].light.casts_shadow = false;
    EXPECT_GT(brightest(shot(snapshot)), 0.01F) << "one that is told not to";
}

TEST(RenderGpuLampShadows, StillScenesGiveEqualFrames) {
    scene::Snapshot snapshot = test::snapshot_of(lamp_extent);
    add_chalk(snapshot, {-6, -3, -9}, {6, 3, -8});
    for (int i = 0; i < 12; ++i) snapshot.lights.push_back(point_lamp({static_cast<float>(i) * 0.3F - 2, 0, -6}, 1));
    add_chalk(snapshot, {-0.2F, -3, -7}, {0.2F, 3, -6.8F});
    Renderer renderer = test::renderer_for({.extent = lamp_extent}, {}, lit_by(snapshot.lights));
    const Pixels first = test::shoot(renderer, snapshot).color;
    snapshot.time = 1.25;
    EXPECT_EQ(first.rgba, test::shoot(renderer, snapshot).color.rgba);
}

}  // namespace darkroom::render
