// SPDX-License-Identifier: MIT
#include "scene/assets.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "image/frame/frame_file.hpp"
#include "image/test_files.hpp"
#include "scene/gltf/test_model.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {
namespace {

namespace fs = std::filesystem;

class SceneAssets : public WithFolder {
  protected:
    static Entity with_model(const char* name, const char* asset) {
        Entity entity{.name = name};
        entity.model = ModelReference{.asset = asset};
        return entity;
    }
    void put_model(const fs::path& path) {
        fs::create_directories(path.parent_path());
        TestModel test;
        test.add_triangle();
        put(path, test.text());
    }
    static bool has_warning(const Assets& assets, const std::string& text) {
        return std::ranges::any_of(assets.warnings, [&](const std::string& line) { return line.ends_with(text); });
    }
};

TEST_F(SceneAssets, ModelsAreFoundAndLoadedOnce) {
    const fs::path folder = file("scenes");
    put_model(folder / "models/near.gltf");
    put_model(file("models/far.gltf"));
    put_model(folder / "own.gltf");
    Scene scene{.folder = folder};
    scene.entities = {with_model("a", "near"), with_model("b", "far"),  with_model("c", "own.gltf"),
                      with_model("d", "near"), with_model("e", "none"), Entity{.name = "f"}};
    const Assets assets = load_assets(scene);
    ASSERT_EQ(assets.entities.size(), 6u);
    ASSERT_EQ(assets.models.size(), 3u);
    EXPECT_EQ(assets.entities[0].model, 0u);
    EXPECT_EQ(assets.entities[1].model, 1u);
    EXPECT_EQ(assets.entities[2].model, 2u);
    EXPECT_EQ(assets.entities[3].model, 0u);
    EXPECT_EQ(assets.entities[4].model, no_index);
    EXPECT_EQ(assets.entities[5].model, no_index);
    EXPECT_EQ(assets.models[1].name, "far");
    EXPECT_TRUE(has_warning(assets, "entity 'e' asks for 'none': there is no such file"));
}

TEST_F(SceneAssets, AFigureStandsByItsJointsAloneWhereTheSceneSaysSo) {
    TestModel test;
    test.add_figure();
    put(file("figure.gltf"), test.text());
    const auto shown = [&](const char* keys, std::string& notice) {
        const std::string text = std::string("[scene]\n") + keys +
                                 "\n[entities.a.model]\nasset = \"figure.gltf\"\n[entities.a.transform]\n"
                                 "position = [5, 1, 0]\nscale = [0.02, 0.02, 0.02]\n";
        const auto scene = parse_scene(text, file("a.toml"));
        EXPECT_TRUE(scene) << scene.error().text;
        const Assets assets = load_assets(*scene);
        notice.clear();
        for (const std::string& warning : assets.warnings)
            if (warning.find("skins") != std::string::npos) notice += warning;
        return scene_bounds(snapshot(*scene, assets, {})).size();
    };
    std::string notice;
    const vec3 by_all = shown("", notice);
    EXPECT_NEAR(by_all.y, 0.004F, 1e-6F);  // it lies, as high as it is deep
    EXPECT_NEAR(by_all.z, 0.036F, 1e-6F);
    EXPECT_EQ(notice, "");
    EXPECT_NEAR(shown("skins = \"joints_only\"", notice).y, 3.6F, 1e-4F);
    EXPECT_EQ(notice, "");
    EXPECT_NEAR(shown("version = \"1.0\"", notice).y, 3.6F, 1e-4F);
    EXPECT_TRUE(
        notice.ends_with("entities.a.model: the figure is 3.6 m high by its joints alone, for which scenes of "
                         "this style are placed; skins = \"all_nodes\" in [scene] makes it 0.004 m"))
        << notice;
    EXPECT_NEAR(shown("version = \"1.0\"\nskins = \"all_nodes\"", notice).z, 0.036F, 1e-6F);
    EXPECT_EQ(notice, "");
}

TEST_F(SceneAssets, ABrokenModelIsReportedAndTheRestLoads) {
    put(file("bad.gltf"), "{");
    put_model(file("good.gltf"));
    Scene scene{.folder = folder_};
    scene.entities = {with_model("a", "bad.gltf"), with_model("b", "good.gltf")};
    const Assets assets = load_assets(scene);
    EXPECT_EQ(assets.entities[0].model, no_index);
    ASSERT_NE(assets.entities[1].model, no_index);
    EXPECT_EQ(assets.models[assets.entities[1].model].meshes.size(), 1u);
    const bool is_reported = std::any_of(assets.warnings.begin(), assets.warnings.end(), [](const std::string& text) {
        return text.find("bad.gltf: ") != std::string::npos && text.ends_with("(asked for by entity 'a')");
    });
    EXPECT_TRUE(is_reported);
}

TEST_F(SceneAssets, TexturesAndSkybox) {
    Picture picture(4, 2);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = i % 4 == 3 ? 1.0F : 0.5F;
    fs::create_directories(file("scenes/textures"));
    fs::create_directories(file("textures"));
    ASSERT_TRUE(write_frame(file("scenes/sky.exr"), {.color = picture}));
    ASSERT_TRUE(write_frame(file("scenes/textures/wall.exr"), {.color = picture}));
    ASSERT_TRUE(write_frame(file("textures/spark.exr"), {.color = picture}));
    Scene scene{.folder = file("scenes")};
    scene.environment.skybox = "sky.exr";
    Entity entity{.name = "thing"};
    entity.material = Material{.texture = "wall.exr"};
    entity.sprite = Sprite{.texture = "textures/wall.exr"};
    entity.emitter = ParticleEmitter{.texture = "spark.exr"};
    Entity other{.name = "other"};
    other.sprite = Sprite{.texture = "gone.png"};
    scene.entities = {entity, other};
    const Assets assets = load_assets(scene);
    ASSERT_TRUE(assets.skybox);
    EXPECT_EQ(assets.skybox->width, 4u);
    EXPECT_FLOAT_EQ(*assets.skybox->at(1, 1), 0.5F);
    ASSERT_EQ(assets.images.size(), 2u);
    EXPECT_EQ(assets.entities[0].material_texture, 0u);
    EXPECT_EQ(assets.entities[0].sprite_texture, 0u);
    EXPECT_EQ(assets.entities[0].particle_texture, 1u);
    EXPECT_EQ(assets.entities[1].sprite_texture, no_index);
    EXPECT_TRUE(has_warning(assets, "entity 'other' asks for 'gone.png': there is no such file"));
    EXPECT_EQ(assets.images[0].kind, ImageKind::Halves);
    EXPECT_EQ(glm::unpackHalf1x16(assets.images[0].wide.at(0)), 0.5F);
    EXPECT_EQ(glm::unpackHalf1x16(assets.images[0].wide.at(3)), 1);
}

TEST_F(SceneAssets, FloatsKeepWhatIsBrighterThanWhite) {
    Picture picture(2, 1);
    picture.pixels = {12, 0.5005F, -1, 1, 1e9F, 0, 1, 2};
    ASSERT_TRUE(write_frame(file("lamp.exr"), {.color = picture}));
    const auto image = read_image(file("lamp.exr"));
    ASSERT_TRUE(image) << image.error().text;
    std::vector<float> values;
    for (const std::uint16_t half : image->wide) values.push_back(glm::unpackHalf1x16(half));
    EXPECT_EQ(values, (std::vector<float>{12, 0.50048828125F, 0, 1, 65504, 0, 1, 1}));
}

TEST_F(SceneAssets, BrokenImagesSayWhatAndWhere) {
    put(file("text.png"), "no picture");
    const auto image = read_image(file("text.png"));
    ASSERT_FALSE(image);
    EXPECT_TRUE(image.error().text.starts_with(file("text.png").string() + ": ")) << image.error().text;
    EXPECT_EQ(image.error().text.find(file("text.png").string(), 1), std::string::npos) << image.error().text;
    EXPECT_FALSE(read_image(file("none.png")));
    const auto bytes = decode_image({}, "nothing");
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().text, "nothing: is empty");
}

}  // namespace
}  // namespace darkroom::scene
