// SPDX-License-Identifier: MIT
#include "scene/scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scene/read/scene_test_text.hpp"
#include "tests/places.hpp"

namespace darkroom::scene {
namespace {

TEST(Scene, EmptyFileIsTheDefaults) {
    const Scene scene = scene_of("");
    EXPECT_EQ(scene.name, "a");
    EXPECT_EQ(scene.folder, "demos");
    EXPECT_TRUE(scene.has_grid);
    EXPECT_FALSE(scene.has_alpha_layer);
    EXPECT_FALSE(scene.camera.is_given);
    EXPECT_TRUE(scene.entities.empty());
}

TEST(Scene, ReadsTheTopTables) {
    const Scene scene = scene_of(R"(
format = 1
[scene]
name = "Hall"
version = "1.0"
description = "A hall."
input_config = "keys.toml"
grid = false
alpha_layer = true
[camera]
projection = "orthographic"
ortho_height = 4
position = [1, 2.5, 3]
target = { x = 1, y = 2, z = 0 }
fov = 80
near = 1
far = 50
aperture = 2.8
focus = 6
sensor_height = 14
[environment]
skybox = "sky.hdr"
skybox_intensity = 2
ambient_color = [1, 0, 0.5]
ambient_intensity = 0
background = { r = 1, g = 2, b = 3 }
[post_process]
bloom_intensity = 0.1
[ui]
document = "hud.svg"
)");
    EXPECT_EQ(scene.name, "Hall");
    EXPECT_EQ(scene.description, "A hall.");
    EXPECT_FALSE(scene.has_grid);
    EXPECT_TRUE(scene.has_alpha_layer);
    EXPECT_TRUE(scene.camera.is_given);
    EXPECT_EQ(scene.camera.projection, Projection::Orthographic);
    EXPECT_EQ(scene.camera.ortho_height, 4);
    EXPECT_EQ(scene.camera.position, vec3(1, 2.5F, 3));
    EXPECT_EQ(scene.camera.target, vec3(1, 2, 0));
    EXPECT_EQ(scene.camera.field_of_view, 80);
    EXPECT_EQ(scene.camera.near_distance, 1);
    EXPECT_EQ(scene.camera.far_distance, 50);
    EXPECT_EQ(scene.camera.lens.aperture, 2.8F);
    EXPECT_EQ(scene.camera.lens.focus, 6);
    EXPECT_EQ(scene.camera.lens.sensor_height, 14);
    EXPECT_EQ(scene.environment.skybox, "sky.hdr");
    EXPECT_EQ(scene.environment.skybox_intensity, 2);
    EXPECT_EQ(scene.environment.ambient_color, vec3(1, 0, 0.5F));
    EXPECT_EQ(scene.environment.ambient_intensity, 0);
    EXPECT_EQ(scene.environment.background, vec3(1, 2, 3));
}

TEST(Scene, SkinsAreChosenOrAssumedFromKeysOfTheEngine) {
    EXPECT_EQ(scene_of("[scene]\nname = \"A\"\n").skins, Skins::AllNodes);
    EXPECT_FALSE(scene_of("[scene]\nname = \"A\"\n").has_assumed_skins);
    EXPECT_EQ(scene_of("[scene]\nskins = \"joints_only\"\n").skins, Skins::JointsOnly);
    EXPECT_FALSE(scene_of("[scene]\nskins = \"joints_only\"\n").has_assumed_skins);
    for (const char* key : {"version = \"1.0\"", "input_config = \"keys.toml\""}) {
        const std::string top = std::string("[scene]\n") + key + "\n";
        EXPECT_EQ(scene_of(top).skins, Skins::JointsOnly) << key;
        EXPECT_TRUE(scene_of(top).has_assumed_skins) << key;
        EXPECT_EQ(scene_of(top + "skins = \"all_nodes\"\n").skins, Skins::AllNodes) << key;
        EXPECT_FALSE(scene_of(top + "skins = \"all_nodes\"\n").has_assumed_skins) << key;
    }
}

TEST(Scene, APerspectiveFileMayGiveAnOrthographicHeightOfZero) {
    EXPECT_EQ(scene_of("[camera]\northo_height = 0\n").camera.ortho_height, Camera{}.ortho_height);
}

TEST(Scene, PathsTakeWhatTheirKeysLeaveOut) {
    const Scene scene = scene_of(R"(
[camera]
position = [0, 1, 5]
fov = 60
[[camera.path]]
time = 0
[[camera.path]]
time = 2.5
position = [4, 1, 5]
fov = 30
[entities.door.transform]
position = [1, 0, 0]
scale = [2, 2, 2]
[[entities.door.transform.path]]
time = 0
[[entities.door.transform.path]]
time = 1
rotation = [0, 90, 0]
)");
    ASSERT_EQ(scene.camera.path.size(), 2U);
    EXPECT_EQ(scene.camera.path[0].position, vec3(0, 1, 5));
    EXPECT_EQ(scene.camera.path[0].field_of_view, 60);
    EXPECT_EQ(scene.camera.path[1].time, 2.5);
    EXPECT_EQ(scene.camera.path[1].position, vec3(4, 1, 5));
    EXPECT_EQ(scene.camera.path[1].target, vec3(0));
    EXPECT_EQ(scene.camera.path[1].field_of_view, 30);
    const std::vector<TransformKey>& path = scene.entities[0].path;
    ASSERT_EQ(path.size(), 2U);
    EXPECT_EQ(path[1].transform.position, vec3(1, 0, 0));
    EXPECT_EQ(path[1].transform.scale, vec3(2));
    expect_near(path[1].transform.rotation * vec3(1, 0, 0), vec3(0, 0, -1));
    expect_near(path[0].transform.rotation * vec3(1, 0, 0), vec3(1, 0, 0));
}

TEST(Scene, RotationsAreDegreesAboutXThenYThenZ) {
    const auto rotation = [](std::string_view angles) {
        return entity_of("[entities.a.transform]\n" + std::string(angles)).transform.rotation;
    };
    expect_near(rotation("rotation = [90, 0, 0]") * vec3(0, 1, 0), vec3(0, 0, 1));
    expect_near(rotation("rotation = [0, 90, 0]") * vec3(0, 0, 1), vec3(1, 0, 0));
    expect_near(rotation("rotation = [0, 0, 90]") * vec3(1, 0, 0), vec3(0, 1, 0));
    // y goes to z by the first turn, and z to x by the second.
    expect_near(rotation("rotation = [90, 90, 0]") * vec3(0, 1, 0), vec3(1, 0, 0));
    expect_near(rotation("rotation = { x = 0, y = 90, z = 90 }") * vec3(0, 0, 1), vec3(0, 1, 0));
}

TEST(Scene, TheQuaternionWinsAndIsNormalised) {
    const Transform transform =
        entity_of("[entities.a.transform]\nrotation = [90, 0, 0]\nrotation_quat = [0, 2, 0, 2]\n").transform;
    EXPECT_NEAR(glm::length(transform.rotation), 1, 1e-6);
    expect_near(transform.rotation * vec3(0, 0, 1), vec3(1, 0, 0));
}

TEST(Scene, IntegersAreFloatsInArraysAndTables) {
    const Entity entity = entity_of(R"(
[entities.hill.terrain]
heightmap = "hill.png"
[entities.hill.transform]
position = { x = 1, y = 2.5, z = -3 }
[entities.other]
[entities.hill.transform.scale]
x = 2
y = 1
z = 3
)",
                                    false);
    EXPECT_EQ(entity.name, "hill");
    EXPECT_EQ(entity.transform.position, vec3(1, 2.5F, -3));
    EXPECT_EQ(entity.transform.scale, vec3(2, 1, 3));
}

TEST(Scene, MissingMembersOfATableStayAsTheyAre) {
    const Transform transform = entity_of("[entities.a.transform]\nscale = { y = 4 }\n").transform;
    EXPECT_EQ(transform.scale, vec3(1, 4, 1));
}

TEST(Scene, EntitiesKeepTheOrderOfTheFile) {
    const Scene scene = scene_of(R"(
[entities.zebra]
[entities.mouse.transform]
position = [0, 0, 0]
[entities.ant]
archetype = "character"
[entities.mouse]
parent = "ant"
[entities.bee.bounds]
min = [0, 0, 0]
max = [1, 1, 1]
)");
    EXPECT_EQ(names_of(scene), (Names{"zebra", "mouse", "ant", "bee"}));
    EXPECT_EQ(scene.entities[1].parent, 2U);
    EXPECT_EQ(scene.entities[0].parent, Entity::none);
    EXPECT_EQ(scene.entities[2].archetype, "character");
}

// The layout of the volumetric dungeon demo, as its file has it.
TEST(Scene, ADemoSceneOpensWithOneWarningForEachUnknownComponent) {
    constexpr std::string_view demo = R"(
[scene]
name = "Volumetric Dungeon"
version = "1.0"

[camera]
position = [-2, 0.5, -2.5]
target = [2, 2.5, 0]
fov = 80

[post_process]
volumetric_enabled = true
volumetric_samples = 64

[entities.player]

[entities.player.transform]
position = [0, 1, 0]

[entities.player.character_controller]
height = 1.8

[entities.player.audio_listener]
active = true

[entities.floor]
archetype = "floor"

[entities.floor.transform]
position = [0, 0, 0]

[entities.floor.bounds]
min = [-3, -0.2, -3]
max = [3, 0, 3]

[entities.floor.material]
color = [0.15, 0.13, 0.11]
roughness = 0.95

[entities.floor.collider]
shape = "box"

[entities.ceiling.bounds]
min = [-50, 4, -50]
max = [3, 4.3, 50]

[entities.ceiling.collider]
shape = "box"
[entities.ceiling.rigidbody]
body_type = "static"

[entities.sun.light]
type = "directional"
direction = [0.4, 0.4, 0.05]
color = [1, 0.92, 0.75]
intensity = 6
volumetric_intensity = 4
volumetric_color = [1, 0.88, 0.6]
)";
    std::vector<std::string> warnings;
    const Result<Scene> scene = parse_scene(demo, "a.toml", {.warnings = &warnings});
    ASSERT_TRUE(scene) << scene.error().text;
    EXPECT_EQ(names_of(*scene), (Names{"player", "floor", "ceiling", "sun"}));
    EXPECT_EQ(scene->camera.field_of_view, 80);
    EXPECT_EQ(scene->entities[1].bounds->low, vec3(-3, -0.2F, -3));
    EXPECT_EQ(scene->entities[3].light->intensity, 6);
    ASSERT_EQ(warnings.size(), 4U);
    EXPECT_EQ(warnings[0], "a.toml:20:18: component 'character_controller' means nothing here, 1 is passed over");
    EXPECT_EQ(warnings[2], "a.toml:40:17: component 'collider' means nothing here, 2 are passed over");
}

