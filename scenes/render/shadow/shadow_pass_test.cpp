// SPDX-License-Identifier: MIT
#include "render/shadow/shadow_pass.hpp"

#include <gtest/gtest.h>

#include "render/shadow/shadow_test_support.hpp"

namespace darkroom::render {

namespace {

using namespace test;

constexpr CascadeDesc small{.resolution = 512, .far_distance = 30};

/// A floor, seen from above.
scene::Snapshot floor_scene(vec3 light) {
    scene::Snapshot snapshot = empty_scene(look(vec3(0, 3, 2), vec3(0)));
    add_box(snapshot, vec3(-40, -1, -40), vec3(40, 0, 40));
    add_light(snapshot, light);
    return snapshot;
}

Grid floor_grid(std::uint32_t size = 64, float side = 2, vec3 center = vec3(0)) {
    const float step = side / static_cast<float>(size);
    return {.width = size,
            .height = size,
            .first = center + vec3(step - side, 0, step - side) * 0.5F,
            .right = vec3(step, 0, 0),
            .down = vec3(0, 0, step)};
}

/// At a point of the floor.
float visibility_at(ShadowRig& rig, const scene::Snapshot& snapshot, vec3 point, std::uint32_t light = 0) {
    return rig.run(snapshot, {.first = point}, light).filtered[0];
}

/// A square of 1 m at height 1 above the floor's middle whose front is up, skinned and with a morph target that moves
/// it by 1 m along x.
scene::Assets square() {
    scene::Primitive primitive;
    for (const float z : {-0.5F, 0.5F})
        for (const float x : {-0.5F, 0.5F}) primitive.vertices.push_back({.position = vec3(x, 1, z)});
    primitive.indices = {0, 2, 1, 1, 2, 3};
    scene::Primitive bent = primitive;
    bent.skin.resize(4);
    bent.targets.push_back({.positions = std::vector<vec3>(4, vec3(1, 0, 0))});
    scene::Model model;
    model.meshes = {{.primitives = {primitive, bent}}};
    scene::Assets assets;
    assets.models = {model};
    return assets;
}

scene::Instance& add_square(scene::Snapshot& snapshot, std::uint32_t primitive) {
    scene::Instance instance{.mesh = {.model = 0, .mesh = 0, .primitive = primitive}};
    instance.bounds.add(vec3(-3, 0.9F, -3));
    instance.bounds.add(vec3(3, 1.1F, 3));
    return snapshot.instances.emplace_back(instance);
}

}  // namespace

TEST(RenderShadowLights, AreDirectionalAndShineAndKeepTheirOrder) {
    scene::Snapshot snapshot;
    EXPECT_TRUE(lights_with_shadows(snapshot).empty());
    for (int i = 0; i < 6; ++i) add_light(snapshot, vec3(0, 1, 0));
    snapshot.lights[1].light.casts_shadow = false;
    snapshot.lights[2].light.type = scene::LightType::Spot;
    snapshot.lights[3].light.intensity = 0;
    EXPECT_EQ(lights_with_shadows(snapshot), (std::vector<std::uint32_t>{0, 4})) << "the sixth is not drawn at all";
}

TEST(RenderGpuShadow, BoxShadesTheFloor) {
    ShadowRig rig(small);
    scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
    add_box(snapshot, vec3(-0.5F, 1, -0.5F), vec3(0.5F, 1.2F, 0.5F));
    const Visibility seen = rig.run(snapshot, floor_grid());
    EXPECT_EQ(seen.at(32, 32), 0);
    EXPECT_EQ(seen.one_tap[32 * 64 + 32], 0);
    EXPECT_EQ(seen.at(2, 2), 1);
    EXPECT_EQ(seen.at(61, 32), 1);
    snapshot.materials[0].surface.blend = scene::SurfaceBlend::Alpha;
    EXPECT_EQ(visibility_at(rig, snapshot, vec3(0)), 0) << "what is transparent casts a whole shadow";
    snapshot.instances[1].casts_shadow = false;
    EXPECT_EQ(visibility_at(rig, snapshot, vec3(0)), 1);
}

TEST(RenderGpuShadow, SlopesDoNotShadeThemselves) {
    ShadowRig rig(small);
    const vec3 light = glm::normalize(vec3(0.3F, 1, 0.2F));
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), light)), up = glm::cross(light, right);
    for (const float degrees : {10.0F, 60.0F, 80.0F}) {
        // Along the map's columns, and across rows and columns alike, where texels are furthest apart.
        for (const vec3& across : {up, glm::normalize(right + up)}) {
            const float angle = glm::radians(degrees);
            const vec3 normal = light * std::cos(angle) + across * std::sin(angle);
            const vec3 side = glm::normalize(glm::cross(across, normal)), along = glm::cross(side, normal);
            for (const float distance : {3.0F, 15.0F}) {
                const vec3 center(0, 0, -distance);
                scene::Snapshot snapshot = empty_scene(look(vec3(0), vec3(0, 0, -1)));
                add_light(snapshot, light);
                add_box(snapshot, center - vec3(20), center + vec3(20));
                const mat4 turn(vec4(side, 0), vec4(normal, 0), vec4(along, 0), vec4(center, 1));
                snapshot.instances[0].world =
                    turn * glm::scale(mat4(1), vec3(30, 1, 30)) * glm::translate(mat4(1), vec3(-0.5F, -1, -0.5F));
                // Normals of coarse meshes lean by a few degrees; where light grazes, they have to be exact.
                const float most = degrees < 75 ? 0.1F : 0.0F;
                for (const float lean : {-most, 0.0F, most}) {
                    const Grid grid{.width = 32,
                                    .height = 32,
                                    .first = center - (side + along) * 0.5F,
                                    .right = side * 0.031F,
                                    .down = along * 0.033F,
                                    .normal = glm::normalize(normal + (side + along) * lean)};
                    const Visibility seen = rig.run(snapshot, grid);
                    ASSERT_EQ(std::ranges::min(seen.filtered), 1)
                        << degrees << " degrees, " << distance << " m, " << lean;
                }
            }
        }
    }
}

