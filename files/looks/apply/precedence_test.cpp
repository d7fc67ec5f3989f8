// SPDX-License-Identifier: MIT
// What wins: a flag over a file over the default, for every parameter of every effect of the flat table, and what
// switches an effect on.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

using Words = std::vector<std::uint32_t>;

/// The value of a row, as a file has it.
std::string value_of(const Look& look, const EffectInfo& effect, const ParamInfo& row) {
    for (const LookEntry& entry : look.entries)
        if (entry.effect == &effect) return format(row, entry.words);
    return "no entry";
}
bool is_on(const Look& look, const EffectInfo& effect) {
    for (const LookEntry& entry : look.entries)
        if (entry.effect == &effect) return entry.state.enabled.on;
    return false;
}

/// The `step`th value beside the default, near enough to it for rules between parameters to hold.
std::string other_value(const EffectInfo& effect, const ParamInfo& row, int step) {
    Words words(effect.parameters.defaults.begin(), effect.parameters.defaults.end());
    if (row.kind == Kind::Toggle) {
        words[row.word] ^= static_cast<std::uint32_t>(step & 1);
    } else if (row.kind == Kind::Choice) {
        words[row.word] =
            (words[row.word] + static_cast<std::uint32_t>(step)) % static_cast<std::uint32_t>(row.choices.size());
    } else if (row.kind == Kind::Int) {
        const auto value = static_cast<std::int32_t>(words[row.word]);
        words[row.word] = static_cast<std::uint32_t>(value + 2 <= row.range.max ? value + step : value - step);
    } else {
        for (std::uint32_t i = 0; i < row.words; ++i) {
            const auto value = static_cast<double>(std::bit_cast<float>(words[row.word + i]));
            const double above = std::min(1.0, row.range.max - value), below = std::min(1.0, value - row.range.min);
            const double moved = above > below ? value + above * 0.25 * step : value - below * 0.25 * step;
            words[row.word + i] = std::bit_cast<std::uint32_t>(static_cast<float>(moved));
        }
    }
    return format(row, words);
}

/// As a flag has it: without what only TOML needs.
std::string flag_text(std::string toml) {
    std::erase_if(toml, [](char c) { return c == '"' || c == '[' || c == ']' || c == ' '; });
    return toml;
}

/// The table that an effect's keys stand in.
std::string table_of(const EffectInfo& effect) {
    return effect.flat.is_of_ui() ? "[ui]\n" : "[post_process]\norder = \"scene_linear\"\n";
}

Look with_file(const EffectInfo& effect, const ParamInfo& row, const std::string& value) {
    const std::string text = table_of(effect) + flat_key(effect.name, row.name) + " = " + value + "\n";
    const Result<Look> look = parse_look(text, "a.toml", {.is_strict = true});
    EXPECT_TRUE(look) << look.error().text;
    return look ? *look : Look{};
}
Look with_flag(Look look, const std::string& key, const std::string& value) {
    const Result<> done = override_look(look, std::array{LookOverride{key, flag_text(value), ""}});
    EXPECT_TRUE(done) << done.error().text;
    return look;
}

void for_every_flat_row(const std::function<void(const EffectInfo&, const ParamInfo&)>& check) {
    std::size_t count = 0;
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows) {
            if (effect->flat.documented < 0 || row.kind == Kind::Curve || row.kind == Kind::Resource) continue;
            SCOPED_TRACE(flat_key(effect->name, row.name));
            check(*effect, row);
            ++count;
        }
    EXPECT_GT(count, 0U);
}

TEST(Precedence, FlagsWinOverFilesWhichWinOverDefaults) {
    for_every_flat_row([](const EffectInfo& effect, const ParamInfo& row) {
        const std::string usual = format(row, effect.parameters.defaults), key = flat_key(effect.name, row.name);
        const std::string of_file = other_value(effect, row, 1);
        const std::string of_flag = row.kind == Kind::Toggle ? usual : other_value(effect, row, 2);
        ASSERT_TRUE(usual != of_file && of_file != of_flag) << usual << ' ' << of_file << ' ' << of_flag;
        EXPECT_EQ(value_of(default_look(), effect, row), usual);
        const Look file = with_file(effect, row, of_file);
        EXPECT_EQ(value_of(file, effect, row), of_file);
        EXPECT_EQ(value_of(with_flag(file, key, of_flag), effect, row), of_flag);
        EXPECT_EQ(value_of(with_flag(default_look(), key, of_file), effect, row), of_file);
    });
}

TEST(Precedence, AKeyChangesItsOwnValueAlone) {
    for_every_flat_row([](const EffectInfo& effect, const ParamInfo& row) {
        const Look file = with_file(effect, row, other_value(effect, row, 1));
        for (const EffectInfo* const other : all_effects()) {
            if (other->flat.documented < 0) continue;
            const LookEntry plain = flat_entry(*other, LookOrder::SceneLinear);
            for (const ParamInfo& kept : other->parameters.rows) {
                const std::string usual = format(kept, plain.words);
                EXPECT_EQ(value_of(file, *other, kept) == usual, &kept != &row) << flat_key(other->name, kept.name);
            }
            if (other != &effect) {
                // The table [ui] turns all of its effects on.
                const bool is_of_table = effect.flat.is_of_ui() && other->flat.is_of_ui();
                EXPECT_EQ(is_on(file, *other), plain.state.enabled.on != 0 || is_of_table) << other->name;
            }
        }
    });
}

