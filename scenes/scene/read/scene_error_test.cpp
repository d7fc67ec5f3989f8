// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "scene/read/scene_test_text.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene {
namespace {

std::string error_of(std::string_view text, bool is_strict = false) {
    const Result<Scene> scene = parse_scene(text, "a.toml", {.is_strict = is_strict});
    return scene ? "accepted" : scene.error().text;
}
std::vector<std::string> warnings_of(std::string_view text) {
    std::vector<std::string> warnings;
    const Result<Scene> scene = parse_scene(text, "a.toml", {.warnings = &warnings});
    EXPECT_TRUE(scene) << scene.error().text;
    return warnings;
}
/// The only warning; also checks that it is an error for a strict reader, whose text it begins with.
std::string warning_of(std::string_view text) {
    const std::vector<std::string> warnings = warnings_of(text);
    EXPECT_EQ(warnings.size(), 1U) << (warnings.size() > 1 ? warnings[1] : "");
    EXPECT_NE(error_of(text, true), "accepted");
    return warnings.empty() ? "" : warnings.front();
}
Scene scene_despite(std::string_view warned_of) { return scene_of(warned_of, false); }
bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

TEST(SceneError, WrongKindsNamePlaceValueAndWhatIsExpected) {
    EXPECT_EQ(error_of("[entities.a.light]\nintensity = \"3\"\n"),
              "a.toml:2:13: entities.a.light.intensity = \"3\": expected a number, allowed is [0, 1000000]");
    EXPECT_EQ(
        error_of("[entities.a.transform]\nposition = 3\n"),
        "a.toml:2:12: entities.a.transform.position = 3: expected 3 numbers as an array [x, y, z] or a table of x, "
        "y, z");
    EXPECT_EQ(error_of("[entities.a.transform]\nscale = [1, 2]\n"),
              "a.toml:2:9: entities.a.transform.scale = [1, 2]: expected 3 numbers");
    EXPECT_EQ(error_of("[entities.a.transform]\nscale = [1, 2, \"x\"]\n"),
              "a.toml:2:16: entities.a.transform.scale[2] = \"x\": expected a number, allowed is [-1000000, 1000000]");
    EXPECT_EQ(error_of("[entities.a.transform]\nscale = {x = true}\n"),
              "a.toml:2:14: entities.a.transform.scale.x = true: expected a number, allowed is [-1000000, 1000000]");
    EXPECT_EQ(error_of("[scene]\ngrid = \"yes\"\n"), "a.toml:2:8: scene.grid = \"yes\": expected true or false");
    EXPECT_EQ(error_of("[entities.a.light]\ntype = 3\n"),
              "a.toml:2:8: entities.a.light.type = 3: expected directional, point or spot");
    EXPECT_EQ(error_of("[entities.a.sprite]\nframe = 0.5\n"),
              "a.toml:2:9: entities.a.sprite.frame = 0.5: expected a whole number, allowed is [0, 16777216]");
    EXPECT_TRUE(
        error_of("[entities.a.sprite]\ntexture = 3\n").starts_with("a.toml:2:11: entities.a.sprite.texture = 3"));
    EXPECT_EQ(error_of("[entities]\na = 3\n"), "a.toml:2:1: entities.a = 3: expected a table");
    EXPECT_EQ(error_of("[entities.a]\nlight = 3\n"), "a.toml:2:9: entities.a.light = 3: expected a table");
    EXPECT_EQ(error_of("entities = 3\n"), "a.toml:1:12: entities = 3: expected a table");
    EXPECT_EQ(error_of("[[camera]]\n"), "a.toml:1:1: camera = an array: expected a table");
    EXPECT_EQ(error_of("camera.path = 3\n"), "a.toml:1:15: camera.path = 3: expected an array of tables");
    EXPECT_EQ(error_of("[[camera.path]]\nfov = 3\n"), "a.toml:1:1: camera.path[0]: a key needs a time");
    EXPECT_EQ(error_of("[entities.a.model]\n"), "a.toml:1:1: entities.a.model.asset is missing");
}

TEST(SceneError, NoNumberIsNotANumber) {
    for (const char* const value : {"nan", "-nan", "inf", "-inf"}) {
        EXPECT_TRUE(contains(error_of("[camera]\nfov = " + std::string(value) + "\n"), "expected a finite number"));
        EXPECT_TRUE(contains(error_of("[entities.a.transform]\nposition = [0, " + std::string(value) + ", 0]\n"),
                             "a.toml:2:16: entities.a.transform.position[1]"));
        EXPECT_TRUE(contains(error_of("[entities.a.transform.scale]\ny = " + std::string(value) + "\n"), "finite"));
        EXPECT_TRUE(contains(error_of("[[camera.path]]\ntime = " + std::string(value) + "\n"), "finite"));
        EXPECT_TRUE(contains(error_of("[entities.a.sprite]\nframe = " + std::string(value) + "\n"), "finite"));
    }
}

TEST(SceneError, WhatIsNoTextIsToldAsThat) {
    constexpr std::string_view frame("v/1\1\2\0\0\0channels", 16);
    EXPECT_EQ(error_of(frame), "a.toml: a zero byte; allowed is TOML, text in UTF-8");
}

TEST(SceneError, OutOfRangeIsAWarningWithTheValueUsed) {
    EXPECT_EQ(warning_of("[entities.a.material]\nroughness = 2\n"),
              "a.toml:2:13: entities.a.material.roughness = 2: allowed is [0, 1]; the default is used");
    EXPECT_EQ(warning_of("[camera]\nfov = 180\n"),
              "a.toml:2:7: camera.fov = 180: allowed is (0, 180) degrees; 45 is used");
    EXPECT_EQ(scene_despite("[camera]\nfov = 180\n").camera.field_of_view, 45);
    EXPECT_EQ(warning_of("[scene]\nsamples = 0\n"),
              "a.toml:2:11: scene.samples = 0: allowed is [1, 1024]; the default is used");
    EXPECT_EQ(warning_of("[camera]\naperture = 0.4\n"),
              "a.toml:2:12: camera.aperture = 0.4: allowed is [0.5, 64]; the default is used");
    EXPECT_EQ(warning_of("[camera]\nfocus = 0\n"),
              "a.toml:2:9: camera.focus = 0: allowed is [0.01, 100000] m; the default is used");
    EXPECT_EQ(warning_of("[camera]\nsensor_height = 1001\n"),
              "a.toml:2:17: camera.sensor_height = 1001: allowed is [1, 1000] mm; the default is used");
    EXPECT_FALSE(scene_despite("[camera]\nfocus = 0\n").camera.lens.focus);
    EXPECT_EQ(warning_of("[entities.a.light]\ncolor = [1, -1, 0]\n"),
              "a.toml:2:13: entities.a.light.color[1] = -1: allowed is [0, 1000000]; 1 is used");
    EXPECT_EQ(scene_despite("[entities.a.light]\ncolor = [1, -1, 0]\n").entities[0].light->color, vec3(1, 1, 0));
    EXPECT_EQ(warning_of("[entities.a.particle_emitter]\nmax_particles = 10001\n"),
              "a.toml:2:17: entities.a.particle_emitter.max_particles = 10001: allowed is [0, 10000]; 256 is used");
    EXPECT_EQ(error_of("[entities.a.light]\nouter_angle = 45\n", true).substr(0, 52),
              "a.toml:2:15: entities.a.light.outer_angle = 45: allo");
    EXPECT_TRUE(contains(warning_of("[entities.a.light]\nouter_angle = 45\n"), "radians"));
    EXPECT_TRUE(contains(warning_of("[entities.a.transform]\nposition = [1e300, 0, 0]\n"), "allowed is [-1000000000"));
}

TEST(SceneError, UnknownChoicesNameTheNearest) {
    EXPECT_EQ(warning_of("[camera]\nprojection = \"perspectiv\"\n"),
              "a.toml:2:14: camera.projection = \"perspectiv\", did you mean 'perspective'? allowed is perspective "
              "or orthographic; perspective is used");
    EXPECT_TRUE(contains(warning_of("[entities.a.particle_emitter]\nblend_mode = \"multiply\"\n"),
                         "allowed is alpha or additive"));
    EXPECT_EQ(
        warning_of("[entities.a.material]\nblend_mode = \"\"\n"),
        "a.toml:2:14: entities.a.material.blend_mode = \"\": allowed is opaque, mask, alpha, additive or multiply; "
        "the default is used");
    EXPECT_FALSE(scene_despite("[entities.a.material]\nblend_mode = \"\"\n").entities[0].material->blend);
    EXPECT_TRUE(contains(warning_of("[entities.a.material]\nwrite_mask = \"rgb\"\n"), "allowed is all or alpha"));
}

TEST(SceneError, UnknownKeysNameTheNearest) {
    EXPECT_EQ(warning_of("[entities.a.light]\nintensty = 3\n"),
              "a.toml:2:1: unknown key 'intensty' = 3 in entities.a.light, did you mean 'intensity'?");
    EXPECT_EQ(warning_of("[entities.a.transform.scale]\nx = 1\nw = 2\n"),
              "a.toml:3:1: unknown key 'w' = 2 in entities.a.transform.scale");
    EXPECT_EQ(warning_of("[camrea]\n"), "a.toml:1:2: unknown key 'camrea', did you mean 'camera'?");
    EXPECT_EQ(warning_of("[entities.a]\narchetpye = \"wall\"\n"),
              "a.toml:2:1: entities.a.archetpye = \"wall\": unknown key, did you mean 'archetype'?");
    EXPECT_EQ(warning_of("[entities.a.lihgt]\n"),
              "a.toml:1:13: component 'lihgt' means nothing here, 1 is passed over, did you mean 'light'?");
    EXPECT_TRUE(contains(warning_of("[[camera.path]]\ntime = 0\nfvo = 3\n"), "in camera.path[0], did you mean 'fov'?"));
}

TEST(SceneError, UnknownComponentsAreOneWarningForEachKind) {
    std::string text;
    for (int i = 0; i < 50; ++i) {
        text += fmt::format("[entities.e{0}.collider]\nshape = \"box\"\n[[entities.e{0}.rigidbody]]\n", i);
    }
    const std::vector<std::string> warnings = warnings_of(text);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_EQ(warnings[0], "a.toml:1:14: component 'collider' means nothing here, 50 are passed over");
    EXPECT_EQ(warnings[1], "a.toml:3:15: component 'rigidbody' means nothing here, 50 are passed over");
}

TEST(SceneError, FogOfTheEnvironmentIsOneWarning) {
    EXPECT_EQ(warning_of("[environment]\nfog_density = 0.1\nfog_color = [1, 1, 1]\n"),
              "a.toml:3:1: environment has fog_color, fog_density: fog is set in [post_process]");
}

TEST(SceneError, WhatContradictsItselfIsMendedAndSaid) {
    EXPECT_TRUE(contains(warning_of("[camera]\nnear = 10\nfar = 5\n"), "camera.far = 5: is not beyond near = 10"));
    EXPECT_EQ(scene_despite("[camera]\nnear = 10\nfar = 5\n").camera.far_distance, 1000);
    EXPECT_TRUE(contains(warning_of("[camera]\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n"), "looks along -z"));
    EXPECT_TRUE(contains(warning_of("[entities.a.bounds]\nmin = [0, 2, 0]\nmax = [1, 1, 1]\n"), "is above max"));
    const Box box = *scene_despite("[entities.a.bounds]\nmin = [0, 2, 0]\nmax = [1, 1, 1]\n").entities[0].bounds;
    EXPECT_EQ(box.low, vec3(0, 1, 0));
    EXPECT_EQ(box.high, vec3(1, 2, 1));
    EXPECT_TRUE(contains(warning_of("[entities.a.bounds]\nmin = [-1, -1, -1]\n"), "bounds.max is missing"));
    EXPECT_TRUE(contains(warning_of("[entities.a.light]\ndirection = [0, 0, 0]\n"), "[0, -1, 0] is used"));
    EXPECT_TRUE(contains(warning_of("[entities.a.light]\ninner_angle = 1\n"), "is above outer_angle; 0.5 is used"));
    EXPECT_TRUE(contains(warning_of("[entities.a.light]\ncolor = [1, 1, 1, 1]\n"), "alpha means nothing here"));
    EXPECT_TRUE(contains(warning_of("[entities.a.transform]\nrotation_quat = [0, 0, 0, 0]\n"), "length above 0"));
    EXPECT_TRUE(contains(warning_of("[entities.a.sprite]\nframe = 4\nframes_x = 2\nframes_y = 2\n"), "2 x 2 frames"));
    EXPECT_TRUE(contains(warning_of("[entities.a.particle_emitter]\nlifetime_min = 3\n"), "the two are swapped"));
    EXPECT_TRUE(contains(warning_of("[[camera.path]]\ntime = 2\n[[camera.path]]\ntime = 1\n"), "times go back"));
    EXPECT_EQ(scene_despite("[[camera.path]]\ntime = 2\n[[camera.path]]\ntime = 1\n").camera.path[0].time, 1);
}

TEST(SceneError, UnknownParentsNameTheNearest) {
    EXPECT_EQ(error_of("[entities.kitchen]\n[entities.stove]\nparent = \"kichen\"\n"),
              "a.toml:3:10: entities.stove.parent = \"kichen\": there is no such entity, did you mean 'kitchen'?");
    EXPECT_EQ(scene_despite("[entities.a]\nparent = \"\"\n").entities[0].parent, Entity::none);
}

TEST(SceneError, CyclesNameTheChain) {
    EXPECT_EQ(error_of("[entities.a]\nparent = \"b\"\n[entities.b]\nparent = \"a\"\n"),
              "a.toml:2:10: entities.a.parent: entities are parents of themselves: a -> b -> a");
    EXPECT_TRUE(contains(error_of("[entities.a]\nparent = \"a\"\n"), "themselves: a -> a"));
    const std::string text = error_of(
        "[entities.leaf]\nparent = \"x\"\n[entities.x]\nparent = \"y\"\n[entities.y]\nparent = \"z\"\n"
        "[entities.z]\nparent = \"x\"\n");
    EXPECT_EQ(text, "a.toml:4:10: entities.x.parent: entities are parents of themselves: x -> y -> z -> x");
}

TEST(SceneError, PrefabErrorsNameThePlace) {
    EXPECT_EQ(error_of("[templates.lamp]\n[prefabs.a]\ntemplate = \"lmap\"\n"),
              "a.toml:3:12: prefabs.a.template = \"lmap\": there is neither a table [templates.lmap] nor a file "
              "prefabs/lmap.prefab.toml, did you mean 'lamp'?");
    EXPECT_EQ(error_of("[prefabs.a]\nprefix = \"x\"\n"),
              "a.toml:1:10: prefabs.a.template is missing: the name of a template");
    EXPECT_EQ(error_of("prefabs = 3\n"), "a.toml:1:11: prefabs = 3: expected a table");
    EXPECT_EQ(error_of("prefabs.a = 3\n"), "a.toml:1:9: prefabs.a = 3: expected a table");
    EXPECT_EQ(error_of("templates.t = 3\n[prefabs.a]\ntemplate = \"t\"\n"),
              "a.toml:1:15: templates.t = 3: expected a table");
    EXPECT_EQ(error_of("[entities.p_x]\n[templates.t.entities.x]\n[prefabs.p]\ntemplate = \"t\"\n"),
              "a.toml:2:23: entity 'p_x' is there already, from a.toml:1:11");
    EXPECT_EQ(warning_of("[templates.t.entities.bulb]\n[prefabs.p]\ntemplate = \"t\"\noverrides.blub.x = 1\n"),
              "a.toml:4:11: prefabs.p.overrides.blub: the template \"t\" has no such entity, did you mean 'p_bulb'?");
    EXPECT_EQ(error_of("[templates.t.entities.x]\n[prefabs.p]\ntemplate = \"t\"\noverrides = 3\n"),
              "a.toml:4:13: prefabs.p.overrides = 3: expected a table");
    EXPECT_TRUE(contains(error_of("[prefabs.p]\ntemplate = \"t\"\nprefix = \"\"\n"), "allowed are [1, 256] bytes"));
    EXPECT_TRUE(contains(error_of("[templates.t.entities.x.light]\nintensity = true\n[prefabs.p]\ntemplate = \"t\"\n"),
                         "a.toml:2:13: entities.p_x.light.intensity = true"));
}

TEST(SceneError, PrefabsThatHoldThemselvesNameTheChain) {
    EXPECT_EQ(error_of("[templates.a.prefabs.x]\ntemplate = \"b\"\n[templates.b.prefabs.y]\ntemplate = \"a\"\n"
                       "[prefabs.start]\ntemplate = \"a\"\n"),
              "a.toml:4:12: prefabs.y.template = \"a\": prefabs hold themselves: a -> b -> a");
}

TEST(SceneError, PrefabsAreBounded) {
    std::string text = "[prefabs.start]\ntemplate = \"t0\"\n";
    for (int level = 0; level < 12; ++level)
        for (int i = 0; i < 10; ++i)
            text += fmt::format("[templates.t{}.prefabs.p{}]\ntemplate = \"t{}\"\n", level, i, level + 1);
    text += "[templates.t12.entities.x]\n";
    EXPECT_TRUE(contains(error_of(text), "the scene has more than 10000 prefabs"));
    std::string deep = "[prefabs.start]\ntemplate = \"t0\"\n";
    for (int level = 0; level < 20; ++level)
        deep += fmt::format("[templates.t{}.prefabs.p]\ntemplate = \"t{}\"\n", level, level + 1);
    EXPECT_TRUE(contains(error_of(deep + "[templates.t20]\n"), "prefabs go deeper than 16: t0 -> t1"));
    // One long list of values, many times.
    std::string wide = "[templates.t.entities.x.junk]\n";
    for (int i = 0; i < 5000; ++i) wide += fmt::format("k{} = 1\n", i);
    for (int i = 0; i < 1000; ++i) wide += fmt::format("[prefabs.p{}]\ntemplate = \"t\"\n", i);
    EXPECT_TRUE(contains(error_of(wide), "the scene holds more than 1000000 values"));
}

TEST(SceneError, ErrorsInPrefabFilesNameTheirFile) {
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "darkroom_scene_error_prefab";
    std::filesystem::create_directories(folder / "prefabs");
    std::ofstream(folder / "prefabs" / "kind.prefab.toml") << "[entities.a.light]\nintensity = true\n";
    std::ofstream(folder / "prefabs" / "syntax.prefab.toml") << "[entities.a\n";
    std::ofstream(folder / "prefabs" / "self.prefab.toml") << "[prefabs.x]\ntemplate = \"self\"\n";
    const auto error = [&](const std::string& name) {
        return parse_scene("[prefabs.p]\ntemplate = \"" + name + "\"\n", folder / "a.toml").error().text;
    };
    EXPECT_TRUE(contains(error("kind"), "prefabs/kind.prefab.toml:2:13: entities.p_a.light.intensity = true"));
    EXPECT_TRUE(contains(error("syntax"), "a.toml:2:12: prefabs.p.template = \"syntax\": "));
    EXPECT_TRUE(contains(error("syntax"), "syntax.prefab.toml:1:"));
    EXPECT_TRUE(contains(error("self"), "self -> self"));
    std::filesystem::remove_all(folder);
}

TEST(SceneError, ManyProblemsAreCounted) {
    std::string text = "[entities.a.light]\n";
    for (int i = 0; i < 30; ++i) text += fmt::format("key{} = 1\n", i);
    const std::vector<std::string> warnings = warnings_of(text);
    ASSERT_EQ(warnings.size(), 21U);
    EXPECT_EQ(warnings.back(), "a.toml: and 10 more");
    EXPECT_TRUE(warnings.front().starts_with("a.toml:2:1:")) << "in the order of the file";
    EXPECT_TRUE(error_of(text, true).ends_with("; a.toml: and 10 more"));
}

TEST(SceneError, SyntaxErrorsNameTheLine) {
    EXPECT_TRUE(error_of("[scene]\nname = \n").starts_with("a.toml:2:"));
    EXPECT_TRUE(error_of("[entities.a]\n[entities.a]\n").starts_with("a.toml:2:"));
}

TEST(SceneError, ControlBytesAreNotEchoed) {
    const std::string text = "[entities.\"a\\u001b[31m\".light]\n\"in\\u0007\" = 1\nintensity = \"\\u001b\"\n";
    for (const std::string& shown : {error_of(text), error_of(text, true)})
        EXPECT_EQ(shown.find_first_of("\x1b\x07"), std::string::npos) << shown;
}

TEST(SceneError, FilesThatAreNoScenesGetALine) {
    const auto error = [](const char* path) {
        const Result<Scene> scene = read_scene(path);
        return scene ? "accepted" : scene.error().text;
    };
    EXPECT_EQ(error("picture.png"), "picture.png: expected a scene (.toml) or a model (.glb, .gltf)");
    EXPECT_EQ(error("missing.glb"), "missing.glb: there is no such file");
    EXPECT_TRUE(contains(error("missing.toml"), "missing.toml"));
    EXPECT_TRUE(contains(error("/dev/zero"), "a regular file is needed"));
    EXPECT_TRUE(contains(error_of(std::string((4U << 20) + 1, '\n')), "4194305 bytes, at most 4194304 are read"));
}

// Bounds of processor time are many times what it takes, for sanitizers, and are meant to catch what is quadratic.
double seconds_of(std::string_view text, std::string_view part) {
    const std::clock_t start = std::clock();
    const std::string error = error_of(text);
    EXPECT_TRUE(contains(error, part)) << error.substr(0, 300);
    EXPECT_EQ(error.find('\n'), std::string::npos);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(SceneError, TooManyEntitiesAreRefused) {
    std::string text = "[entities]\n";
    for (int i = 0; i <= 100000; ++i) text += fmt::format("e{}={{}}\n", i);
    EXPECT_LT(seconds_of(text, "the scene has more than 100000 entities"), 10);
}

TEST(SceneError, LongChainsOfParentsAreFollowedOnce) {
    std::string text;
    for (int i = 0; i < 20000; ++i)
        text += fmt::format("[entities.e{}]\nparent = \"e{}\"\nmodel = {{asset = \"a\"}}\n", i, (i + 1) % 20000);
    EXPECT_LT(seconds_of(text, "e0 -> e1 -> e2"), 10);
    text.replace(text.rfind("\"e0\""), 4, "\"\"");
    EXPECT_LT(seconds_of(text, "accepted"), 10);
}

TEST(SceneError, ManyFaultsStayFast) {
    std::string unknown = "[entities.a.light]\n", parents, wrong;
    for (int i = 0; i < 50000; ++i) unknown += fmt::format("k{} = true\n", i);
    EXPECT_LT(seconds_of(unknown + "intensity = true\n", "intensity = true"), 10);
    for (int i = 0; i < 20000; ++i) parents += fmt::format("[entities.e{}]\nparent = \"nobody\"\n", i);
    EXPECT_LT(seconds_of(parents, "and 19980 more"), 10);
    for (int i = 0; i < 20000; ++i) wrong += fmt::format("[entities.e{}]\ntransform = 1\nlight = []\n", i);
    EXPECT_LT(seconds_of(wrong, "and 39980 more"), 10);
}

TEST(SceneError, DeepNestingIsRefusedNotFollowed) {
    std::string dots = "a";
    for (int i = 0; i < 100000; ++i) dots += ".a";
    EXPECT_NE(error_of(dots + " = 1\n"), "accepted");
    EXPECT_NE(error_of("[entities." + dots + "]\n"), "accepted");
    const std::string brackets(100000, '[');
    EXPECT_NE(error_of("a = " + brackets), "accepted");
    std::string nested = "[entities.a.light.color.r.r.r.r.r.r.r.r.r.r.r.r.r]\nx = 1\n";
    EXPECT_TRUE(contains(error_of(nested), "entities.a.light.color.r = a table: expected a number"));
}

TEST(SceneError, HostileFilesGetALine) {
    const char* const folder = std::getenv("DARKROOM_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(folder) / "hostile")) {
        if (file.path().extension() != ".toml") continue;
        const Result<Scene> scene = read_scene(file.path(), {.is_strict = true});
        ASSERT_FALSE(scene) << file.path();
        EXPECT_TRUE(contains(scene.error().text, file.path().filename().string() + ":"));
        EXPECT_EQ(scene.error().text.find('\n'), std::string::npos);
        ++count;
    }
    EXPECT_GE(count, 4U);
}

// Every key of a whole scene gets every kind of value: nothing may crash, and what is refused is refused in one line.
TEST(SceneError, WrongKindsEverywhereNeverCrash) {
    const std::vector<std::string> keys{"scene.name",
                                        "scene.grid",
                                        "camera.projection",
                                        "camera.position",
                                        "camera.path",
                                        "camera.fov",
                                        "camera.focus",
                                        "environment.skybox",
                                        "environment.fog_x",
                                        "entities.a",
                                        "entities.a.parent",
                                        "entities.a.archetype",
                                        "entities.a.transform",
                                        "entities.a.bounds.min",
                                        "entities.a.model",
                                        "prefabs",
                                        "prefabs.x",
                                        "prefabs.x.template",
                                        "prefabs.x.prefix",
                                        "prefabs.x.overrides",
                                        "templates",
                                        "templates.t",
                                        "templates.t.entities",
                                        "templates.t.entities.a.parent",
                                        "archetypes",
                                        "archetypes.w",
                                        "archetypes.w.light",
                                        "entities.b.light.color",
                                        "entities.b.sprite.frame",
                                        "entities.b.transform.path",
                                        "entities.b.transform.rotation_quat",
                                        "entities.b.particle_emitter.color_start",
                                        "entities.c.material.color"};
    const std::vector<std::string> values{"1",
                                          "-1.5",
                                          "nan",
                                          "true",
                                          "\"t\"",
                                          "\"w\"",
                                          "\"a\"",
                                          "[]",
                                          "{}",
                                          "[1, 2]",
                                          "[1, 2, 3]",
                                          "[1, 2, 3, 4]",
                                          "[[1]]",
                                          "[{}]",
                                          "{x = 1}",
                                          "{a = {}}",
                                          "[{time = 1}]",
                                          "1979-05-27",
                                          "{template = \"t\"}",
                                          "9223372036854775807",
                                          "1e308",
                                          "\"${PREFIX}\""};
    std::mt19937 random(1);
    const auto any = [&](const std::vector<std::string>& list) { return list[random() % list.size()]; };
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text;
        for (int line = 0; line < 4; ++line) text += any(keys) + " = " + any(values) + "\n";
        const std::string error = error_of(text, i % 2 == 0);
        EXPECT_EQ(error.find('\n'), std::string::npos) << text;
        if (error != "accepted") ++refused;
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace darkroom::scene
