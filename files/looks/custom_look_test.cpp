// SPDX-License-Identifier: MIT
// Looks that name the files of effects.
#include <gtest/gtest.h>

#include <algorithm>
#include <darkroom/custom_effect.hpp>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <filesystem>
#include <fstream>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view tint =
    "// @effect tint: Tints.\n// @accepts display_linear\n// @param float amount = 0.5 in [0, 1] amount: How much.\n"
    "// @param choice mode = warm | cold: Which.\n"
    "vec4 tint(vec4 color, Pixel pixel, Tint parameters) { return color; }\n";

class CustomLook : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "darkroom_custom_look_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        write("tint.glsl", tint);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, std::string_view text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    [[nodiscard]] Result<Look> read(const std::string& text, bool is_strict = true) const {
        return read_look(write("a.toml", text), {.is_strict = is_strict, .allows_custom_effects = true});
    }
    [[nodiscard]] Look look_of(const std::string& text) const {
        Result<Look> look = read(text);
        EXPECT_TRUE(look) << look.error().text;
        return look ? std::move(*look) : Look{};
    }
    /// Without the folder's name.
    [[nodiscard]] std::string error_of(const std::string& text) const {
        const Result<Look> look = read(text);
        if (look) return "accepted";
        std::string error = look.error().text;
        for (std::size_t at = error.find(folder_.string()); at != std::string::npos; at = error.find(folder_.string()))
            error.erase(at, folder_.string().size() + 1);
        return error;
    }
    [[nodiscard]] LookEntry entry_of_text(std::string_view text) const {
        Result<LookEntry> entry = custom_entry(write("placed.glsl", text));
        EXPECT_TRUE(entry) << entry.error().text;
        return entry ? std::move(*entry) : LookEntry{};
    }

    fs::path folder_;
};

const std::string tint_entry = "[[stack]]\neffect = \"tint.glsl\"\n";

TEST_F(CustomLook, NamesAFileBesideIt) {
    Look look = look_of(tint_entry + "amount = 0.25\n" + tint_entry + "mode = \"cold\"\nname = \"second_one\"\n");
    ASSERT_EQ(look.entries.size(), 2u);
    EXPECT_EQ(entry_names(look), (std::vector<std::string>{"tint", "second_one"}));
    EXPECT_EQ(look.entries[0].effect, look.entries[1].effect) << "a file is one effect";
    EXPECT_EQ(format(*look.entries[0].effect->parameters.find("amount"), look.entries[0].words), "0.25");
    // It lives in the entry, whatever becomes of the file and of the look it was read by.
    fs::remove(folder_ / "tint.glsl");
    const LookEntry kept = look.entries[1];
    look = {};
    EXPECT_EQ(kept.effect->name, "tint");
    EXPECT_EQ(format(*kept.effect->parameters.find("mode"), kept.words), "\"cold\"");
}

TEST_F(CustomLook, SurvivesWriting) {
    write("a \"b\"/tint.glsl", tint);
    for (const std::string& text :
         {tint_entry + "amount = 0.25\nopacity = 0.5\n", "[[stack]]\neffect = 'a \"b\"/tint.glsl'\n" + tint_entry}) {
        const Look look = look_of(text);
        const std::string written = write_look(look);
        const Look again = look_of(written);
        EXPECT_EQ(write_look(again), written);
        ASSERT_EQ(again.entries.size(), look.entries.size());
        for (std::size_t i = 0; i < look.entries.size(); ++i) {
            EXPECT_EQ(again.entries[i].effect_file, look.entries[i].effect_file);
            EXPECT_EQ(again.entries[i].words, look.entries[i].words);
        }
    }
}

TEST_F(CustomLook, IsRefusedUnlessTheHostAllowsIt) {
    const Result<Look> look = read_look(write("a.toml", tint_entry));
    ASSERT_FALSE(look);
    EXPECT_TRUE(look.error().text.ends_with(
        "a.toml:2:10: effect = \"tint.glsl\": the effect of a file is code, which is not allowed for this look"))
        << look.error().text;
}

TEST_F(CustomLook, ErrorsAreThoseOfOtherEffects) {
    EXPECT_EQ(error_of("[[stack]]\neffect = \"absent.glsl\"\n"),
              "a.toml:2:10: effect = \"absent.glsl\": absent.glsl: there is no such file");
    write("broken.glsl", "// @effect broken: Broken.\n// @needs money\n");
    EXPECT_EQ(
        error_of("[[stack]]\neffect = \"broken.glsl\"\n"),
        "a.toml:2:10: effect = \"broken.glsl\": broken.glsl:2: @needs money: allowed is depth, normals, velocity, "
        "shadows, ui, reactive, transparency, exposure, second");
    EXPECT_EQ(error_of(tint_entry + "amont = 1\n"),
              "a.toml:3:1: unknown key 'amont' = 1, did you mean 'amount', which takes "
              "[0, 1]?");
    EXPECT_EQ(error_of(tint_entry + "amount = 2\n"), "a.toml:3:10: amount = 2: allowed is [0, 1]");
    EXPECT_EQ(error_of(tint_entry + "mode = \"hot\"\n").find("a.toml:3:8: mode = \"hot\""), 0u);
    write("folder.glsl/x", "");
    EXPECT_EQ(error_of("[[stack]]\neffect = \"folder.glsl\"\n"),
              "a.toml:2:10: effect = \"folder.glsl\": folder.glsl: is a folder, a file is needed");
}

