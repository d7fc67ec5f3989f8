// SPDX-License-Identifier: MIT
// Files that scenes, prefabs and models name: anywhere, or of their own folders alone with --own-files. One rule for
// all.
#include "image/picture/write.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliNamed : public test::CliFixture {
  protected:
    void make_files() override {
        namespace fs = std::filesystem;
        for (const char* const folder : {"own", "own/textures", "own/near", "far", "models"})
            fs::create_directory(path(folder));
        ASSERT_TRUE(write_picture(path("far/red.png"), Picture(2, 2)));
        fs::copy_file(path("far/red.png"), path("own/near/red.png"));
        fs::create_directory_symlink(path("far"), path("own/link"));
        write("far/a.bin", std::string(36, '\0'));
        fs::copy_file(path("far/a.bin"), path("own/near/a.bin"));
        write("far/lamp.toml", "[entities.lamp]\nbounds = { min = [0, 0, 0], max = [1, 1, 1] }\n");
        fs::copy_file(path("far/lamp.toml"), path("own/near/lamp.toml"));
    }
    /// Of a name in a scene, in a prefab's place, and in a model: what is said with the flag and without.
    void expect_read(const std::string& folder, bool is_own) const {
        const std::string place = "'" + folder + "/red.png': leaves the folder of the scene";
        const std::string box = "bounds = { min = [0, 0, 0], max = [1, 1, 1] }\n";
        const std::string scene =
            write("own/a.scene.toml",
                  "[entities.a]\n" + box + "[entities.a.material]\ntexture = \"" + folder + "/red.png\"\n");
        const std::string prefab = write("own/b.scene.toml", "[prefabs.a]\ntemplate = \"" + folder + "/lamp.toml\"\n");
        const std::string model = write(
            "own/a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"" + folder +
                              "/a.bin\",\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                              "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                              "\"min\":[0,0,0],\"max\":[0,0,0]}],"
                              "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                              "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}");
        for (const bool is_strict : {false, true}) {
            const auto drawn = [&](const std::string& file) {
                std::vector<std::string> typed{"render", file, "--size", "8x8", "-q", "-o", path("out.png")};
                if (is_strict) typed.emplace_back("--own-files");
                return run(typed);
            };
            const bool is_read = is_own || !is_strict;
            const Outcome of_scene = drawn(scene), of_prefab = drawn(prefab), of_model = drawn(model);
            EXPECT_EQ(of_scene.code, 0) << of_scene.err;
            EXPECT_EQ(of_scene.err.find(place) == std::string::npos, is_read) << folder << ": " << of_scene.err;
            EXPECT_EQ(of_prefab.code, is_read ? 0 : 1) << folder << ": " << of_prefab.err;
            EXPECT_EQ(of_prefab.err.find("leaves the folder of the scene") == std::string::npos, is_read)
                << of_prefab.err;
            EXPECT_EQ(of_model.code, is_read ? 0 : 1) << folder << ": " << of_model.err;
            EXPECT_EQ(of_model.err.find("leaves the folder of the model") == std::string::npos, is_read)
                << of_model.err;
            std::vector<std::string> told{"info", model, scene};
            if (is_strict) told.emplace_back("--own-files");
            EXPECT_EQ(run(told).code, is_read ? 0 : 1);
        }
    }
};

TEST_F(CliNamed, OfTheirOwnFolders) { expect_read("near", true); }
TEST_F(CliNamed, OfAFolderThatIsALink) { expect_read("link", false); }
TEST_F(CliNamed, OfTheFolderAbove) { expect_read("../far", false); }
TEST_F(CliNamed, OfAnywhere) { expect_read(path("far"), false); }

TEST_F(CliNamed, OfTheFoldersWhereTheyAreLookedFor) {
    std::filesystem::create_directory(path("textures"));
    std::filesystem::copy_file(path("far/red.png"), path("textures/blue.png"));
    const std::string scene = write("own/a.scene.toml",
                                    "[entities.a]\nbounds = { min = [0, 0, 0], max = [1, 1, 1] }\n"
                                    "[entities.a.material]\ntexture = \"blue.png\"\n");
    const Outcome outcome = run({"render", scene, "--size", "8x8", "-q", "--own-files", "-o", path("out.png")});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace darkroom