TEST(RenderGpuShadow, ResolutionMeansWhatItSays) {
    for (const std::uint32_t resolution : {1024U, 2048U, 300U}) {
        ShadowRig rig({.count = 2, .resolution = resolution}, 2);
        scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
        add_light(snapshot, vec3(1, 1, 0), "second");
        add_light(snapshot, vec3(1, 1, 1), "third");
        rig.prepare(snapshot);
        ASSERT_EQ(rig.pass.casting_lights(), 2U) << "as many as there are maps";
        EXPECT_EQ(rig.pass.caster_lists().size(), 4U);
        for (const std::uint32_t light : {0U, 1U}) {
            const gpu::ImageInfo& map = rig.pass.map(light).info;
            EXPECT_EQ(map.extent.width, resolution);
            EXPECT_EQ(map.extent.height, resolution);
            EXPECT_EQ(map.array_layers, 2U);
        }
        EXPECT_EQ(rig.pass.map(2).info.extent.width, 1U);
        blocks::Shadows block{};
        rig.pass.fill(block);
        EXPECT_EQ(block.shadow_settings, vec4(2, resolution, 1 / static_cast<float>(resolution), 200));
        EXPECT_EQ(block.cascade_texels[1].y, rig.pass.cascades(1).texel[1]);
        EXPECT_EQ(block.cascade_splits[1].y, rig.pass.cascades(1).splits[1]);
        EXPECT_EQ(block.cascade_splits[1].y, 8) << "where the floor that is in view ends";
        EXPECT_EQ(block.world_to_map[5], rig.pass.cascades(1).world_to_cascade[1]);
    }
}

