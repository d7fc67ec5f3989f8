// SPDX-License-Identifier: MIT
#include "scene/pose/snapshot.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

namespace darkroom::scene {

namespace {

Scene with_camera(std::vector<Entity> entities) {
    Scene scene;
    scene.camera.is_given = true;
    scene.entities = std::move(entities);
    return scene;
}

Entity box(std::string name) { return {.name = std::move(name), .bounds = Box{vec3(0), vec3(1)}}; }

Snapshot at(const Scene& scene, double time = 0, double previous_time = 0) {
    return snapshot(scene, {}, {.time = time, .previous_time = previous_time});
}

void expect_close(vec3 actual, vec3 expected, float allowed = 1e-5F) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], allowed) << "axis " << axis;
}

vec3 moved(const mat4& matrix, vec3 point) { return vec3(matrix * vec4(point, 1)); }

/// Two materials, three primitives in two meshes under one moved node; primitive 2 has no material.
Assets furniture() {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.materials.resize(2);
    model.materials[0].base_color = {0.2F, 0.3F, 0.4F, 0.5F};
    model.materials[1] = {
        .base_color = {1, 1, 1, 0.25F}, .metallic = 0.5F, .emissive = {1, 2, 3}, .blend = SurfaceBlend::Mask};
    model.meshes.resize(2);
    model.meshes[0].primitives.resize(2);
    model.meshes[1].primitives.resize(1);
    for (Mesh& mesh : model.meshes)
        for (Primitive& primitive : mesh.primitives) primitive.bounds = {vec3(0), vec3(1)};
    model.meshes[0].primitives[0].material = 1;
    model.meshes[0].primitives[1].material = 0;
    model.nodes.resize(3);
    model.nodes[0].transform.position = {0, 10, 0};
    model.nodes[1] = {.parent = 0, .transform = {.scale = {-1, 1, 1}}, .mesh = 0};
    model.nodes[2] = {.parent = 0, .mesh = 1};
    assets.entities = {{.model = 0}};
    return assets;
}

Light lamp(LightType type, float intensity, float range = 10) {
    return {.type = type, .intensity = intensity, .direction = {1, 0, 0}, .range = range};
}

}  // namespace

TEST(SceneSnapshot, EntitiesStandInTheirParents) {
    Entity child = box("child");
    child.parent = 2;  // a parent may come later in the file
    child.transform = {.position = {1, 0, 0}};
    Entity middle = box("middle");
    middle.parent = 0;
    Entity top{.name = "top"};
    top.transform = {
        .position = {5, 0, 0}, .rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0)), .scale = vec3(2)};
    const Snapshot found = at(with_camera({child, middle, top}));
    ASSERT_EQ(found.instances.size(), 2U);
    expect_close(moved(found.instances[0].world, vec3(0)), {5, 0, -2});
    expect_close(moved(found.instances[1].world, vec3(1, 0, 0)), {5, 0, -4});
    EXPECT_EQ(found.instances[1].entity, 1U);
}

TEST(SceneSnapshot, ACycleOfParentsEnds) {
    Scene scene = with_camera({box("a"), box("b")});
    scene.entities[0].parent = 1;
    scene.entities[1].parent = 0;
    scene.entities[1].emitter.emplace();
    EXPECT_EQ(at(scene, 1).instances.size(), 2U);
}

TEST(SceneSnapshot, BoxesAreTheUnitBoxMoved) {
    Entity entity = box("box");
    entity.bounds = Box{{-1, 2, 3}, {1, 2, 7}};
    entity.transform = {.position = {10, 0, 0}, .scale = {-1, 1, 1}};
    const Instance found = at(with_camera({entity})).instances.at(0);
    EXPECT_EQ(found.mesh.model, no_index);
    expect_close(moved(found.world, vec3(0)), {11, 2, 3});
    expect_close(moved(found.world, vec3(1)), {9, 2, 7});
    expect_close(found.bounds.low, {9, 2, 3});
    expect_close(found.bounds.high, {11, 2, 7});
    EXPECT_TRUE(found.is_mirrored);
    EXPECT_GT(std::abs(glm::determinant(mat3(found.world))), 0) << "a flat box has normals";
}