TEST(Precedence, EveryEffectHasASwitch) {
    for (const EffectInfo* const effect : all_effects()) {
        if (effect->flat.documented < 0) continue;
        for (const bool is_wanted : {true, false}) {
            const std::string key = flat_key(effect->name, "enabled");
            const Result<Look> file = parse_look(table_of(*effect) + key + (is_wanted ? " = true\n" : " = false\n"),
                                                 "a.toml", {.is_strict = true});
            ASSERT_TRUE(file) << file.error().text;
            EXPECT_EQ(is_on(*file, *effect), is_wanted) << key;
        }
    }
}

// Every key with its last letter twice.
TEST(Precedence, AMisspeltKeyIsNamedWithTheOneThatIsMeant) {
    for_every_flat_row([](const EffectInfo& effect, const ParamInfo& row) {
        const std::string key = flat_key(effect.name, row.name), slip = key + key.back();
        std::vector<std::string> warnings;
        const Result<Look> look = parse_look(table_of(effect) + slip + " = 0\n", "a.toml", {.warnings = &warnings});
        ASSERT_TRUE(look) << look.error().text;
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_NE(warnings[0].find("unknown key '" + slip + "'"), std::string::npos) << warnings[0];
        EXPECT_NE(warnings[0].find("did you mean '" + key + "'"), std::string::npos) << warnings[0];
        EXPECT_EQ(value_of(*look, effect, row), format(row, flat_entry(effect, LookOrder::SceneLinear).words));
    });
}

// Of files and flags an amount switches its effect, of flags the falloff of fog, too. Nothing else does.
TEST(Precedence, AmountsSwitchAndNothingElse) {
    const std::set<std::string> named{"bloom_intensity",
                                      "ssao_intensity",
                                      "fog_density",
                                      "dither_intensity",
                                      "vignette_intensity",
                                      "volumetric_density",
                                      "chromatic_aberration",
                                      "radial_blur",
                                      "motion_blur_shutter_angle",
                                      "god_rays_intensity",
                                      "perturb_amount",
                                      "classic_bloom_intensity",
                                      "arena_bloom_intensity",
                                      "film_grain_amount",
                                      "lens_flare_intensity",
                                      "halation_intensity",
                                      "anamorphic_streaks_intensity",
                                      "lens_dirt_intensity"};
    std::set<std::string> switches;
    for_every_flat_row([&](const EffectInfo& effect, const ParamInfo& row) {
        const std::string key = flat_key(effect.name, row.name), enabled = flat_key(effect.name, "enabled");
        const std::string value = other_value(effect, row, 1);
        const Look off = with_flag(default_look(), enabled, "off");
        const bool does_switch = is_on(with_flag(off, key, value), effect);
        if (does_switch) switches.insert(key);
        EXPECT_EQ(is_on(with_file(effect, row, value), effect),
                  named.contains(key) || flat_entry(effect, LookOrder::SceneLinear).state.enabled.on != 0 ||
                      effect.flat.is_of_ui());
        Look typed = default_look();
        ASSERT_TRUE(override_look(
            typed, std::array{LookOverride{enabled, "off", ""}, LookOverride{key, flag_text(value), ""}}));
        EXPECT_FALSE(is_on(typed, effect)) << "a toggle that is typed counts";
        if (!named.contains(key)) return;
        EXPECT_FALSE(is_on(with_flag(with_flag(default_look(), enabled, "on"), key, "0"), effect));
        EXPECT_FALSE(is_on(with_file(effect, row, "0"), effect));
        EXPECT_TRUE(is_on(with_flag(with_file(effect, row, "0"), key, value), effect)) << "the flag is the last word";
    });
    std::set<std::string> expected;
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows)
            if (const std::string key = flat_key(effect->name, row.name);
                named.contains(key) || key == "fog_height_falloff")
                expected.insert(key);
    EXPECT_EQ(switches, expected);
}

TEST(Precedence, TheFalloffOfFogTurnsHeightFogOn) {
    const EffectInfo* const fog = find_effect("fog");
    if (fog == nullptr) GTEST_SKIP() << "the effect fog is not in this build";
    const ParamInfo& height = *fog->parameters.find("height_enabled");
    const Look look = with_flag(default_look(), "fog_height_falloff", "0.3");
    EXPECT_EQ(value_of(look, *fog, height), "true");
    EXPECT_EQ(value_of(with_flag(default_look(), "fog_density", "0.3"), *fog, height), "false");
}

}  // namespace
}  // namespace darkroom