TEST(RenderGpuShadow, EveryLightHasItsOwnMap) {
    ShadowRig rig({.resolution = 256, .far_distance = 30}, 4);
    scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
    add_light(snapshot, vec3(1, 1, 0), "b");
    add_light(snapshot, vec3(-1, 1, 0), "c");
    add_light(snapshot, vec3(0, 1, 1), "d");
    add_box(snapshot, vec3(-0.2F, 1, -0.2F), vec3(0.2F, 1.1F, 0.2F));
    const std::array places{vec3(0), vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 0, -1)};
    for (std::uint32_t light = 0; light < 4; ++light)
        for (std::uint32_t place = 0; place < 4; ++place)
            EXPECT_EQ(visibility_at(rig, snapshot, places[place], light), light == place ? 0 : 1) << light << place;
    snapshot.lights[2].light.casts_shadow = false;
    EXPECT_EQ(visibility_at(rig, snapshot, places[3], 2), 0) << "maps move up";
    EXPECT_EQ(visibility_at(rig, snapshot, places[3], 3), 1) << "no fourth map: lit";
    snapshot.lights.clear();
    EXPECT_EQ(visibility_at(rig, snapshot, places[0]), 1);
    EXPECT_TRUE(rig.pass.caster_lists().empty());
}

TEST(RenderGpuShadow, TheNumberOfMapsInTheShaderChangesNothing) {
    scene::Snapshot snapshot = floor_scene(vec3(0.3F, 1, 0.2F));
    add_box(snapshot, vec3(-0.5F, 1, -0.5F), vec3(0.5F, 1.2F, 0.5F));
    ShadowRig guessing(small), exact(small, 1, 1);
    EXPECT_EQ(guessing.run(snapshot, floor_grid()).filtered, exact.run(snapshot, floor_grid()).filtered);
}

TEST(RenderGpuShadow, FrontFacesCast) {
    const scene::Assets assets = square();
    ShadowRig rig(small, 1, 0, assets);
    scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
    scene::Instance& lid = add_square(snapshot, 0);
    lid.material = 1;
    snapshot.materials.emplace_back();
    const auto cast = [&] { return visibility_at(rig, snapshot, vec3(0.3F, 0, 0.3F)); };
    EXPECT_EQ(cast(), 0);
    lid.world[0][0] = -1;
    EXPECT_EQ(cast(), 1) << "seen from behind";
    lid.is_mirrored = true;
    EXPECT_EQ(cast(), 0) << "a mirror image has its front where it was";
    lid.is_mirrored = false;
    snapshot.materials[1].surface.is_double_sided = true;
    EXPECT_EQ(cast(), 0);
}

TEST(RenderGpuShadow, HolesOfMaskedMaterialsLetLightThrough) {
    scene::Assets assets;
    assets.images.push_back({.name = "half", .width = 2, .height = 1, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}});
    ShadowRig rig(small, 1, 0, assets);
    scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
    add_box(snapshot, vec3(-0.5F, 1, -0.5F), vec3(0.5F, 1.1F, 0.5F));
    snapshot.materials.push_back({.entity_texture = 0});
    snapshot.materials[1].surface.base_color_texture.is_nearest = true;
    snapshot.instances[1].material = 1;
    const auto shaded = [&] {
        const Visibility seen = rig.run(snapshot, floor_grid(100, 0.9F));
        return static_cast<double>(std::ranges::count(seen.filtered, 0.0F)) / 1e4;
    };
    EXPECT_EQ(shaded(), 1) << "opaque: alpha means nothing";
    snapshot.materials[1].surface.blend = scene::SurfaceBlend::Mask;
    EXPECT_NEAR(shaded(), 0.5, 0.05);
    snapshot.materials[1].surface.alpha_cutoff = 0;
    EXPECT_EQ(shaded(), 1);
}

TEST(RenderGpuShadow, BentMeshesCastWhereTheyAre) {
    const scene::Assets assets = square();
    ShadowRig rig(small, 1, 0, assets);
    scene::Snapshot snapshot = floor_scene(vec3(0, 1, 0));
    scene::Instance& bent = add_square(snapshot, 1);
    snapshot.joints = {mat4(1), glm::translate(mat4(1), vec3(0, 0, 1))};
    snapshot.weights = {0, 1};
    const auto expect = [&](float middle, float right, float below, const char* what) {
        EXPECT_EQ(visibility_at(rig, snapshot, vec3(0)), middle) << what;
        EXPECT_EQ(visibility_at(rig, snapshot, vec3(1, 0, 0)), right) << what;
        EXPECT_EQ(visibility_at(rig, snapshot, vec3(0, 0, 1)), below) << what;
    };
    expect(0, 1, 1, "as it is");
    bent.first_weight = 1;
    bent.weight_count = 1;
    expect(1, 0, 1, "morphed");
    bent.first_weight = scene::no_index;
    bent.weight_count = 0;
    bent.first_joint = 1;
    bent.joint_count = 1;
    expect(1, 1, 0, "skinned");
}

