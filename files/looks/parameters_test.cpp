// SPDX-License-Identifier: MIT
// What holds for every parameter of every effect, written once: the TOML round trip, every bound accepted, one step
// past it refused, a flag's text read.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <limits>

#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

std::vector<std::uint32_t> defaults_of(const EffectInfo& effect) {
    return {effect.parameters.defaults.begin(), effect.parameters.defaults.end()};
}

bool has_range(const ParamInfo& row) {
    return row.kind != Kind::Toggle && row.kind != Kind::Choice && row.kind != Kind::Resource;
}

// `number` in the form that the row's kind takes.
ParamValue filled(const ParamInfo& row, double number) {
    if (row.kind == Kind::Float || row.kind == Kind::Int) return number;
    if (row.kind == Kind::Curve) return CurvePoints{{0.0, number}, {1.0, number}};
    return std::vector<double>(row.words, number);
}

void for_every_row(const std::function<void(const EffectInfo&, const ParamInfo&)>& check) {
    ASSERT_FALSE(all_effects().empty());
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows) {
            SCOPED_TRACE(flat_key(effect->name, row.name));
            check(*effect, row);
        }
}

std::string toml_of(const EffectInfo& effect, const ParamInfo& row, std::span<const std::uint32_t> words) {
    return std::string("[[stack]]\neffect = \"") + std::string(effect.name) + "\"\n" + std::string(row.name) + " = " +
           format(row, words) + "\n";
}

TEST(Parameters, EveryBoundIsAcceptedAndOneStepPastIsRefused) {
    for_every_row([](const EffectInfo& effect, const ParamInfo& row) {
        if (!has_range(row)) return;
        std::vector<std::uint32_t> words = defaults_of(effect);
        for (const double bound : {row.range.min, row.range.max}) {
            EXPECT_TRUE(assign(row, words, filled(row, bound))) << bound;
            EXPECT_TRUE(check_words(row, std::span(words).subspan(row.word, row.words))) << bound;
            const float away = bound == row.range.min ? -std::numeric_limits<float>::infinity()
                                                      : std::numeric_limits<float>::infinity();
            const double step = row.kind == Kind::Int
                                    ? (away > 0 ? bound + 1 : bound - 1)
                                    : static_cast<double>(std::nextafter(static_cast<float>(bound), away));
            EXPECT_FALSE(assign(row, words, filled(row, step))) << step;
        }
        for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
            EXPECT_FALSE(assign(row, words, filled(row, bad))) << bad;
    });
}

TEST(Parameters, EveryValueSurvivesToml) {
    for_every_row([](const EffectInfo& effect, const ParamInfo& row) {
        // Those name files: resource_test.cpp.
        if (row.kind == Kind::Resource) return;
        std::vector<ParamValue> values;
        for (const std::string_view choice : row.choices) values.emplace_back(std::string(choice));
        if (row.kind == Kind::Toggle) values = {true, false};
        if (has_range(row)) {
            values = {filled(row, row.range.min), filled(row, row.range.max)};
            const double between = row.range.min + (row.range.max - row.range.min) / 3;
            values.push_back(filled(row, row.kind == Kind::Int ? std::floor(between) : between));
        }
        ASSERT_FALSE(values.empty());
        for (const ParamValue& value : values) {
            std::vector<std::uint32_t> words = defaults_of(effect);
            ASSERT_TRUE(assign(row, words, value));
            if (effect.conflict != nullptr && !effect.conflict(words.data()).empty()) continue;
            const std::string text = toml_of(effect, row, words);
            const Result<Look> look = parse_look(text, "look", {.is_strict = true});
            ASSERT_TRUE(look) << look.error().text << text;
            EXPECT_EQ(look->entries.at(0).words, words) << text;
        }
    });
}

TEST(Parameters, EveryDefaultIsReadFromAFlag) {
    for_every_row([](const EffectInfo& effect, const ParamInfo& row) {
        Look look{.is_flat = false};
        look.entries.push_back({.effect = &effect, .words = defaults_of(effect)});
        std::string text = format(row, effect.parameters.defaults);
        std::erase_if(text, [](char c) { return c == '[' || c == ']' || c == '"' || c == ' '; });
        if (row.kind == Kind::Curve) return;
        const LookOverride one{flat_key(effect.name, row.name), text, flag_name(flat_key(effect.name, row.name))};
        const Result<> done = override_look(look, std::array{one});
        ASSERT_TRUE(done) << done.error().text;
        std::vector<std::uint32_t> expected = defaults_of(effect);
        if (row.switched_word < expected.size()) expected[row.switched_word] = 1;
        EXPECT_EQ(look.entries[0].words, expected);
    });
}

TEST(Parameters, KeysAreUniqueAndApartFromTheEntrys) {
    std::vector<std::string> keys;
    for (const EffectInfo* const effect : all_effects()) {
        keys.push_back(flat_key(effect->name, "enabled"));
        for (const ParamInfo& row : effect->parameters.rows) {
            keys.push_back(flat_key(effect->name, row.name));
            for (const ParamInfo& own : entry_rows.rows) EXPECT_NE(own.name, row.name) << effect->name;
            for (const char* const wire : {"effect", "name", "input", "source", "second", "mask", "output"})
                EXPECT_NE(wire, row.name) << effect->name;
        }
    }
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

}  // namespace
}  // namespace darkroom
