// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "core/text/param_text.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

// Warnings, or the error, of a text.
std::vector<std::string> warnings_of(std::string_view text) {
    std::vector<std::string> warnings;
    const Result<Look> look = parse_look(text, "a.toml", {.warnings = &warnings});
    EXPECT_TRUE(look) << look.error().text;
    return warnings;
}
std::string error_of(std::string_view text, bool is_strict = false) {
    const Result<Look> look = parse_look(text, "a.toml", {.is_strict = is_strict});
    return look ? "accepted" : look.error().text;
}
Look look_of(std::string_view text) {
    Result<Look> look = parse_look(text, "a.toml", {.is_strict = true});
    EXPECT_TRUE(look) << look.error().text;
    return look ? *look : Look{};
}
std::string value_of(Look& look, std::string_view entry, std::string_view name) {
    const LookEntry* const found = find_entry(look, entry);
    if (found == nullptr) return "no entry";
    const ParamInfo* const row = found->effect->parameters.find(name);
    return row == nullptr ? "no parameter" : format(*row, found->words);
}
/// Tests that name effects are skipped in a tree without them.
bool lacks(std::initializer_list<const char*> effects) {
    return std::any_of(effects.begin(), effects.end(), [](const char* name) { return find_effect(name) == nullptr; });
}
bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

TEST(Look, EmptyTableIsTheDefaults) {
    for (const auto& [text, order] : {std::pair("", LookOrder::SceneLinear),
                                      {"format = 1\n", LookOrder::SceneLinear},
                                      {"[post_process]\n", LookOrder::Documented},
                                      {"[post_process]\norder = \"documented\"\n", LookOrder::Documented},
                                      {"[post_process]\norder = \"scene_linear\"\n", LookOrder::SceneLinear}}) {
        EXPECT_EQ(write_look(look_of(text)), write_look(default_look(order))) << text;
        EXPECT_TRUE(warnings_of(text).empty());
    }
}

// What scenes that say nothing were made with.
TEST(Look, DefaultsAreThePublishedOnes) {
    Look look = look_of("[post_process]\n");
    const std::map<std::string, std::map<std::string, std::string>> published{
        {"bloom", {{"intensity", "0.04"}, {"threshold", "1.0"}, {"soft_threshold", "0.5"}}},
        {"chromatic_aberration", {{"chromatic_aberration", "0.0"}}},
        {"dither", {{"intensity", "0.03"}}},
        {"exposure", {{"exposure", "1.0"}}},
        {"fog",
         {{"color", "[0.7, 0.75, 0.82]"},
          {"density", "0.02"},
          {"start", "5.0"},
          {"end", "100.0"},
          {"height_enabled", "false"},
          {"height_falloff", "0.1"},
          {"height_origin", "0.0"}}},
        {"radial_blur", {{"radial_blur", "0.0"}}},
        {"fxaa", {}},
        {"ssao", {{"radius", "0.5"}, {"intensity", "1.0"}, {"bias", "0.025"}, {"method", "\"hemisphere\""}}},
        {"vignette", {{"intensity", "0.3"}, {"smoothness", "2.0"}}},
        {"volumetric", {{"samples", "32"}, {"density", "1.0"}, {"max_distance", "100.0"}, {"decay", "0.98"}}}};
    const std::set<std::string> on{"bloom", "chromatic_aberration", "exposure", "radial_blur", "ssao"};
    for (const auto& [effect, values] : published) {
        if (lacks({effect.c_str()})) continue;
        EXPECT_EQ(find_entry(look, effect)->state.enabled.on != 0, on.contains(effect)) << effect;
        for (const auto& [name, value] : values)
            EXPECT_EQ(value_of(look, effect, name), value) << effect << ' ' << name;
    }
}