TEST(RenderGpuShadow, CascadesBlendIntoEachOther) {
    ShadowRig rig(small);
    // A rail along the view, under a light overhead: across a cascade its edge looks the same everywhere.
    scene::Snapshot snapshot = empty_scene(look(vec3(0, 1, 0), vec3(0, 1, -1)));
    add_box(snapshot, vec3(-40, -1, -40), vec3(40, 0, 40));
    add_box(snapshot, vec3(-0.5F, 1.5F, -35), vec3(0.013F, 1.6F, 5));
    add_light(snapshot, vec3(0, 1, 0));
    rig.prepare(snapshot);
    const Cascades& cascades = rig.pass.cascades(0);
    const float end = cascades.splits[0];
    const float band = (end - 0.1F) * cascade_blend;
    int compared = 0;
    for (int step = -8; step < 8; ++step) {
        const float x = 0.013F + 0.2F * static_cast<float>(step) * cascades.texel[0];
        const Visibility seen = rig.run(
            snapshot, {.width = 300, .first = vec3(x, 0, -(end - 1.5F * band)), .right = vec3(0, 0, -0.01F * band)});
        const float before = seen.filtered.front(), after = seen.filtered.back();
        if (std::abs(before - after) > 0.1F) ++compared;
        EXPECT_NEAR(seen.filtered[49], before, 1e-6F);
        EXPECT_NEAR(seen.filtered[100], (before + after) / 2, 0.01F);
        EXPECT_NEAR(seen.filtered[151], after, 0.01F);
        for (std::size_t i = 1; i < seen.filtered.size(); ++i)
            ASSERT_NEAR(seen.filtered[i], seen.filtered[i - 1], 0.02F) << i;
    }
    EXPECT_GT(compared, 2);
}

TEST(RenderGpuShadow, EndsInLight) {
    ShadowRig rig(small);
    scene::Snapshot snapshot = empty_scene(look(vec3(0, 1, 0), vec3(0, 1, -1)));
    add_box(snapshot, vec3(-50, 10, -50), vec3(50, 11, 50));
    add_light(snapshot, vec3(0.1F, 1, 0));
    const Visibility seen = rig.run(snapshot, {.width = 41, .right = vec3(0, 0, -1)});
    for (std::size_t i = 0; i < 41; ++i) {
        const float expected = std::clamp((static_cast<float>(i) - 22.5F) / 7.5F, 0.0F, 1.0F);
        EXPECT_NEAR(seen.filtered[i], expected, 1e-5F) << i << " m";
        EXPECT_NEAR(seen.one_tap[i], expected, 1e-5F) << i << " m";
    }
}

namespace {

/// From where a tenth of the light arrives to where nine tenths do, metres, at the edge of a plate at this height.
float penumbra(ShadowRig& rig, float height) {
    scene::Snapshot snapshot = empty_scene(look(vec3(0.5F, 1, 1), vec3(0, 0, 0), 60));
    add_box(snapshot, vec3(-2, -0.1F, -2), vec3(2, 0, 2));
    add_box(snapshot, vec3(-2, height, -2), vec3(0.0137F, height + 0.1F, 2));
    add_light(snapshot, vec3(0, 1, 0));
    constexpr std::uint32_t count = 1200;
    constexpr float step = 0.00025F;
    const Visibility seen = rig.run(snapshot, {.width = count, .first = vec3(-0.15F, 0, 0), .right = vec3(step, 0, 0)});
    EXPECT_TRUE(std::ranges::is_sorted(seen.filtered)) << "light grows across the edge";
    EXPECT_EQ(seen.filtered.front(), 0);
    EXPECT_EQ(seen.filtered.back(), 1);
    const auto first = std::ranges::lower_bound(seen.filtered, 0.1F),
               last = std::ranges::lower_bound(first, seen.filtered.end(), 0.9F);
    return static_cast<float>(last - first) * step;
}

}  // namespace

