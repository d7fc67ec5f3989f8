// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <string>

#include "core/text/param_text.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class LookLayers : public WithFolder {
  protected:
    std::filesystem::path file(const std::string& name, const std::string& text) {
        put(folder_ / name, text);
        return folder_ / name;
    }
    static Look look_of(std::string_view text) {
        Result<Look> look = parse_look(text, "base.toml", {.is_strict = true});
        EXPECT_TRUE(look) << look.error().text;
        return look ? *look : Look{};
    }
    static std::string value_of(Look& look, std::string_view entry, std::string_view name) {
        const LookEntry* const found = find_entry(look, entry);
        return found == nullptr ? "no entry" : format(*found->effect->parameters.find(name), found->words);
    }
    std::string error_over(Look look, const std::string& text) {
        const Result<> done = lay_over(look, file("layer.toml", text));
        return done ? "accepted" : done.error().text;
    }
};

TEST_F(LookLayers, LayWhatTheyWriteAndLeaveTheRest) {
    Look look = look_of("[post_process]\nbloom_intensity = 0.2\nvignette_intensity = 0.6\nfog_density = 0.1\n");
    Look expected = look_of(
        "[post_process]\nbloom_intensity = 0.2\nvignette_intensity = 0.3\nfog_density = 0\nperturb_amount = 2\n"
        "perturb_speed = [1, 2]\n");
    // Also what is the default: 0.3.
    ASSERT_TRUE(lay_over(look, file("a.toml",
                                    "[post_process]\norder = \"scene_linear\"\nvignette_intensity = 0.3\n"
                                    "fog_density = 0\nperturb_amount = 2\nperturb_speed = [1, 2]\n")));
    EXPECT_EQ(write_look(look), write_look(expected));
}

TEST_F(LookLayers, AreLaidInTheirOrder) {
    Look look = look_of("");
    ASSERT_TRUE(lay_over(look, file("a.toml", "[post_process]\nexposure = 2\nvignette_enabled = true\n")));
    ASSERT_TRUE(lay_over(look, file("b.toml", "[post_process]\nexposure = 3\nvignette_enabled = false\n")));
    EXPECT_EQ(value_of(look, "exposure", "exposure"), "3.0");
    EXPECT_FALSE(find_entry(look, "vignette")->state.enabled.on);
}

TEST_F(LookLayers, GiveAStackWhatItLacks) {
    Look look =
        look_of("[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    ASSERT_TRUE(lay_over(look, file("a.toml", "[post_process]\nexposure = 2\nbloom_intensity = 0.3\n")));
    EXPECT_EQ(entry_names(look), (std::vector<std::string>{"exposure", "bloom", "tonemap", "encode"}));
    EXPECT_EQ(value_of(look, "exposure", "exposure"), "2.0");
    EXPECT_EQ(value_of(look, "bloom", "intensity"), "0.3");
    EXPECT_TRUE(find_entry(look, "bloom")->state.enabled.on);
}

TEST_F(LookLayers, BringTheirTables) {
    file("half.cube", "LUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n");
    Look look = look_of("");
    ASSERT_TRUE(lay_over(look, file("a.toml", "[post_process]\nlut = \"half.cube\"\n")));
    const LookEntry& lut = *find_entry(look, "lut");
    EXPECT_TRUE(lut.state.enabled.on);
    ASSERT_EQ(lut.resources.size(), 1u);
    EXPECT_EQ(lut.resources[0].file, (folder_ / "half.cube").string());
}

TEST_F(LookLayers, AreRefusedWhereTheySayNothingOrTooMuch) {
    for (const char* const text :
         {"", "[post_process]\n", "[[stack]]\neffect = \"encode\"\n", "[post_process]\nexposure = 2\n[ui]\n"}) {
        EXPECT_NE(error_over(look_of(""), text)
                      .find("layer.toml: a look that is laid over another has values in [post_process], and no [ui]"),
                  std::string::npos)
            << text;
    }
    EXPECT_NE(error_over(look_of("[post_process]\nfog_end = 50\n"), "[post_process]\nfog_start = 60\n")
                  .find("layer.toml: over base.toml: fog: end = 50"),
              std::string::npos);
}

}  // namespace
}  // namespace darkroom
