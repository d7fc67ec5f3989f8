// SPDX-License-Identifier: MIT
// What a scene's camera says of its lens, for effects that are told where one is focused.
#include <gtest/gtest.h>

#include <bit>
#include <darkroom/effect.hpp>
#include <darkroom/look.hpp>
#include <filesystem>
#include <fstream>

#include "looks/look_parts.hpp"

namespace darkroom {
namespace {

const std::string camera = "[camera]\naperture = 4\nfocus = 2.5\nsensor_height = 8\n";

class LookCameraLens : public testing::Test {
  protected:
    void SetUp() override {
        if (find_effect("depth_of_field") == nullptr) GTEST_SKIP() << "the effect of this test is not in this build";
    }
    /// f-stop, focus and sensor height of the look.
    static std::array<float, 3> lens_of(Result<Look> look) {
        EXPECT_TRUE(look) << look.error().text;
        const LookEntry* const entry = look ? find_entry(*look, "depth_of_field") : nullptr;
        EXPECT_NE(entry, nullptr);
        std::array<float, 3> out{};
        constexpr std::array names{"f_stop", "focus_distance", "sensor_height"};
        for (std::size_t i = 0; i < names.size() && entry != nullptr; ++i)
            out[i] = std::bit_cast<float>(entry->words[entry->effect->parameters.find(names[i])->word]);
        return out;
    }
    static std::array<float, 3> lens_of_scene(const std::string& text) {
        return lens_of(parse_look(text, "a.scene.toml", {.is_scene = true}));
    }
    const std::array<float, 3> usual = lens_of(default_look());
};
using Lens = std::array<float, 3>;

TEST_F(LookCameraLens, StandsInForWhatTheSceneDoesNotWrite) {
    EXPECT_NE(usual, (Lens{4, 2.5f, 8}));
    EXPECT_EQ(lens_of_scene(camera), (Lens{4, 2.5f, 8}));
    for (const std::string order : {"", "order = \"scene_linear\"\n"}) {
        EXPECT_EQ(lens_of_scene(camera + "[post_process]\n" + order), (Lens{4, 2.5f, 8}));
        EXPECT_EQ(lens_of_scene(camera + "[post_process]\n" + order + "depth_of_field_focus_distance = 5\n"),
                  (Lens{4, 5, 8}));
    }
    EXPECT_EQ(lens_of_scene("[camera]\nfocus = 3\n[post_process]\n"), (Lens{usual[0], 3, usual[2]}));
}

TEST_F(LookCameraLens, OfAStackEachEntryHasWhatItDoesNotWrite) {
    const std::string entry = "[[stack]]\neffect = \"depth_of_field\"\n";
    EXPECT_EQ(lens_of_scene(camera + entry), (Lens{4, 2.5f, 8}));
    EXPECT_EQ(lens_of_scene(camera + entry + "f_stop = 2.8\n" + entry + "focus_distance = 7\n"), (Lens{2.8f, 2.5f, 8}));
}

TEST_F(LookCameraLens, OfALookAloneThereIsNone) {
    std::vector<std::string> warnings;
    EXPECT_EQ(
        lens_of(parse_look(camera + "[post_process]\norder = \"scene_linear\"\n", "a.toml", {.warnings = &warnings})),
        usual);
    EXPECT_EQ(warnings, std::vector<std::string>{"a.toml:1:2: unknown key 'camera'"});
}

TEST_F(LookCameraLens, WhatIsNotAllowedIsForTheReaderOfScenes) {
    std::vector<std::string> warnings;
    for (const std::string wrong : {"focus = 0", "focus = \"near\"", "focus = nan", "focus = 1e300", "aperture = 65",
                                    "sensor_height = -3", "sensor_height = [1]"})
        EXPECT_EQ(lens_of(parse_look("[camera]\n" + wrong + "\n[post_process]\norder = \"scene_linear\"\n", "a.toml",
                                     {.warnings = &warnings, .is_scene = true})),
                  usual)
            << wrong;
    EXPECT_TRUE(lens_of_scene("camera = 3\n") == usual);
    EXPECT_TRUE(warnings.empty());
}

TEST_F(LookCameraLens, TheCameraThatALookIsForGoesBeforeThatOfAScene) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "darkroom_camera_lens";
    std::filesystem::create_directories(folder);
    const auto file = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return folder / name;
    };
    const std::string look = "[post_process]\norder = \"scene_linear\"\ndepth_of_field_f_stop = 1.4\n";
    EXPECT_EQ(lens_of(read_look(file("a.toml", look), {}, {.aperture = 4.0f, .focus = 2.5f})),
              (Lens{1.4f, 2.5f, usual[2]}));
    EXPECT_EQ(lens_of(read_look(file("a.scene.toml", camera + look), {.is_scene = true}, {.focus = 9.0f})),
              (Lens{1.4f, 9, 8}));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace darkroom
