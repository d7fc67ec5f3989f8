// SPDX-License-Identifier: MIT
#include "edit/follow/moved_values.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <random>

#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "edit/splice/splice.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::edit {
namespace {

constexpr std::string_view text =
    "[post_process]\nvignette_intensity = 0.2\nfog_density = 0.05\n\n"
    "[[pulse]] # hits\nevent = \"hit\"\nparameter = \"vignette.intensity\"\namount = 0.25 # strong\n\n"
    "[[pulse]]\nevent = \"hit\"\nparameter = \"fog.color\"\namount = [0.1, 0.0, 0.0]\nenvelope = 'exponential'\n\n"
    "[[layer]]\nname = \"cave\"\ndistance = { near = 4, far = 12, point = [0, 1, -8] } # of the cave\n"
    "values = { exposure = 0.5, \"fog.enabled\" = true, \"fog.color\" = [0.5, 0.25, 0.0] } # dark\n\n"
    "[[layer]]\nname = 'night'\nweight = 0.5\n[layer.values]\nvignette.intensity = 0.75\n\n[other]\na = 1\n";

class MovedValues : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"vignette", "fog", "exposure"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
    static Look read(const std::string& from) {
        Result<Look> look = parse_look(from, "a.toml", {.is_scene = true});
        EXPECT_TRUE(look) << look.error().text << "\n" << from;
        return look ? *look : Look{};
    }
    /// The text behind a change.
    static std::string edited(std::string_view from, const std::function<Result<>(Look&)>& change) {
        const Look was = read(std::string(from));
        Look is = was;
        const Result<> done = change(is);
        EXPECT_TRUE(done) << done.error().text;
        const Result<std::string> out = splice_look(from, was, is);
        EXPECT_TRUE(out) << out.error().text;
        EXPECT_TRUE(out && says_same(read(*out), is)) << *out;
        return out.value_or("");
    }
    /// With a number, or numbers, of a pulse or a layer set.
    static std::string set(Mover mover, std::string_view row, const std::vector<float>& numbers) {
        return edited(text, [&](Look& look) {
            std::vector<std::uint32_t> words;
            for (const float number : numbers) words.push_back(std::bit_cast<std::uint32_t>(number));
            const std::vector<MovedValue> values = values_of(look, mover);
            const auto found = std::ranges::find(values, row, [](const MovedValue& one) { return one.row.name; });
            return set_moved(look, mover, static_cast<std::size_t>(found - values.begin()), words);
        });
    }
    static std::string with(std::string_view old, std::string_view now) {
        std::string out(text);
        return out.replace(out.find(old), old.size(), now);
    }
};

TEST_F(MovedValues, AreWrittenWhereTheyStand) {
    const Mover hit{false, 0}, second{false, 1}, cave{true, 0}, night{true, 1};
    EXPECT_EQ(set(hit, "amount", {0.5F}), with("amount = 0.25", "amount = 0.5"));
    EXPECT_EQ(set(hit, "duration", {2}), with("0.25 # strong\n", "0.25 # strong\nduration = 2.0\n"));
    EXPECT_EQ(set(second, "amount", {0.1F, 0.5F, 0}), with("[0.1, 0.0, 0.0]", "[0.1, 0.5, 0.0]"));
    EXPECT_EQ(set(cave, "far", {16}), with("far = 12", "far = 16.0"));
    EXPECT_EQ(set(cave, "point", {0, 1, 2}), with("[0, 1, -8]", "[0, 1, 2.0]"));
    EXPECT_EQ(set(cave, "weight", {0.5F}), with("# dark\n", "# dark\nweight = 0.5\n"));
    EXPECT_EQ(set(cave, "exposure", {0.75F}), with("exposure = 0.5", "exposure = 0.75"));
    EXPECT_EQ(set(cave, "color", {0.5F, 0.25F, 1}), with("[0.5, 0.25, 0.0]", "[0.5, 0.25, 1.0]"));
    EXPECT_EQ(set(night, "weight", {1}), with("weight = 0.5", "weight = 1.0"));
    EXPECT_EQ(set(night, "intensity", {1}), with("intensity = 0.75", "intensity = 1.0"));
}

TEST_F(MovedValues, AnAmountIsNoMoreThanAFileMaySay) {
    const Look look = read(
        "[post_process]\nfog_enabled = true\n[[pulse]]\nevent = \"hit\"\n"
        "parameter = \"fog.height_origin\"\namount = 1\n");
    const std::vector<MovedValue> values = values_of(look, {false, 0});
    EXPECT_EQ(values.front().row.range.max, 1e6) << "and not the width of the parameter's interval";
}

TEST_F(MovedValues, RandomOnesReadAsTheyWereSet) {
    std::mt19937 random(5);
    Look look = read(std::string(text));
    std::string now(text);
    int count = 0;
    for (int i = 0; i < 300; ++i) {
        const Mover mover{test::below(random, 2) == 1, test::below(random, 2)};
        const std::vector<MovedValue> values = values_of(look, mover);
        const std::uint32_t value = test::below(random, values.size());
        Look next = look;
        if (!set_moved(next, mover, value, test::random_words(random, values[value].row)))
            continue;  // near is not before far
        const Result<std::string> spliced = splice_look(now, look, next);
        ASSERT_TRUE(spliced) << spliced.error().text;
        ASSERT_TRUE(says_same(read(*spliced), next)) << *spliced;
        now = *spliced;
        look = std::move(next);
        ++count;
    }
    EXPECT_GT(count, 200);
    EXPECT_NE(now.find("# strong"), std::string::npos);
}

