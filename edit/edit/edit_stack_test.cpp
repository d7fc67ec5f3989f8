// SPDX-License-Identifier: MIT
// What adding does to a flat table, and what an effect is known to need.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "edit/document.hpp"
#include "edit/edits.hpp"
#include "edit/effect_uses.hpp"
#include "looks/look_parts.hpp"

namespace darkroom::edit {
namespace {

class EditStack : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "fog", "exposure", "tonemap", "blend"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

// What a file or a hand has set is not lost because it is off; nobody is wired who does not read the wire.
TEST_F(EditStack, AFlatTableThatBecomesAStackKeepsWhatIsOff) {
    Result<Look> read =
        parse_look("[post_process]\nfog_density = 0.3\nfog_enabled = false\nbloom_intensity = 0.2\n", "a.toml");
    ASSERT_TRUE(read) << read.error().text;
    Look look = std::move(*read);
    const Result<std::string> added = add_effect(look, *find_effect("blend"));
    ASSERT_TRUE(added) << added.error().text;
    ASSERT_FALSE(look.is_flat);
    const LookEntry* const fog = find_entry(look, "fog");
    ASSERT_NE(fog, nullptr);
    EXPECT_EQ(fog->state.enabled.on, 0U);
    EXPECT_EQ(find_entry(look, "bloom")->source, "scene");
    for (const LookEntry& entry : look.entries)
        EXPECT_TRUE(entry.source.empty() || uses_of(*entry.effect).reads_source) << entry.effect->name;
    EXPECT_EQ(find_entry(look, "exposure")->source, "");
    EXPECT_EQ(find_entry(look, "negative"), nullptr) << "what nobody has set is not in the list";
}

TEST_F(EditStack, WhatTheTableHasIsSwitchedOnInBothOrders) {
    for (const LookOrder order : {LookOrder::Documented, LookOrder::SceneLinear})
        for (const EffectInfo* const effect : all_effects()) {
            Look look = default_look(order);
            const Addition addition = addition_of(look, *effect);
            if (addition.kind != Addition::Kind::SwitchesOn) continue;
            ASSERT_TRUE(add_effect(look, *effect)) << effect->name;
            EXPECT_TRUE(look.is_flat) << effect->name;
            EXPECT_EQ(find_entry(look, addition.entry)->state.enabled.on, 1U) << effect->name;
        }
    Look look = default_look();
    EXPECT_EQ(addition_of(look, *find_effect("blend")).kind, Addition::Kind::MakesStack);
    EXPECT_EQ(addition_of(look, *find_effect("tonemap")).kind, Addition::Kind::IsThere);
}

TEST_F(EditStack, ACopyHasNotTheOutputsName) {
    Result<Look> read = parse_look(
        "[[stack]]\neffect = \"exposure\"\nname = \"dim\"\noutput = \"dimmed\"\nexposure = 0.5\n\n"
        "[[stack]]\neffect = \"blend\"\nsecond = \"dimmed\"\n",
        "a.toml");
    ASSERT_TRUE(read) << read.error().text;
    Look look = std::move(*read);
    const Result<std::string> copy = duplicate_entry(look, "dim");
    ASSERT_TRUE(copy) << copy.error().text;
    ASSERT_EQ(look.entries.size(), 3U);
    EXPECT_EQ(find_entry(look, "dim")->output, "dimmed");
    const LookEntry* const made = find_entry(look, *copy);
    ASSERT_EQ(made, &look.entries[1]);
    EXPECT_EQ(made->output, "") << "two outputs of one name";
    EXPECT_NE(made->name, "dim");
    EXPECT_EQ(made->words, look.entries[0].words);
}

TEST_F(EditStack, UsesAreWhatBuildDeclares) {
    EXPECT_TRUE(uses_of(*find_effect("bloom")).has_passes);
    EXPECT_TRUE(uses_of(*find_effect("bloom")).reads_source);
    for (const EffectInfo* const effect : all_effects())
        if (!effect->build) {
            EXPECT_FALSE(uses_of(*effect).has_passes || uses_of(*effect).reads_source) << effect->name;
        }
    for (const char* const name : {"dither", "lut"})
        if (const EffectInfo* const effect = find_effect(name)) {
            EXPECT_FALSE(uses_of(*effect).has_passes) << name;
        }
}

// A look after another is no error though a pulse of each moves the same entry, and the files they name are still
// there.
TEST_F(EditStack, AnotherLookKeepsItsFilesAndTakesTheSamePlaces) {
    const std::string pulse =
        "[[pulse]]\nevent = \"hit\"\nparameter = \"bloom.intensity\"\namount = 1.0\n"
        "[ui]\ndocument = \"../hud/visor.svg\"\n";
    LookDocument document;
    for (const char* const intensity : {"0.2", "0.3"}) {
        const Result<> done = document.edit("look", [&](Look& look) -> Result<> {
            DARKROOM_TRY_VALUE(
                Look read,
                parse_look(fmt::format("[post_process]\nbloom_intensity = {}\n{}", intensity, pulse), "a.toml"));
            take_look(look, std::move(read), "/shipped/looks", "/home/art");
            return {};
        });
        ASSERT_TRUE(done) << done.error().text;
        ASSERT_TRUE(document.look().ui);
        EXPECT_EQ(document.look().ui->document, "../../shipped/hud/visor.svg");
    }
    EXPECT_EQ(document.look().pulses.size(), 1U);
    document.undo();
    EXPECT_TRUE(document.can_undo()) << "each was a step";
    document.undo();
    EXPECT_FALSE(document.is_changed());
}

}  // namespace
}  // namespace darkroom::edit
