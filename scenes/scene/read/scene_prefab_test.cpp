// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "scene/read/scene_test_text.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {
namespace {

constexpr std::string_view lamp = R"(
[prefab]
name = "lamp"
[entities.post]
archetype = "pillar"
[entities.post.bounds]
min = [0, 0, 0]
max = [1, 3, 1]
[entities.bulb]
parent = "post"
[entities.bulb.transform]
position = [0, 3, 0]
scale = [1, 1, 1]
[entities.bulb.light]
type = "point"
intensity = 2
[entities.bulb.material]
texture = "${PREFIX}.png"
[entities."${PREFIX}-tag"]
parent = "ground"
)";

TEST(ScenePrefab, PrefabsBringInTheirTemplates) {
    const TemporaryFolder folder;
    folder.write("project/prefabs/lamp.prefab.toml", lamp);
    const std::filesystem::path path = folder.write("project/scenes/a.scene.toml", R"(
[entities.ground]
[prefabs.right]
template = "lamp"
prefix = "r"
[entities.last]
[prefabs.left]
template = "lamp"
[prefabs.left.overrides.bulb.light]
intensity = 7
[prefabs.left.overrides.bulb.transform]
position = [0, 4, 0]
[prefabs.left.overrides.post.sprite]
texture = "${PREFIX}/leaf.png"
)");
    const Result<Scene> scene = read_scene(path, {.is_strict = true});
    ASSERT_TRUE(scene) << scene.error().text;
    ASSERT_EQ(names_of(*scene),
              (Names{"ground", "r_post", "r_bulb", "r-tag", "last", "left_post", "left_bulb", "left-tag"}));
    const Entity &right = scene->entities[2], &left = scene->entities[6];
    EXPECT_EQ(right.parent, 1U);
    EXPECT_EQ(left.parent, 5U);
    EXPECT_EQ(scene->entities[7].parent, 0U) << "a parent outside the template keeps its name";
    EXPECT_EQ(right.light->intensity, 2);
    EXPECT_EQ(left.light->intensity, 7);
    EXPECT_EQ(left.light->type, LightType::Point) << "what an override leaves out stays";
    EXPECT_EQ(left.transform.position, vec3(0, 4, 0));
    EXPECT_EQ(left.transform.scale, vec3(1));
    EXPECT_EQ(left.material->texture, "left.png");
    EXPECT_EQ(right.material->texture, "r.png");
    EXPECT_EQ(scene->entities[5].sprite->texture, "left/leaf.png");
    EXPECT_FALSE(scene->entities[1].sprite);
}

TEST(ScenePrefab, TemplatesMayBeTablesAndFilesByName) {
    const TemporaryFolder folder;
    folder.write("parts/lamp.toml", lamp);
    const std::filesystem::path path = folder.write("a.toml", R"(
[entities.ground]
[templates.arm.entities.hand]
[templates.arm.entities.hand.transform.position]
x = 1
y = 2
[templates.body.entities.trunk]
[templates.body.prefabs.one]
template = "arm"
overrides.hand.transform.position.y = 5
[templates.body.prefabs.two]
template = "arm"
prefix = "${PREFIX}-second"
[prefabs.bob]
template = "body"
overrides.one_hand.transform.position.x = 9
[prefabs.light]
template = "parts/lamp.toml"
)");
    const Result<Scene> scene = read_scene(path, {.is_strict = true});
    ASSERT_TRUE(scene) << scene.error().text;
    ASSERT_EQ(names_of(*scene), (Names{"ground", "bob_trunk", "bob_one_hand", "bob-second_hand", "light_post",
                                       "light_bulb", "light-tag"}));
    EXPECT_EQ(scene->entities[2].transform.position, vec3(9, 5, 0)) << "the outer override wins, table into table";
    EXPECT_EQ(scene->entities[3].transform.position, vec3(1, 2, 0));
}

TEST(ScenePrefab, TemplatesHaveArchetypesOfTheirOwn) {
    const TemporaryFolder folder;
    folder.write("prefabs/lamp.prefab.toml",
                 "[archetypes.glow.light]\nintensity = 4\n[entities.a]\narchetype = \"glow\"\n"
                 "[entities.b]\narchetype = \"dim\"\n");
    const Result<Scene> scene = read_scene(
        folder.write("a.toml", "[archetypes.dim.light]\nintensity = 0.5\n[prefabs.x]\ntemplate = \"lamp\"\n"));
    ASSERT_TRUE(scene) << scene.error().text;
    EXPECT_EQ(scene->entities[0].light->intensity, 4);
    EXPECT_EQ(scene->entities[1].light->intensity, 0.5F);
}

}  // namespace
}  // namespace darkroom::scene