TEST_F(MovedValues, WhatCannotBeIsRefused) {
    LookDocument document(read(std::string(text)));
    const std::array far{std::bit_cast<std::uint32_t>(2.0F)}, huge{std::bit_cast<std::uint32_t>(5.0F)};
    const auto set = [&](Mover mover, std::size_t value, std::span<const std::uint32_t> words) {
        const Result<> done = document.edit("a step", [&](Look& look) { return set_moved(look, mover, value, words); });
        return done ? std::string() : done.error().text;
    };
    EXPECT_NE(set({true, 0}, 2, far).find("allowed is near < far"), std::string::npos);
    EXPECT_NE(set({true, 0}, 0, huge).find("cave, weight = 5: allowed is [0, 1]"), std::string::npos)
        << set({true, 0}, 0, huge);
    EXPECT_NE(set({true, 7}, 0, far), "");
    EXPECT_FALSE(document.can_undo());
    EXPECT_EQ(set({true, 0}, 0, std::array{std::bit_cast<std::uint32_t>(0.25F)}), "");
    EXPECT_TRUE(document.is_changed());
    document.undo();
    EXPECT_FALSE(document.is_changed());
}

TEST_F(MovedValues, TheInterfaceIsWrittenWhereItStands) {
    constexpr std::string_view ui =
        "[ui] # over it\ndocument = \"hud.svg\" # ours\ncontrollers = ['a.lua']\n"
        "game = { health = 80, name = \"x\" } # at first\n";
    const auto change = [](const std::function<void(LookUi&)>& how) {
        return [how](Look& look) {
            if (!look.ui) add_ui(look);
            how(*look.ui);
            return Result<>();
        };
    };
    const auto replaced = [&](std::string_view old, std::string_view now) {
        std::string out(ui);
        return out.replace(out.find(old), old.size(), now);
    };
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.document = "b.svg"; })), replaced("\"hud.svg\"", "\"b.svg\""));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.document.clear(); })),
              replaced("document = \"hud.svg\" # ours\n", ""));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.controllers.push_back("b.lua"); })),
              replaced("['a.lua']", "[\"a.lua\", \"b.lua\"]"));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.controllers.clear(); })),
              replaced("controllers = ['a.lua']\n", ""));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.game["health"] = 12.5; })), replaced("80", "12.5"));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.game["armour"] = true; })),
              replaced("name = \"x\" }", "name = \"x\", armour = true }"));
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.game.erase("health"); })), replaced("health = 80, ", ""));
    const std::string made = edited("[post_process]\n", change([](LookUi& own) {
                                        own.document = "hud.svg";
                                        own.game["health"] = 80.0;
                                    }));
    EXPECT_EQ(made, "[post_process]\n\n[ui]\ndocument = \"hud.svg\"\ngame = { \"health\" = 80 }\n");
    EXPECT_EQ(edited(ui, change([](LookUi& own) { own.game.clear(); })).find("game"), std::string::npos);
    EXPECT_EQ(edited("[ui]\n[ui.game]\nhealth = 80 # full\n", change([](LookUi& own) { own.game.clear(); })),
              "[ui]\n[ui.game]\n");
    EXPECT_EQ(edited("[ui]\n[ui.game]\nhealth = 80 # full\n", change([](LookUi& own) { own.game["health"] = 81.0; })),
              "[ui]\n[ui.game]\nhealth = 81 # full\n");
}

// Its neighbours are others of the same entry, and the same of another entry.
TEST_F(MovedValues, OneAloneIsTakenFromALayer) {
    const Look look = read(
        "[post_process]\nvignette_intensity = 0.2\nfog_density = 0.05\n\n[[layer]]\nname = \"cave\"\nvalues = { "
        "\"fog.enabled\" = true, \"fog.density\" = 0.25, \"vignette.enabled\" = true, \"vignette.intensity\" = 0.5 "
        "}\n");
    ASSERT_EQ(look.layers.size(), 1U);
    const auto names = [](const Look& of) {
        std::vector<std::string> out;
        for (const LookLayer::Value& value : of.layers[0].values) out.push_back(value.entry + "." + value.parameter);
        return out;
    };
    const std::vector<MovedValue> all = values_of(look, {true, 0});
    std::size_t removed = 0;
    for (std::size_t number = 0; number < all.size(); ++number) {
        if (all[number].table != "values") continue;
        std::vector<std::string> others = names(look);
        std::erase(others, fmt::format("{}.{}", all[number].entry, all[number].row.name));
        EXPECT_EQ(others.size(), 3U);
        Look changed = look;
        ASSERT_TRUE(remove_layer_value(changed, 0, number));
        EXPECT_EQ(names(changed), others);
        ++removed;
    }
    EXPECT_EQ(removed, 4U);
}

}  // namespace
}  // namespace darkroom::edit