TEST_F(CustomLook, ANameIsThatOfOneEffect) {
    write("copy.glsl", tint);
    EXPECT_EQ(look_of(tint_entry + "[[stack]]\neffect = \"copy.glsl\"\n").entries[1].effect_file, "copy.glsl");
    std::string other(tint);
    other.replace(other.find("0.5"), 3, "0.6");
    write("other.glsl", other);
    EXPECT_EQ(error_of(tint_entry + "[[stack]]\neffect = \"other.glsl\"\n"),
              "a.toml:4:10: effect = \"other.glsl\": its effect 'tint' has the name of another, that of tint.glsl");
}

TEST_F(CustomLook, KeysOfAnEntryAreNoParameters) {
    std::vector<std::string_view> keys{"effect"};
    for (const WireInfo& wire : wires) keys.push_back(wire.key);
    for (const ParamInfo& row : entry_rows.rows) keys.push_back(row.name);
    for (const std::string_view key : keys) {
        const auto effect = CustomEffect::parse(
            "// @effect mine: Mine.\n// @param toggle " + std::string(key) + " = on: A.\nmine(", "my.glsl");
        ASSERT_FALSE(effect) << key;
        EXPECT_TRUE(effect.error().text.starts_with("my.glsl:2: " + std::string(key) + ": a key"))
            << effect.error().text;
    }
}

TEST_F(CustomLook, OverridesReachItsParameters) {
    Look look = look_of(tint_entry + tint_entry);
    ASSERT_TRUE(override_look(
        look, std::array{LookOverride{"tint_amount", "0.75", ""}, LookOverride{"tint#2.mode", "cold", ""}}));
    EXPECT_EQ(format(*look.entries[0].effect->parameters.find("amount"), look.entries[0].words), "0.75");
    EXPECT_EQ(format(*look.entries[1].effect->parameters.find("mode"), look.entries[1].words), "\"cold\"");
    const Result<> off = override_look(look, std::array{LookOverride{"tint_amount", "0", ""}});
    ASSERT_TRUE(off);
    EXPECT_FALSE(look.entries[0].state.enabled.on);
    const Result<> wrong = override_look(look, std::array{LookOverride{"tint_amont", "0", "--tint-amont"}});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().text, "--tint-amont: no effect has this parameter, did you mean 'tint_amount'?");
}

TEST_F(CustomLook, APlaceIsWhereTheEffectIsMeantFor) {
    for (const char* const name : {"tonemap", "encode", "vignette", "dither"})
        if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
    const auto names_with = [&](const std::string& domains, Look look) {
        std::string text(tint);
        text.replace(text.find("display_linear"), 14, domains);
        const Result<> placed = place_entry(look, entry_of_text(text));
        EXPECT_TRUE(placed) << placed.error().text;
        EXPECT_FALSE(look.is_flat);
        return entry_names(look);
    };
    const auto place_of = [](const std::vector<std::string>& names, std::string_view name) {
        return std::ranges::find(names, name) - names.begin();
    };
    const std::vector<std::string> shown = names_with("display_linear", default_look());
    EXPECT_EQ(place_of(shown, "tint"), place_of(shown, "encode") - 1);
    EXPECT_EQ(std::ranges::count(shown, "vignette"), 0) << "it is off";
    const std::vector<std::string> scene = names_with("scene_linear", default_look());
    EXPECT_EQ(place_of(scene, "tint"), place_of(scene, "tonemap") - 1);
    EXPECT_EQ(names_with("encoded", default_look()).back(), "tint");
    Look stack;
    stack.is_flat = false;
    EXPECT_EQ(names_with("scene_linear", stack).front(), "tint");
    const Result<> nowhere = place_entry(stack, entry_of_text(tint));
    ASSERT_FALSE(nowhere);
    EXPECT_TRUE(nowhere.error().text.ends_with("tint accepts display_linear, but no place of  has such a picture"))
        << nowhere.error().text;
}

TEST_F(CustomLook, TheFlatTableStandsForItsStack) {
    Look flat = default_look(), stack = default_look(LookOrder::Documented);
    ASSERT_TRUE(place_entry(stack, entry_of_text("// @effect last: Last.\nlast(\n")));
    stack.entries.pop_back();
    for (const LookEntry& kept : stack.entries) EXPECT_EQ(kept.source, "scene");
    stack = flat;
    ASSERT_TRUE(place_entry(stack, entry_of_text("// @effect last: Last.\nlast(\n")));
    stack.entries.pop_back();
    for (const LookEntry& kept : stack.entries) EXPECT_EQ(kept.source, "") << "bloom reads the picture at its place";
    std::vector<std::string_view> expected, actual;
    for (const LookEntry* const kept : ordered(flat))
        if (kept->state.enabled.on != 0) expected.push_back(kept->effect->name);
    for (const LookEntry& kept : stack.entries) actual.push_back(kept.effect->name);
    EXPECT_EQ(actual, expected);
}

}  // namespace
}  // namespace darkroom