TEST(Look, AnotherOrderBringsItsOwnDefaultsAndKeepsWhatWasSaid) {
    if (lacks({"ssao", "dither"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = look_of("[post_process]\nssao_radius = 2\n");
    set_order(look, LookOrder::SceneLinear);
    EXPECT_EQ(value_of(look, "ssao", "method"), "\"ground_truth\"");
    EXPECT_EQ(value_of(look, "ssao", "radius"), "2.0");
    EXPECT_TRUE(find_entry(look, "dither")->state.enabled.on);
    set_order(look, LookOrder::Documented);
    EXPECT_EQ(write_look(look), write_look(look_of("[post_process]\nssao_radius = 2\n")));
}

TEST(Look, ReadsTheFlatTable) {
    if (lacks({"bloom", "vignette", "exposure"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = look_of(
        "[post_process]\nbloom_intensity = 2\nexposure = 1.25\nvignette_enabled = true\n"
        "order = \"scene_linear\"\nbloom_threshold = 0.5\nbloom_enabled = false\n");
    EXPECT_EQ(value_of(look, "bloom", "intensity"), "2.0");
    EXPECT_EQ(value_of(look, "exposure", "exposure"), "1.25");
    EXPECT_TRUE(find_entry(look, "vignette")->state.enabled.on);
    EXPECT_FALSE(find_entry(look, "bloom")->state.enabled.on) << "a toggle counts, whatever the amount implies";
    EXPECT_EQ(look.order, LookOrder::SceneLinear);
}

TEST(Look, FormerKeysAreStillRead) {
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows) {
            if (row.formerly.empty() || effect->flat.documented < 0) continue;
            const std::string key = flat_key(effect->name, row.formerly);
            EXPECT_EQ(
                error_of("[post_process]\n" + key + " = " + format(row, effect->parameters.defaults) + "\n", true),
                "accepted");
        }
}

TEST(Look, AnAmountAboveZeroTurnsItsEffectOn) {
    if (lacks({"bloom", "dither"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look on = look_of("[post_process]\ndither_intensity = 0.03\n");
    EXPECT_TRUE(find_entry(on, "dither")->state.enabled.on);
    Look off = look_of("[post_process]\nbloom_intensity = 0\n");
    EXPECT_FALSE(find_entry(off, "bloom")->state.enabled.on);
}

TEST(Look, UnknownKeysAreWarnedOfAndStrictlyRefused) {
    if (lacks({"bloom"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    const std::string text = "[post_process]\nbloom_treshold = 2\n[not_a_section]\nx = 1\n";
    const std::vector<std::string> warnings = warnings_of(text);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_TRUE(warnings[0].starts_with(
        "a.toml:2:1: unknown key 'bloom_treshold' = 2, did you mean 'bloom_threshold', which takes ["))
        << warnings[0];
    EXPECT_TRUE(contains(warnings[1], "unknown key 'not_a_section'")) << warnings[1];
    EXPECT_TRUE(contains(error_of(text, true), "bloom_threshold"));
    EXPECT_TRUE(contains(error_of(text, true), "not_a_section"));
    EXPECT_EQ(error_of("bloom_threshold = 2\n", true),
              "a.toml:1:1: unknown key 'bloom_threshold': it belongs below [post_process]");
    EXPECT_EQ(error_of("order = \"scene_linear\"\n", true),
              "a.toml:1:1: unknown key 'order': it belongs below [post_process]");
    EXPECT_EQ(error_of("tonemap = \"agx\"\n", true),
              "a.toml:1:1: unknown key 'tonemap', did you mean 'tonemap_curve' below [post_process]?");
    EXPECT_TRUE(
        error_of("[post_process]\ntonemap = \"agx\"\n", true)
            .starts_with("a.toml:2:1: unknown key 'tonemap' = \"agx\", did you mean 'tonemap_curve', which takes aces"))
        << error_of("[post_process]\ntonemap = \"agx\"\n", true);
    // To look a name up is slow, and a file may hold very many: only the first 256 slips, by their names, have it.
    std::string many = "vignette_intensity = 1\n";
    for (int i = 0; i < 300; ++i) many += fmt::format("nothing_{} = 1\n", i);
    const std::string told = error_of(many, true);
    EXPECT_TRUE(told.starts_with("a.toml:1:1: unknown key 'vignette_intensity'")) << told;
    EXPECT_FALSE(contains(told, "belongs below")) << told;
}

TEST(Look, ValuesOutOfRangeLeaveTheDefaultAndSaySo) {
    if (lacks({"bloom", "exposure"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    const std::vector<std::string> warnings = warnings_of("[post_process]\nbloom_intensity = -1\n");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with("a.toml:2:19: bloom_intensity = -1: allowed is [0, ")) << warnings[0];
    EXPECT_TRUE(warnings[0].ends_with("; 0.04 is used")) << warnings[0];
    EXPECT_TRUE(contains(error_of("[post_process]\nbloom_intensity = -1\n", true), "a.toml:2:19: "));
    EXPECT_TRUE(contains(error_of("[post_process]\nexposure = nan\n", true), "exposure = nan"));
}

TEST(Look, ConsoleVariablesOutOfRangeAreErrors) {
    if (lacks({"contrast_gamma", "ui_warp"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    for (const auto& [text, part] :
         {std::pair("[ui]\ncontrast_gamma_contrast = 3\n", "look:2:27: contrast_gamma_contrast = 3: allowed is [1, 2]"),
          {"[ui]\nui_warp_strength = -9\n", "look:2:20: ui_warp_strength = -9: allowed is [-4, 4]"},
          {"[[stack]]\neffect = \"contrast_gamma\"\ncontrast = 0.5\n",
           "look:3:12: contrast = 0.5: allowed is [1, 2]"}}) {
        const auto read = parse_look(text, "look");
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().text, part);
    }
}

TEST(Look, EveryWrongTypeIsListed) {
    if (lacks({"bloom", "exposure", "tonemap", "vignette"}))
        GTEST_SKIP() << "an effect that this test names is not in this build";
    const std::string error = error_of(
        "[post_process]\nenabled = \"yes\"\nexposure = \"1280\"\nbloom_threshold = [1.0, 2.0]\n"
        "tonemap_curve = 42\nvignette_enabled = 1979-05-27\norder = {}\n");
    for (const char* const part :
         {"a.toml:2:11: enabled = \"yes\": expected a boolean", "a.toml:3:12: exposure = \"1280\"",
          ":4:19: ", ":5:17: ", "vignette_enabled = a date or time", "order = a table"})
        EXPECT_TRUE(contains(error, part)) << part << " is not in " << error;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0);
}

TEST(Look, SyntaxErrorsNameTheLine) {
    EXPECT_TRUE(error_of("[post_process]\nexposure = 1\nexposure = 2\n").starts_with("a.toml:3:"))
        << error_of("a = 1\na = 2");
    EXPECT_TRUE(error_of("[post_process]\n[post_process]\n").starts_with("a.toml:2:"));
    const std::string error = error_of("[[stack]]\neffect = \"\xe9\xff\xfe\"\n");
    EXPECT_TRUE(error.starts_with("a.toml:2:")) << error;
    EXPECT_TRUE(contains(error, "UTF-8") || contains(error, "utf-8")) << error;
    EXPECT_TRUE(std::all_of(error.begin(), error.end(), [](char c) { return c >= 0x20 && c < 0x7f; })) << error;
}

TEST(Look, ControlBytesAreNotEchoed) {
    if (lacks({"bloom"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    for (const std::string& error :
         {error_of("\"a\\u001b[31m\" = 1\n", true), error_of("[[stack]]\neffect = \"\\u001bx\"\n"),
          error_of("\x1b[31m = 1"), error_of("[[stack]]\neffect='bloom'\nname = \"a\\nb\"\n")})
        EXPECT_TRUE(std::all_of(error.begin(), error.end(), [](char c) { return c >= 0x20 && c < 0x7f; })) << error;
}

TEST(Look, ReadsAStack) {
    if (lacks({"gaussian_blur", "negative", "blend"}))
        GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = look_of(
        "[[stack]]\neffect = \"gaussian_blur\"\nradius = 4\noutput = \"blurred\"\n"
        "[[stack]]\neffect = \"negative\"\nopacity = 0.5\nblend = \"screen\"\nenabled = false\n"
        "[[stack]]\neffect = \"blend\"\nsecond = \"blurred\"\ninput = \"scene\"\nname = \"mix\"\n"
        "[[stack]]\neffect = \"negative\"\n");
    ASSERT_EQ(look.entries.size(), 4u);
    EXPECT_FALSE(look.is_flat);
    EXPECT_EQ(look.entries[0].output, "blurred");
    EXPECT_EQ(look.entries[1].state.blend, BlendMode::Screen);
    EXPECT_EQ(look.entries[1].state.opacity, 0.5f);
    EXPECT_FALSE(look.entries[1].state.enabled.on);
    EXPECT_EQ(look.entries[2].second, "blurred");
    EXPECT_EQ(entry_names(look), (std::vector<std::string>{"gaussian_blur", "negative", "mix", "negative#2"}));
    EXPECT_EQ(find_entry(look, "negative#2"), &look.entries[3]);
    EXPECT_EQ(find_entry(look, "blend"), &look.entries[2]);
}

TEST(Look, StackErrorsNameBothEnds) {
    if (lacks({"gaussian_blur", "negative", "blend", "bloom"}))
        GTEST_SKIP() << "an effect that this test names is not in this build";
    const std::string blur = "[[stack]]\neffect = \"gaussian_blur\"\noutput = \"blurred\"\n";
    const std::string blend = "[[stack]]\neffect = \"blend\"\nsecond = \"blurred\"\n";
    EXPECT_EQ(error_of(blend + blur),
              "a.toml:3:10: second = \"blurred\" of stack entry 1 (blend): made only later, by stack entry 2 "
              "(gaussian_blur)");
    EXPECT_EQ(
        error_of(blur + blur),
        "a.toml:6:10: output 'blurred' is made by stack entry 1 (gaussian_blur) and by stack entry 2 (gaussian_blur)");
    EXPECT_EQ(error_of(blur + "[[stack]]\neffect = \"blend\"\nsecond = \"blured\"\n"),
              "a.toml:6:10: second = \"blured\" of stack entry 2 (blend): no entry has this output, did you mean "
              "'blurred'? known are scene, alpha, ui and blurred");
    EXPECT_TRUE(contains(error_of("[[stack]]\neffect = \"blom\"\n"), "did you mean 'bloom'?"));
    EXPECT_TRUE(contains(error_of("[[stack]]\nradius = 1\n"), "stack entry 1 has no key 'effect'"));
    EXPECT_TRUE(contains(error_of("stack = 1\n"), "expected [[stack]] entries"));
    EXPECT_TRUE(contains(error_of("stack = [1]\n"), "expected a table"));
    EXPECT_TRUE(contains(error_of("[post_process]\n[[stack]]\neffect = \"negative\"\n"), "one of them"));
    EXPECT_TRUE(contains(error_of("format = 2\n"), "this build reads format 1"));
    const std::string negative = "[[stack]]\neffect = \"negative\"\n";
    EXPECT_TRUE(
        contains(error_of(negative + "name = \"a\"\n" + negative + "name = \"a\"\n"), "is that of stack entry 1"));
    EXPECT_TRUE(contains(error_of(negative + "name = \"bloom\"\n"), "another effect"));
    EXPECT_TRUE(contains(error_of(negative + "output = \"scene\"\n"), "what frames bring"));
    EXPECT_TRUE(contains(error_of(negative + "name = \"a.b\"\n"), "expected a name"));
}

TEST(Look, SurvivesWriting) {
    if (lacks({"gaussian_blur", "blend", "bloom", "dither"}))
        GTEST_SKIP() << "an effect that this test names is not in this build";
    for (const char* const text :
         {"[post_process]\nbloom_intensity = 0.1\ndither_enabled = true\norder = \"scene_linear\"\nenabled = false\n",
          "[[stack]]\neffect = \"gaussian_blur\"\nradius = 3\noutput = \"b\"\nenabled = false\n[[stack]]\neffect = "
          "\"blend\"\n"
          "second = \"b\"\nmask = \"scene\"\nmode = \"screen\"\nopacity = 0.3\nblend = \"add\"\nname = \"n\"\n",
          "stack = []\n"}) {
        const Look look = look_of(text);
        const std::string written = write_look(look);
        const Look again = look_of(written);
        EXPECT_EQ(write_look(again), written);
        ASSERT_EQ(again.entries.size(), look.entries.size());
        EXPECT_EQ(again.is_flat, look.is_flat);
        EXPECT_EQ(again.is_enabled, look.is_enabled);
        EXPECT_EQ(again.order, look.order);
        for (const LookEntry& entry : look.entries) {
            const auto same = [&](const LookEntry& other) {
                return other.effect == entry.effect && other.words == entry.words &&
                       other.state.opacity == entry.state.opacity && other.state.enabled.on == entry.state.enabled.on &&
                       other.state.blend == entry.state.blend && other.name == entry.name &&
                       other.second == entry.second && other.mask == entry.mask && other.output == entry.output;
            };
            EXPECT_TRUE(std::any_of(again.entries.begin(), again.entries.end(), same)) << entry.effect->name;
        }
    }
}

constexpr std::string_view scene_text =
    "[scene]\nname = \"a\"\n[camera]\nfov = 80\n[environment]\nskybox = \"sky.hdr\"\n[ui]\n[prefabs.p]\n"
    "template = \"lamp\"\n[entities.sun.light]\nintensity = 6\n[templates.t]\n[archetypes.wall]\n";

TEST(Look, OfASceneOnlyItsOwnTablesAreRead) {
    if (lacks({"bloom", "gaussian_blur"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    std::vector<std::string> warnings;
    const LookOptions options{.is_strict = true, .warnings = &warnings, .is_scene = true};
    const std::string scene(scene_text);
    Result<Look> flat = parse_look(scene + "[post_process]\nbloom_intensity = 2\n", "a.toml", options);
    ASSERT_TRUE(flat) << flat.error().text;
    EXPECT_EQ(value_of(*flat, "bloom", "intensity"), "2.0");
    Result<Look> stack = parse_look(scene + "[[stack]]\neffect = \"gaussian_blur\"\nradius = 3\n", "a.toml", options);
    ASSERT_TRUE(stack) << stack.error().text;
    EXPECT_FALSE(stack->is_flat);
    EXPECT_EQ(value_of(*stack, "gaussian_blur", "radius"), "3");
    const Result<Look> none = parse_look(scene_text, "a.toml", options);
    ASSERT_TRUE(none) << none.error().text;
    Look expected = default_look();
    add_ui(expected);
    EXPECT_EQ(write_look(*none), write_look(expected)) << "its table [ui] is the look's";
    EXPECT_TRUE(warnings.empty()) << warnings.front();
}

TEST(Look, OfASceneItsOwnTablesAreCheckedStill) {
    const LookOptions options{.is_strict = true, .is_scene = true};
    const auto error = [&](const std::string& look) {
        const Result<Look> out = parse_look(std::string(scene_text) + look, "a.toml", options);
        return out ? "accepted" : out.error().text;
    };
    EXPECT_TRUE(error("[post_process]\nblom = 2\n").starts_with("a.toml:15:1: unknown key 'blom'"));
    EXPECT_TRUE(contains(error("[post_process]\n[[stack]]\n"), "[[stack]] beside [post_process]"));
    EXPECT_TRUE(contains(error_of(scene_text, true), "unknown key 'camera'")) << "a look alone has no other tables";
}

TEST(Look, OverridesWinOverTheFileWhichWinsOverDefaults) {
    if (lacks({"bloom"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = look_of("[post_process]\nbloom_intensity = 0.2\nbloom_threshold = 0.5\n");
    ASSERT_TRUE(override_look(look, std::array{LookOverride{"bloom_intensity", "0.3", "--bloom-intensity"}}));
    EXPECT_EQ(value_of(look, "bloom", "intensity"), "0.3");
    EXPECT_EQ(value_of(look, "bloom", "threshold"), "0.5");
    EXPECT_EQ(value_of(look, "bloom", "soft_threshold"), "0.5");
}

TEST(Look, AmountFlagsSwitchTheirEffect) {
    if (lacks({"bloom", "dither", "vignette"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = default_look();
    ASSERT_TRUE(override_look(
        look, std::array{LookOverride{"dither_intensity", "0.05", ""}, LookOverride{"bloom_intensity", "0", ""}}));
    EXPECT_TRUE(find_entry(look, "dither")->state.enabled.on);
    EXPECT_FALSE(find_entry(look, "bloom")->state.enabled.on);
    ASSERT_TRUE(override_look(
        look, std::array{LookOverride{"dither_enabled", "off", ""}, LookOverride{"dither_intensity", "0.1", ""}}));
    EXPECT_FALSE(find_entry(look, "dither")->state.enabled.on) << "a typed toggle counts";
    ASSERT_TRUE(override_look(look, std::array{LookOverride{"vignette_smoothness", "3", ""}}));
    EXPECT_FALSE(find_entry(look, "vignette")->state.enabled.on) << "other values only set";
}

TEST(Look, OverridesThatDoNotFitAreErrors) {
    if (lacks({"bloom", "negative"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    Look look = look_of("[[stack]]\neffect = \"negative\"\n[[stack]]\neffect = \"negative\"\n");
    const auto error = [&](std::string key, std::string text) {
        const Result<> done = override_look(look, std::array{LookOverride{key, std::move(text), "--" + key}});
        return done ? "accepted" : done.error().text;
    };
    EXPECT_EQ(error("bloom_intensity", "1"),
              "--bloom_intensity: a.toml has no entry 'bloom': it has negative and negative#2");
    EXPECT_EQ(error("negative#2.opacity", "0.5"), "accepted");
    EXPECT_EQ(look.entries[1].state.opacity, 0.5f);
    EXPECT_EQ(error("negative#2.opacity", "1.5"), "--negative#2.opacity = 1.5: allowed is [0, 1]");
    EXPECT_TRUE(contains(error("negative#3.opacity", "1"), "did you mean"));
    EXPECT_TRUE(contains(error("negative.opcity", "1"), "did you mean 'opacity'?"));
    EXPECT_TRUE(contains(error("negative.enabled", "maybe"), "is not a boolean"));
    Look flat = default_look();
    const Result<> done = override_look(flat, std::array{LookOverride{"bloom_intensity", "x", "--bloom-intensity"}});
    ASSERT_FALSE(done);
    EXPECT_TRUE(done.error().text.starts_with("--bloom-intensity: 'x' is not a number, allowed is [0, "))
        << done.error().text;
}

TEST(Look, DeepNestingIsRefusedNotFollowed) {
    std::string arrays = "a = ", dots = "a", headers = "[a", mixed = "x = ";
    for (int i = 0; i < 100000; ++i) arrays += '[';
    for (int i = 0; i < 200000; ++i) dots += ".a";
    for (int i = 0; i < 200000; ++i) headers += ".1";
    for (int i = 0; i < 8; ++i) {
        mixed += "[\n{";
        for (int j = 0; j < 60; ++j) mixed += "a.";
        mixed += "a = ";
    }
    for (const std::string& text : {arrays, dots + " = 1", headers + "]", mixed, dots + "\n"})
        EXPECT_TRUE(error_of(text).starts_with("a.toml:")) << text.size();
    EXPECT_EQ(error_of("# ............................................................................\n"), "accepted");
}

TEST(Look, DevicesAndFoldersAreNotRead) {
    for (const char* const path : {"/dev/zero", "/", "/no/such/look.toml"}) {
        const Result<Look> look = read_look(path);
        ASSERT_FALSE(look);
        EXPECT_TRUE(contains(look.error().text, path)) << look.error().text;
    }
}

TEST(Look, ShippedLooksAreStrict) {
    if (lacks({"bloom", "vignette", "dither", "exposure", "tonemap", "encode", "gaussian_blur", "negative", "blend"}))
        GTEST_SKIP() << "an effect that this test names is not in this build";
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(std::string(test::source_folder) + "/looks")) {
        if (file.path().extension() != ".toml") continue;
        std::vector<std::string> warnings;
        const Result<Look> look = read_look(file.path(), {.is_strict = true, .warnings = &warnings});
        EXPECT_TRUE(look) << look.error().text;
        EXPECT_TRUE(warnings.empty()) << warnings.front();
        ++count;
    }
    EXPECT_GE(count, 3u);
}

// The hostile files, with their placeholder keys renamed to ours.
TEST(Look, HostileFilesAreRefused) {
    if (lacks({"bloom"})) GTEST_SKIP() << "an effect that this test names is not in this build";
    const char* const folder = std::getenv("DARKROOM_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const auto renamed = [&](const char* name) {
        std::ifstream file(std::filesystem::path(folder) / "hostile" / name, std::ios::binary);
        EXPECT_TRUE(file) << name;
        std::stringstream out;
        for (std::string line; std::getline(file, line);) {
            const auto rename = [&](std::string_view from, std::string_view to) {
                if (line.starts_with(from)) line.replace(0, from.size(), to);
            };
            rename("[bloom]", "[post_process]");
            rename("threshold", "bloom_threshold");
            rename("treshold", "bloom_treshold");
            rename("intensity", "bloom_intensity");
            rename("enabled", "bloom_enabled");
            out << line << '\n';
        }
        return out.str();
    };
    const std::string types = error_of(renamed("17_toml_wrong_types.toml"));
    EXPECT_TRUE(contains(types, "bloom_enabled = \"yes\"") && contains(types, "bloom_threshold")) << types;
    const std::string unknown = error_of(renamed("18_toml_unknown_keys.toml"), true);
    EXPECT_TRUE(contains(unknown, "'bloom_threshold'") && contains(unknown, "not_a_section")) << unknown;
    const std::string twice = error_of(renamed("19_toml_duplicate_keys.toml"));
    EXPECT_TRUE(twice.starts_with("a.toml:3:")) << twice;
    EXPECT_TRUE(error_of(renamed("20_toml_non_utf8.toml")).starts_with("a.toml:2:"));
}

constexpr std::string_view feedback = R"(
[[stack]]
effect = "grayscale"
mask = "alpha"
scale = 0.333
format = "rgba8"

[[stack]]
effect = "blend"
input = "scene"
second = "trail.previous"

[[stack]]
effect = "blend"
second = "scene.previous"
output = "trail"
)";

TEST(Look, WiresNameTheAlphaAndTheFrameBefore) {
    if (lacks({"grayscale", "blend"})) GTEST_SKIP() << "an effect that this test names is not in the tree";
    const Look look = look_of(feedback);
    EXPECT_EQ(write_look(look_of(write_look(look))), write_look(look));
    Composer composer(Device::assumed());
    const Result<> applied = apply(look, composer);
    ASSERT_TRUE(applied) << applied.error().text;
    ASSERT_EQ(composer.size(), 3u);
    const EntryDesc& first = *composer.desc(composer.entry(0));
    EXPECT_EQ(first.mask, scene_alpha);
    EXPECT_EQ(first.scale.numerator, 1u);
    EXPECT_EQ(first.scale.denominator, 3u);
    EXPECT_EQ(first.format, VK_FORMAT_R8G8B8A8_UNORM);
    EXPECT_EQ(composer.desc(composer.entry(1))->second, composer.entry(2).previous());
    EXPECT_EQ(composer.desc(composer.entry(1))->input, scene_color);
    EXPECT_EQ(composer.desc(composer.entry(2))->second, scene_color.previous());
    EXPECT_EQ(composer.desc(composer.entry(2))->output, "trail");
    EXPECT_EQ(composer.pre_roll(), 2 * previous_pre_roll);
    const auto plan = composer.plan({.max_extent = {90, 60}});
    EXPECT_TRUE(plan) << plan.error().text;
}

TEST(Look, WiresToTheFrameBeforeNameAnOutput) {
    if (lacks({"blend"})) GTEST_SKIP() << "an effect that this test names is not in the tree";
    const auto error = [](std::string_view wire) {
        return error_of(fmt::format("[[stack]]\neffect = \"blend\"\nsecond = \"{}\"\noutput = \"a\"\n", wire));
    };
    EXPECT_EQ(error("a.previous"), "accepted");
    EXPECT_TRUE(contains(error("b.previous"), "no entry has this output: known are scene, alpha, ui and a"))
        << error("b.previous");
    EXPECT_TRUE(contains(error("alpha.previous"), "no entry has this output")) << error("alpha.previous");
    EXPECT_TRUE(contains(error(".previous"), "expected a name")) << error(".previous");
}

}  // namespace
}  // namespace darkroom