TEST(SceneSnapshot, PathsGiveMotion) {
    Entity parent = box("parent"), child = box("child");
    parent.path = {
        {.time = 0},
        {.time = 2,
         .transform = {.position = {4, 0, 0}, .rotation = glm::angleAxis(1.0F, vec3(0, 1, 0)), .scale = vec3(3)}}};
    child.parent = 0;
    const Scene scene = with_camera({parent, child});
    const Instance found = at(scene, 1, 0.5).instances.at(1);
    expect_close(moved(found.world, vec3(0)), {2, 0, 0});
    expect_close(moved(found.world, vec3(1, 0, 0)), {2 + 2 * std::cos(0.5F), 0, -2 * std::sin(0.5F)});
    EXPECT_EQ(found.previous_world, at(scene, 0.5).instances.at(1).world);
    const Instance still = at(scene, 1, 1).instances.at(1);
    EXPECT_EQ(still.previous_world, still.world);
    expect_close(moved(at(scene, 99).instances.at(0).world, vec3(0)), {4, 0, 0});
}

TEST(SceneSnapshot, BoxSurfacesHaveDefaults) {
    Entity plain = box("plain"), room = box("room"), painted = box("painted");
    room.archetype = painted.archetype = "room";
    painted.material = Material{.color = vec3(0.1F, 0.2F, 0.3F), .emissive = vec3(1, 2, 3), .emissive_strength = 2};
    const Snapshot found = at(with_camera({plain, room, painted}));
    EXPECT_EQ(found.materials[0].surface.metallic, 0);
    EXPECT_EQ(found.materials[0].surface.roughness, 0.7F);
    EXPECT_EQ(found.materials[0].surface.blend, SurfaceBlend::Opaque);
    EXPECT_EQ(found.materials[1].surface.base_color, archetype_color("room"));
    EXPECT_TRUE(found.instances[1].is_wireframe);
    EXPECT_FALSE(found.instances[1].casts_shadow);
    EXPECT_FALSE(found.instances[2].is_wireframe);
    EXPECT_EQ(found.materials[2].surface.base_color, vec4(0.1F, 0.2F, 0.3F, 1));
    EXPECT_EQ(found.materials[2].surface.emissive, vec3(2, 4, 6));
}

TEST(SceneSnapshot, TransparencyChoosesTheBlend) {
    Entity entity = box("box");
    const auto found = [&](const Material& material) {
        entity.material = material;
        const Snapshot out = at(with_camera({entity}));
        return std::pair(out.materials[0].surface.blend, out.instances[0].casts_shadow);
    };
    EXPECT_EQ(found({.opacity = 0.5F}), std::pair(SurfaceBlend::Alpha, true));
    EXPECT_EQ(found({.alpha = 0.5F}), std::pair(SurfaceBlend::Alpha, true));
    EXPECT_EQ(found({.opacity = 0.5F, .blend = SurfaceBlend::Additive}), std::pair(SurfaceBlend::Additive, false));
    EXPECT_EQ(found({.blend = SurfaceBlend::Multiply}), std::pair(SurfaceBlend::Multiply, false));
    EXPECT_EQ(found({.writes = Writes::Alpha}), std::pair(SurfaceBlend::Opaque, false));
}

TEST(SceneSnapshot, ModelsGiveAnInstanceForEachPrimitive) {
    const Assets assets = furniture();
    Entity entity{.name = "thing", .transform = {.position = {1, 0, 0}}};
    const Snapshot found = snapshot(with_camera({entity}), assets, {});
    ASSERT_EQ(found.instances.size(), 3U);
    ASSERT_EQ(found.materials.size(), 3U);
    EXPECT_EQ(found.instances[1].mesh, (MeshId{0, 0, 1}));
    EXPECT_EQ(found.instances[2].mesh, (MeshId{0, 1, 0}));
    expect_close(found.instances[0].bounds.low, {0, 10, 0});
    EXPECT_TRUE(found.instances[0].is_mirrored);
    EXPECT_FALSE(found.instances[2].is_mirrored);
    EXPECT_EQ(found.materials[found.instances[0].material].surface.blend, SurfaceBlend::Mask);
    EXPECT_EQ(found.materials[found.instances[0].material].surface.base_color.w, 0.25F);
    EXPECT_EQ(found.materials[found.instances[1].material].surface.base_color, vec4(0.2F, 0.3F, 0.4F, 1));
    EXPECT_EQ(found.materials[found.instances[2].material].surface.metallic, 1) << "the default material of glTF";
    EXPECT_EQ(found.materials[0].model, 0U);
}