TEST(Scene, ArchetypesLieUnderTheirEntities) {
    const Scene scene = scene_of(R"(
[archetypes.torch.light]
type = "point"
intensity = 3
range = 6
[archetypes.torch.transform]
position = [0, 2, 0]
[entities.a]
archetype = "torch"
[entities.a.light]
intensity = 5
[entities.b]
archetype = "torch"
[entities.c]
archetype = "wall"
)");
    EXPECT_EQ(scene.entities[0].light->intensity, 5);
    EXPECT_EQ(scene.entities[0].light->range, 6);
    EXPECT_EQ(scene.entities[1].light->intensity, 3);
    EXPECT_EQ(scene.entities[1].transform.position, vec3(0, 2, 0));
    EXPECT_FALSE(scene.entities[2].light);
}

TEST(Scene, ArchetypeColors) {
    EXPECT_EQ(archetype_color("room"), vec4(0.27F, 0.53F, 1, 0.5F));
    EXPECT_EQ(archetype_color("door"), vec4(1, 0.53F, 0.27F, 1));
    EXPECT_EQ(archetype_color("furniture"), vec4(0.27F, 1, 0.53F, 1));
    EXPECT_EQ(archetype_color("character"), vec4(1, 1, 0.27F, 1));
    EXPECT_EQ(archetype_color("wall"), vec4(0.76F, 0.70F, 0.60F, 1));
    EXPECT_EQ(archetype_color("floor"), vec4(0.55F, 0.55F, 0.52F, 1));
    EXPECT_EQ(archetype_color("ceiling"), vec4(0.65F, 0.62F, 0.58F, 1));
    EXPECT_EQ(archetype_color("pillar"), vec4(0.70F, 0.65F, 0.55F, 1));
    EXPECT_EQ(archetype_color(""), vec4(0.8F, 0.8F, 0.8F, 1));
    EXPECT_EQ(archetype_color("dragon"), archetype_color(""));
}

