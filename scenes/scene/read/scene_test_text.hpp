// SPDX-License-Identifier: MIT
#pragma once
// What tests of scene files share: reading a text that is meant to be right, and files in a folder of their own.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "scene/scene.hpp"

namespace darkroom::scene {

inline Scene scene_of(std::string_view text, bool is_strict = true) {
    Result<Scene> scene = parse_scene(text, "demos/a.scene.toml", {.is_strict = is_strict});
    EXPECT_TRUE(scene) << scene.error().text;
    return scene ? *scene : Scene{};
}
inline Entity entity_of(std::string_view text, bool is_strict = true) {
    const Scene scene = scene_of(text, is_strict);
    EXPECT_FALSE(scene.entities.empty());
    return scene.entities.empty() ? Entity{} : scene.entities.front();
}
inline std::vector<std::string> names_of(const Scene& scene) {
    std::vector<std::string> out;
    for (const Entity& entity : scene.entities) out.push_back(entity.name);
    return out;
}
inline void expect_near(vec3 value, vec3 truth, float tolerance = 1e-6F) {
    EXPECT_LE(glm::length(value - truth), tolerance) << value.x << ' ' << value.y << ' ' << value.z;
}

using Names = std::vector<std::string>;

class TemporaryFolder {
  public:
    TemporaryFolder() {
        const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::path(::testing::TempDir()) /
                (std::string("darkroom_") + test->test_suite_name() + "_" + test->name());
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path write(const std::string& name, std::string_view text) const {
        const std::filesystem::path path = path_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }

  private:
    std::filesystem::path path_;
};

}  // namespace darkroom::scene