TEST(SceneSnapshot, OnlyWhatIsGivenOverridesAModel) {
    Assets assets = furniture();
    Entity entity{.name = "thing"};
    entity.material = Material{.roughness = 0.3F, .opacity = 0.5F};
    const Snapshot found = snapshot(with_camera({entity}), assets, {});
    const SnapshotMaterial& first = found.materials[found.instances[0].material];
    EXPECT_EQ(first.surface.roughness, 0.3F);
    EXPECT_EQ(first.surface.metallic, 0.5F);
    EXPECT_EQ(first.surface.emissive, vec3(1, 2, 3));
    EXPECT_EQ(first.surface.blend, SurfaceBlend::Alpha);
    EXPECT_EQ(first.opacity, 0.5F);
    assets.entities[0].material_texture = 7;
    EXPECT_EQ(snapshot(with_camera({entity}), assets, {}).materials[0].entity_texture, 7U);
}

TEST(SceneSnapshot, ModelsInheritTheirColor) {
    Assets assets = furniture();
    assets.entities = {{}, {}, {.model = 0}};
    Entity top{.name = "top"}, middle{.name = "middle"}, thing{.name = "thing"};
    top.material = Material{.color = vec3(0.9F, 0, 0), .alpha = 0.4F, .metallic = 0.1F};
    middle.parent = 0;
    middle.material = Material{.roughness = 0.1F};
    thing.parent = 1;
    Scene scene = with_camera({top, middle, thing});
    const SnapshotMaterial inherited = snapshot(scene, assets, {}).materials[1];
    EXPECT_EQ(inherited.surface.base_color, vec4(0.9F, 0, 0, 0.4F));
    EXPECT_EQ(inherited.surface.blend, SurfaceBlend::Alpha);
    EXPECT_EQ(inherited.surface.metallic, 1) << "nothing else is inherited";
    scene.entities[2].material = Material{.color = vec3(0, 1, 0)};
    EXPECT_EQ(snapshot(scene, assets, {}).materials[1].surface.base_color, vec4(0, 1, 0, 1));
}

TEST(SceneSnapshot, SkinsAndMorphsAreInWorldSpace) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    Primitive skinned, morphed;
    skinned.vertices.resize(1);
    skinned.vertices[0].position = {1, 0, 0};
    skinned.skin = {{.joints = {0, 0, 0, 0}, .weights = {1, 0, 0, 0}}};
    morphed.vertices = skinned.vertices;
    morphed.targets = {{.positions = {vec3(0, 2, 0)}}};
    model.meshes = {{.primitives = {skinned, morphed}, .weights = {0.5F}}};
    model.nodes.resize(2);
    model.nodes[0].transform.position = {100, 0, 0};  // has no say in skinned vertices
    model.nodes[0].mesh = 0;
    model.nodes[0].skin = 0;
    model.skins = {{.joints = {1}, .inverse_bind = {mat4(1)}}};
    model.animations = {
        {.name = "rise", .channels = {{.node = 1, .times = {0, 10}, .values = {0, 0, 0, 0, 0, 10}}}, .duration = 10}};
    assets.entities = {{.model = 0}};
    Entity entity{
        .name = "figure", .transform = {.position = {0, 5, 0}}, .model = ModelReference{.animation_speed = 2}};
    const Scene scene = with_camera({entity});
    const Snapshot found = snapshot(scene, assets, {.time = 2, .previous_time = 1});
    ASSERT_EQ(found.joints.size(), 1U);
    expect_close(vec3(found.joints[0][3]), {0, 5, 4});
    expect_close(vec3(found.previous_joints.at(0)[3]), {0, 5, 2});
    EXPECT_EQ(found.instances[0].first_joint, 0U);
    EXPECT_EQ(found.instances[0].joint_count, 1U);
    expect_close(found.instances[0].bounds.low, {1, 5, 4});
    EXPECT_EQ(found.instances[1].first_joint, no_index);
    EXPECT_EQ(found.instances[1].weight_count, 1U);
    EXPECT_EQ(found.weights.at(found.instances[1].first_weight), 0.5F);
    expect_close(found.instances[1].bounds.high, {101, 6, 0});
    EXPECT_EQ(snapshot(scene, assets, {.time = 2, .previous_time = 2}).previous_joints, found.joints);
}