TEST(Scene, AModelFileIsASceneOfItself) {
    const TemporaryFolder folder;
    for (const char* const name : {"Fox.glb", "box.GLTF"}) {
        const std::filesystem::path path = folder.write(name, "anything");
        const Result<Scene> scene = read_scene(path);
        ASSERT_TRUE(scene) << scene.error().text;
        ASSERT_EQ(scene->entities.size(), 1U);
        EXPECT_EQ(scene->name, path.stem());
        EXPECT_EQ(scene->entities[0].name, "model");
        EXPECT_EQ(scene->entities[0].model->asset, path.string());
        EXPECT_TRUE(std::filesystem::path(scene->entities[0].model->asset).is_absolute());
        EXPECT_FALSE(scene->has_grid);
        EXPECT_FALSE(scene->camera.is_given);
    }
}

TEST(Scene, TenThousandEntitiesParseInASecond) {
    std::string many;
    for (int i = 0; i < 10000; ++i)
        many += fmt::format(
            "[entities.box{0}]\narchetype = \"wall\"\n[entities.box{0}.transform]\nposition = [1, 2, 3]\n"
            "[entities.box{0}.bounds]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[entities.box{0}.material]\ncolor = [1, 0, "
            "0]\n",
            i);
    const std::clock_t start = std::clock();
    const Scene scene = scene_of(many);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_EQ(scene.entities.size(), 10000U);
    EXPECT_EQ(scene.entities.back().name, "box9999");
    RecordProperty("milliseconds", static_cast<int>(seconds * 1000));
    EXPECT_LT(seconds, 10) << "a tenth of it on an idle machine, sanitizers aside";
}

// What the documentation shows is a scene.
TEST(Scene, TheExamplesOfTheDocumentationAreStrict) {
    std::ifstream file(std::filesystem::path(test::source_folder) / "docs" / "scenes.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    constexpr std::string_view begin = "```toml\n", end = "```";
    std::size_t entities = 0, examples = 0;
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at), ++examples) {
        at += begin.size();
        entities += scene_of(page.substr(at, page.find(end, at) - at)).entities.size();
    }
    EXPECT_GE(examples, 2U);
    EXPECT_GE(entities, 4U);
}

}  // namespace
}  // namespace darkroom::scene