// Half of a disc is covered at its middle; nine tenths are 0.687 of its radius farther on.
TEST(RenderGpuShadow, PenumbrasAreTheSunsAndWidenWithDistance) {
    ShadowRig soft({.resolution = 1024}), plain({.resolution = 1024, .filter = ShadowFilter::Plain});
    for (const float height : {2.0F, 3.0F, 5.0F}) {
        const float sun = height * std::tan(glm::radians(0.53F / 2)) * 2 * 0.687F;
        EXPECT_NEAR(penumbra(soft, height), sun, 0.25F * sun) << height << " m";
    }
    EXPECT_NEAR(penumbra(plain, 5), penumbra(plain, 2), 0.002F);
    EXPECT_LT(penumbra(plain, 5), penumbra(soft, 5) / 2);
}

TEST(RenderGpuShadow, AnyNumberOfCascades) {
    for (std::uint32_t count = 1; count <= max_cascades; ++count) {
        ShadowRig rig({.count = count, .resolution = 256, .far_distance = 30});
        scene::Snapshot snapshot = floor_scene(vec3(0.2F, 1, 0.1F));
        snapshot.camera = look(vec3(0, 4, 4), vec3(0, 0, -6), 60);
        add_box(snapshot, vec3(-30, 5, -30), vec3(30, 5.1F, -2));
        for (const float z : {-2.0F, -8.0F, -14.0F}) EXPECT_EQ(visibility_at(rig, snapshot, vec3(0, 0, z - 3)), 0);
        for (const float z : {0.0F, 0.5F}) EXPECT_EQ(visibility_at(rig, snapshot, vec3(0, 0, z)), 1);
    }
}

TEST(RenderGpuShadow, SameBytesEveryTime) {
    ShadowRig rig(small, 2);
    scene::Snapshot snapshot = floor_scene(vec3(0.4F, 1, 0.2F));
    add_light(snapshot, vec3(-0.4F, 1, 0.3F), "second");
    for (int i = 0; i < 40; ++i) {
        const float x = std::sin(static_cast<float>(i)), z = std::cos(static_cast<float>(2 * i));
        add_box(snapshot, vec3(x, 0.3F, z), vec3(x + 0.1F, 0.4F, z + 0.2F));
    }
    const Visibility first = rig.run(snapshot, floor_grid(), 1);
    EXPECT_GT(std::ranges::count(first.filtered, 0.0F), 100);
    for (int round = 0; round < 20; ++round) {
        const Visibility again = rig.run(snapshot, floor_grid(), 1);
        ASSERT_EQ(again.filtered, first.filtered) << round;
        ASSERT_EQ(again.one_tap, first.one_tap) << round;
    }
}

TEST(RenderGpuShadow, RefusesWhatTheDeviceLacks) {
    gpu::Context& context = gpu::test::context();
    GpuScene scene = must(GpuScene::create(context, {}));
    const gpu::SetLayout layout = must(create_frame_layout(context));
    const auto error = [&](const CascadeDesc& desc) {
        const Result<ShadowPass> made = ShadowPass::create(context, layout.handle, scene, desc, {.lights = 1});
        return made ? "made" : made.error().text;
    };
    const std::uint32_t most = context.traits.max_image_dimension;
    EXPECT_EQ(error({.resolution = most + 1}), "shadow resolution: " + std::to_string(most + 1) + ", [1, " +
                                                   std::to_string(most) + "] are allowed on this device");
    EXPECT_NE(error({.resolution = 0}), "made");
    EXPECT_EQ(error({.count = 5}), "shadow cascades: 5, [1, 4] are allowed");
    EXPECT_NE(error({.count = 0}), "made");
}

}  // namespace darkroom::render