// A node that goes from -1 to 1 in a second, and begins again; or comes back as it began.
TEST(SceneSnapshot, AClipThatJumpsToItsBeginningMovesNothingThere) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.meshes = {{.primitives = {Primitive{.vertices = std::vector<Vertex>(3)}}}};
    model.nodes = {{.mesh = 0}};
    model.animations = {
        {.channels = {{.times = {0, 1}, .values = {-1, 0, 0, 1, 0, 0}}}, .duration = 1},
        {.channels = {{.times = {0, 0.5F, 1}, .values = {-1, 0, 0, 1, 0, 0, -1, 0, 0}}}, .duration = 1}};
    assets.entities = {{.model = 0}};
    Scene scene = with_camera({{.name = "door", .model = ModelReference{}}});
    const auto motion = [&](double time, double previous_time) {
        const Snapshot found = snapshot(scene, assets, {.time = time, .previous_time = previous_time});
        return found.instances[0].world[3].x - found.instances[0].previous_world[3].x;
    };
    EXPECT_NEAR(motion(0.9, 0.8), 0.2F, 1e-5F);
    EXPECT_EQ(motion(1, 0.9), 0) << "1.8 the other way, if it were motion";
    EXPECT_EQ(motion(1.05, 0.95), 0);
    EXPECT_EQ(motion(2.95, 3.05), 0);
    EXPECT_NEAR(motion(1.15, 1.05), 0.2F, 1e-5F);
    scene.entities[0].model->animation = "1";
    EXPECT_NEAR(motion(1, 0.9), -0.4F, 1e-5F);
    EXPECT_NEAR(motion(1.1, 0.95), 0.2F, 1e-5F);
}

TEST(SceneSnapshot, AnEntityHasItsOwnCutoff) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.meshes = {{.primitives = {Primitive{.material = 0}}}};
    model.materials = {{.blend = SurfaceBlend::Mask, .alpha_cutoff = 0.3F}};
    model.nodes = {{.mesh = 0}};
    assets.entities = {{.model = 0}};
    Scene scene = with_camera({{.name = "hedge", .material = Material{}, .model = ModelReference{}}});
    const auto cutoff = [&] { return snapshot(scene, assets, {}).materials.at(0).surface.alpha_cutoff; };
    EXPECT_EQ(cutoff(), 0.3F);
    scene.entities[0].material->alpha_cutoff = 0.5F;
    EXPECT_EQ(cutoff(), 0.5F) << "though it is what there is without a model";
}

TEST(SceneSnapshot, ClipsAreFoundByNameOrNumber) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(1);
    model.meshes[0].primitives[0].bounds = {vec3(0), vec3(1)};
    model.nodes = {{.mesh = 0}};
    for (const float x : {1.0F, 2.0F})
        model.animations.push_back(
            {.name = x == 1 ? "walk" : "run", .channels = {{.times = {0}, .values = {x, 0, 0}}}});
    assets.entities = {{.model = 0}};
    Scene scene = with_camera({{.name = "figure", .model = ModelReference{}}});
    const auto x_of = [&](const std::string& animation, std::size_t warnings) {
        scene.entities[0].model->animation = animation;
        const Snapshot found = snapshot(scene, assets, {.time = 1});
        EXPECT_EQ(found.warnings.size(), warnings);
        return found.instances[0].world[3].x;
    };
    EXPECT_EQ(x_of("", 0), 1);
    EXPECT_EQ(x_of("run", 0), 2);
    EXPECT_EQ(x_of("1", 0), 2);
    EXPECT_EQ(x_of("2", 1), 1);
    EXPECT_EQ(x_of("fly", 1), 1);
    scene.entities[0].model->is_animated = false;
    EXPECT_EQ(x_of("run", 0), 0);
}

TEST(SceneLights, ADarkSceneGetsTwo) {
    const Snapshot found = at(with_camera({}));
    ASSERT_EQ(found.lights.size(), 2U);
    EXPECT_EQ(found.lights[0].name, "key");
    EXPECT_EQ(found.lights[0].light.intensity, 3);
    expect_close(found.lights[0].direction, glm::normalize(vec3(0.5F, 1, 0.3F)));
    EXPECT_EQ(found.lights[1].name, "fill");
    EXPECT_EQ(found.lights[1].light.color, vec3(0.6F, 0.7F, 0.9F));
    EXPECT_EQ(at(with_camera({{.name = "lamp", .light = lamp(LightType::Point, 0)}})).lights.size(), 1U);
}

TEST(SceneLights, StandAndPointWithTheirEntity) {
    Entity spot{.name = "spot", .light = lamp(LightType::Spot, 1)};
    spot.transform = {
        .position = {1, 2, 3}, .rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1)), .scale = {5, 1, 1}};
    Entity sun = spot;
    sun.light->type = LightType::Directional;
    sun.light->direction = {0, 0, 9};
    sun.light->color = {1, 0.5F, 0};
    const Snapshot found = at(with_camera({spot, sun}));
    EXPECT_EQ(found.lights[0].light.type, LightType::Directional) << "directional lights come first";
    expect_close(found.lights[0].direction, {0, 0, 1});
    EXPECT_EQ(found.lights[0].light.volumetric_color, vec3(1, 0.5F, 0));
    expect_close(found.lights[1].direction, {0, 1, 0});
    expect_close(found.lights[1].position, {1, 2, 3});
}

TEST(SceneLights, OfModelsShineAlongTheirNode) {
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.lights = {lamp(LightType::Directional, 2), lamp(LightType::Spot, 1)};
    model.nodes.resize(2);
    model.nodes[0].light = 0;
    model.nodes[1] = {.name = "torch", .transform = {.position = {0, 0, 7}}, .light = 1};
    assets.entities = {{.model = 0}};
    Entity entity{.name = "house"};
    entity.transform.rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0));
    const Snapshot found = snapshot(with_camera({entity}), assets, {});
    ASSERT_EQ(found.lights.size(), 2U);
    expect_close(found.lights[0].direction, {1, 0, 0});   // toward the light, which shines to -z turned to -x
    expect_close(found.lights[1].direction, {-1, 0, 0});  // out of the light
    expect_close(found.lights[1].position, {7, 0, 0});
    EXPECT_EQ(found.lights[1].name, "house/torch");
    EXPECT_FLOAT_EQ(found.lights[1].light.intensity, 1.0F / 683);  // candela to the scene's unit
    entity.model = ModelReference{.light_scale = 3};
    EXPECT_FLOAT_EQ(snapshot(with_camera({entity}), assets, {}).lights[1].light.intensity, 3);
}

TEST(SceneLights, KeepTheStrongestInOrder) {
    std::vector<Entity> entities;
    for (int i = 0; i < 6; ++i)  // equally bright from the third
        entities.push_back({.name = fmt::format("sun {}", 9 - i),
                            .light = lamp(LightType::Directional, i < 2 ? static_cast<float>(i + 1) : 5.0F)});
    for (int i = 0; i < 18; ++i)
        entities.push_back({.name = fmt::format("point {}", i),
                            .light = lamp(LightType::Point, i == 3 ? 0.1F : 2.0F, i == 5 ? 0.1F : 4.0F)});
    for (int i = 0; i < 8; ++i)
        entities.push_back({.name = fmt::format("spot {}", i), .light = lamp(LightType::Spot, 1)});
    const Snapshot found = at(with_camera(entities));
    ASSERT_EQ(found.lights.size(), 28U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found.lights[i].name, fmt::format("sun {}", 4 + i));
    std::vector<std::string> points;
    for (std::size_t i = 4; i < 20; ++i) points.push_back(found.lights[i].name);
    std::vector<std::string> expected;
    for (int i = 0; i < 18; ++i)
        if (i != 3 && i != 5) expected.push_back(fmt::format("point {}", i));
    EXPECT_EQ(points, expected);
    ASSERT_EQ(found.warnings.size(), 2U);
    EXPECT_NE(found.warnings[0].find("6 directional lights, of which 2 are left out"), std::string::npos);
    EXPECT_NE(found.warnings[1].find("18 point lights, of which 2 are left out"), std::string::npos);
}

TEST(SceneSnapshot, PlacesTooFarApartAreAWarning) {
    const auto warnings_of = [](const std::string& at, const std::string& camera) {
        const Result<Scene> scene =
            parse_scene(fmt::format("{}[entities.box]\nbounds = {{ min = [0, 0, 0], max = [10, 10, 10] }}\n"
                                    "transform = {{ position = [{}, 0, 0] }}\n",
                                    camera, at),
                        "a.toml");
        return scene ? snapshot(*scene, {}, {}).warnings : std::vector<std::string>{scene.error().text};
    };
    EXPECT_EQ(warnings_of("0", ""), std::vector<std::string>());
    EXPECT_EQ(warnings_of("100000", ""), std::vector<std::string>());
    EXPECT_EQ(warnings_of("-4e6", ""),
              std::vector<std::string>{
                  "a.toml: what is drawn is 10 m large and lies 4e+06 m from the origin, where places are "
                  "0.25 m apart; move it nearer"});
    EXPECT_EQ(warnings_of("4e6", "[camera]\nposition = [0, 0, 5]\n"), std::vector<std::string>())
        << "whoever gives a camera looks elsewhere";
}

TEST(SceneLights, WarningsSayWhichIsLeftOutAndWhere) {
    std::string text;
    for (int i = 0; i < 9; ++i)
        text += fmt::format("[entities.lamp{}.light]\ntype = \"spot\"\nintensity = {}\n", i, i == 5 ? 1 : 2);
    Result<Scene> scene = parse_scene(text, "a.toml");
    ASSERT_TRUE(scene) << scene.error().text;
    EXPECT_EQ(snapshot(*scene, {}, {}).warnings,
              std::vector<std::string>{"a.toml:16:11: 9 spot lights, of which 1 are left out, entities.lamp5 first; at "
                                       "most 8 are drawn"});
    Assets assets;
    assets.models.emplace_back().lights = {lamp(LightType::Spot, 1)};
    assets.models[0].nodes = {{.name = "bulb", .light = 0}};
    assets.entities = {{.model = 0}};
    scene->entities.resize(8);
    scene->entities[5].light->intensity = 3;
    const Snapshot found = snapshot(*scene, assets, {});
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_TRUE(found.warnings[0].starts_with("a.toml:1:11: 9 spot lights")) << found.warnings[0];
    EXPECT_NE(found.warnings[0].find("entities.lamp0/bulb first"), std::string::npos) << found.warnings[0];
}

TEST(SceneSnapshot, AnUnknownClipIsNamedWithItsPlace) {
    const Result<Scene> scene =
        parse_scene("[entities.a]\n[entities.fox.model]\nasset = \"fox.glb\"\nanimation = \"fly\"\n", "a.toml");
    ASSERT_TRUE(scene) << scene.error().text;
    Assets assets;
    Model& model = assets.models.emplace_back();
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(1);
    model.nodes = {{.mesh = 0}};
    model.animations = {{.name = "walk"}};
    assets.entities = {{}, {.model = 0}};
    const Snapshot found = snapshot(*scene, assets, {});
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_TRUE(found.warnings[0].starts_with("a.toml:2:11: entities.fox.model: animation \"fly\""))
        << found.warnings[0];
}

TEST(SceneSnapshot, SpritesShowTheirFrame) {
    Entity entity{.name = "tree", .sprite = Sprite{.width = 2, .height = 3, .frame = 6, .frames_x = 4, .frames_y = 2}};
    entity.transform = {.position = {1, 2, 3}, .scale = {2, 1, 1}};
    Entity hidden = entity;
    hidden.sprite->is_visible = false;
    const Snapshot found = at(with_camera({entity, hidden}));
    ASSERT_EQ(found.sprites.size(), 1U);
    EXPECT_EQ(found.sprites[0].uv, vec4(0.5F, 0.5F, 0.75F, 1));
    EXPECT_EQ(found.sprites[0].size, vec2(4, 3));
    EXPECT_EQ(found.sprites[0].previous_position, vec3(1, 2, 3));
}

TEST(SceneSnapshot, EmittersAreToldApartByName) {
    Entity first{.name = "first", .emitter = ParticleEmitter{}}, second = first;
    second.name = "second";
    const Scene scene = with_camera({first, second}), swapped = with_camera({second, first});
    const Snapshot found = at(scene, 3), other = at(swapped, 3);
    ASSERT_EQ(found.emitters.size(), 2U);
    ASSERT_FALSE(found.emitters[0].particles.empty());
    EXPECT_NE(found.emitters[0].particles[0].position, found.emitters[1].particles[0].position);
    EXPECT_EQ(found.emitters[0].particles[0].position, other.emitters[1].particles[0].position);
    Scene moving = scene;
    moving.entities[0].path = {{.time = 0, .transform = {.position = {3, 0, 0}}}};
    expect_close(at(moving, 3).emitters[0].particles[0].position,
                 found.emitters[0].particles[0].position + vec3(3, 0, 0));
}

// The limit is for sanitizers. An optimised build takes some 10 ms.
TEST(SceneSnapshot, TenThousandBoxesAreSoon) {
    std::vector<Entity> entities;
    for (int i = 0; i < 10000; ++i) {
        entities.push_back(box(fmt::format("box {}", i)));
        entities.back().transform.position = vec3(static_cast<float>(i), 0, 0);
    }
    const Scene scene = with_camera(entities);
    const std::clock_t begin = std::clock();
    const Snapshot found = at(scene, 1, 0.9);
    const double milliseconds = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_EQ(found.instances.size(), 10000U);
    expect_close(scene_bounds(found).high, {10000, 1, 1});
    EXPECT_LT(milliseconds, 1000);
    RecordProperty("milliseconds", fmt::format("{:.2f}", milliseconds));
}

}  // namespace darkroom::scene
