// SPDX-License-Identifier: MIT
// A Composer that follows a document is the one that apply() would make of it.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>

#include "edit/document.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::edit {
namespace {

void must(const Result<>& done) { ASSERT_TRUE(done) << done.error().text; }

/// What a wire names, whatever the handles' numbers are.
std::string shown(const Composer& composer, Handle handle) {
    if (!handle.is_given()) return "default";
    const std::string suffix = handle.is_previous ? ".previous" : "";
    if (const EntryDesc* const desc = composer.desc({handle.id})) return desc->name + suffix;
    for (const auto& [name, given] : given_wires)
        if (given.id == handle.id) return std::string(name) + suffix;
    const auto found = composer.resources().find(handle.id);
    return found == composer.resources().end() ? "nothing" : fmt::format("table {}", found->second->index());
}

/// All that a Composer says of its stack.
std::string shown(const Composer& composer) {
    std::string out;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle handle = composer.entry(i);
        const EntryDesc& desc = *composer.desc(handle);
        out +=
            fmt::format("{} ({}): {} of {}, {} {} {}/{} {} ui {} output '{}'", desc.name, composer.info(handle)->name,
                        desc.enabled, desc.opacity, static_cast<int>(desc.blend), static_cast<int>(desc.format),
                        desc.scale.numerator, desc.scale.denominator, i, desc.is_ui, desc.output);
        for (const Handle wire : {desc.input, desc.source, desc.second, desc.mask}) out += ", " + shown(composer, wire);
        for (const ParamInfo& row : composer.info(handle)->parameters.rows)
            for (const std::uint32_t word : composer.words(handle).subspan(row.word, row.words))
                out += row.kind != Kind::Resource ? fmt::format(" {}", word) : word == 0 ? " none" : " a table";
        // What layers make of it.
        const auto values = composer.values_at(handle, 1, {});
        out += fmt::format(" moved {} {}", values.is_enabled, values.opacity);
        for (const ParamInfo& row : composer.info(handle)->parameters.rows)
            for (std::uint32_t part = 0; part < row.words && row.kind != Kind::Resource; ++part)
                out += fmt::format(" {}", values.words[row.word + part]);
        out += '\n';
    }
    for (const std::string& name : composer.layer_names()) out += "layer " + name + '\n';
    return out + fmt::format("{} tables\n", composer.resources().size());
}

std::string applied(const Look& look, const ApplyOptions& options) {
    Composer composer(Device::assumed());
    const auto done = apply(look, composer, options);
    EXPECT_TRUE(done) << done.error().text;
    return shown(composer);
}

Look random_stack(std::mt19937& random) {
    Look look{.is_flat = false, .shown_name = "a stack"};
    for (int i = 0; i < 6; ++i) {
        const EffectInfo& effect = *all_effects()[test::below(random, all_effects().size())];
        if (!effect.flat.is_of_ui()) look.entries.push_back(entry_of(effect));
    }
    return look;
}

class Follow : public testing::Test {};

TEST_F(Follow, RandomEditsLeaveWhatApplyWouldMake) {
    std::mt19937 random(3);
    for (int run = 0; run < 24; ++run) {
        const ApplyOptions options{.keeps_what_is_off = run % 2 == 0};
        LookDocument document(run % 3 == 0 ? default_look() : random_stack(random));
        Composer composer(Device::assumed());
        must(apply(document.look(), composer, options));
        Look followed = document.look();
        for (int edit = 0; edit < 60; ++edit) {
            const auto change = [&](Look& look) {
                if (!look.entries.empty() && test::below(random, 2) == 0)
                    return test::apply_edit(look, test::random_value_edit(random, look));
                return test::random_restructuring(random, look);
            };
            if (test::below(random, 10) == 0)
                document.undo();
            else
                (void)document.edit("Something", change);
            if (test::below(random, 3) == 0) continue;
            const auto done = follow(followed, document.look(), composer, options);
            ASSERT_TRUE(done) << done.error().text;
            followed = document.look();
            ASSERT_EQ(shown(composer), applied(followed, options)) << "run " << run << ", edit " << edit;
        }
    }
}

class FollowByName : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "tonemap", "gaussian_blur", "lut", "vignette", "blend"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
    /// A document of a text and a Composer that follows it.
    void begin(const std::string& text, const LookOptions& options = {}) {
        Result<Look> look = parse_look(text, "a.toml", options);
        ASSERT_TRUE(look) << look.error().text;
        document_.emplace(std::move(*look), options);
        must(apply(document_->look(), composer_));
        followed_ = document_->look();
    }
    /// Edits, follows, and says whether that needs a compile.
    bool needs_compile(const std::function<Result<>(Look&)>& change) {
        must(document_->edit("Something", change));
        return follows();
    }
    bool follows() {
        const auto done = follow(followed_, document_->look(), composer_);
        EXPECT_TRUE(done) << done.error().text;
        followed_ = document_->look();
        if (!has_overrides_) {
            EXPECT_EQ(shown(composer_), applied(followed_, {}));
        }
        return done && done->needs_compile;
    }
    static std::vector<std::uint32_t> word(float value) { return {std::bit_cast<std::uint32_t>(value)}; }

    std::optional<LookDocument> document_;
    Composer composer_{Device::assumed()};
    Look followed_;
    bool has_overrides_ = false;
};

const std::string three =
    "[[stack]]\neffect = \"gaussian_blur\"\n[[stack]]\neffect = \"gaussian_blur\"\n"
    "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"tonemap\"\n";

TEST_F(FollowByName, ValuesAndSwitchesNeedNoCompile) {
    begin(three);
    EXPECT_FALSE(needs_compile([&](Look& look) { return set_value(look, "exposure", "exposure", word(2)); }));
    EXPECT_FALSE(needs_compile([&](Look& look) { return set_state(look, "exposure", "enabled", std::array{0u}); }));
    EXPECT_FALSE(needs_compile([&](Look& look) { return set_state(look, "exposure", "opacity", word(0.5f)); }));
    EXPECT_TRUE(needs_compile([&](Look& look) { return set_state(look, "gaussian_blur", "opacity", word(0.5f)); }));
    EXPECT_TRUE(needs_compile([&](Look& look) { return set_state(look, "exposure", "blend", std::array{1u}); }));
    EXPECT_TRUE(needs_compile([&](Look& look) { return move_entry(look, "tonemap", "exposure"); }));
    EXPECT_TRUE(needs_compile([&](Look& look) { return remove_entry(look, "tonemap"); }));
    document_->undo();
    EXPECT_TRUE(follows());
    EXPECT_FALSE(follows());
}

// Histories and overrides are those of handles.
TEST_F(FollowByName, EntriesThatStayKeepTheirHandles) {
    begin(three);
    const auto second = composer_.find("gaussian_blur#2"), exposure = composer_.find("exposure");
    has_overrides_ = true;
    must(composer_.set_override(*exposure, "exposure", "a script", word(3)));
    needs_compile([&](Look& look) { return move_entry(look, "exposure", "gaussian_blur"); });
    EXPECT_EQ(composer_.find("exposure"), exposure);
    EXPECT_EQ(composer_.current(*exposure), word(3));
    // What is the first of its effect now was the second.
    needs_compile([&](Look& look) { return remove_entry(look, "gaussian_blur"); });
    EXPECT_EQ(composer_.find("gaussian_blur"), second);
    EXPECT_FALSE(composer_.find("gaussian_blur#2"));
    document_->undo();
    follows();
    EXPECT_EQ(composer_.find("gaussian_blur#2"), second);
    EXPECT_EQ(composer_.current(*exposure), word(3));
}

TEST_F(FollowByName, TablesAreDefinedOnceAndForgotten) {
    const LookOptions options{.load_resource = [](const std::filesystem::path&, FileUse) -> Result<ResourceData> {
        return ResourceData(ColorTable{.size = 2, .cube = std::vector<float>(24, 0.5f)});
    }};
    begin("[[stack]]\neffect = \"lut\"\n[[stack]]\neffect = \"exposure\"\n", options);
    const EffectInfo& lut = *find_effect("lut");
    const auto row = std::ranges::find(lut.parameters.rows, Kind::Resource, &ParamInfo::kind);
    ASSERT_NE(row, lut.parameters.rows.end());
    EXPECT_TRUE(needs_compile([&](Look& look) { return set_file(look, "lut", row->name, "a.cube", options); }));
    EXPECT_EQ(composer_.resources().size(), 1u);
    const std::uint32_t number = composer_.resources().begin()->first;
    EXPECT_FALSE(needs_compile([&](Look& look) { return set_value(look, "exposure", "exposure", word(2)); }));
    EXPECT_TRUE(needs_compile([&](Look& look) { return duplicate_entry(look, "lut").map([](auto&&) {}); }));
    EXPECT_EQ(composer_.resources().begin()->first, number);
    EXPECT_EQ(composer_.resources().size(), 1u);
    EXPECT_TRUE(needs_compile([&](Look& look) -> Result<> {
        DARKROOM_TRY(remove_entry(look, "lut#2"));
        return set_file(look, "lut", row->name, "", options);
    }));
    EXPECT_TRUE(composer_.resources().empty());
}

TEST_F(FollowByName, PulsesAndLayersStayOrComeAnew) {
    begin(
        "[post_process]\nvignette_enabled = true\n[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\namount = 0.5\n"
        "[[layer]]\nname = \"dark\"\n[layer.values]\n\"exposure\" = 0.25\n");
    EXPECT_EQ(composer_.fire("hit", 0.0), 1u);
    must(composer_.set_layer_weight("dark", 1));
    const Handle exposure = *composer_.find("exposure");
    const auto value = [&] { return std::bit_cast<float>(composer_.values_at(exposure, 0.15, {}).words[0]); };
    const float before = value();
    EXPECT_GT(before, 0.25f);
    const auto change = [&](Look& look) { return set_value(look, "vignette", "intensity", word(0.9f)); };
    must(document_->edit("Something", change));
    const auto done = follow(followed_, document_->look(), composer_);
    ASSERT_TRUE(done);
    EXPECT_EQ(value(), before);  // both go on
    Look without = document_->look();
    without.pulses.clear();
    without.layers[0].values[0].words = word(2);
    const auto changed = follow(document_->look(), without, composer_);
    ASSERT_TRUE(changed);
    EXPECT_TRUE(changed->needs_compile);
    EXPECT_EQ(composer_.fire("hit", 0.0), 0u);
    must(composer_.set_layer_weight("dark", 1));
    EXPECT_EQ(value(), 2);
}

TEST_F(FollowByName, WhatCannotBeChangesNothing) {
    begin(three);
    const std::string before = shown(composer_);
    Look wrong = document_->look();
    wrong.entries[0].second = "nobody";
    wrong.entries.pop_back();
    const auto done = follow(followed_, wrong, composer_);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().text.find("nobody"), std::string::npos) << done.error().text;
    EXPECT_EQ(shown(composer_), before);
}

TEST_F(FollowByName, ConsolesBringTheirValuesBack) {
    begin(three);
    const ComposerValues before(composer_);
    must(composer_.set(*composer_.find("exposure"), "exposure", word(3)));
    must(composer_.set_enabled(*composer_.find("tonemap"), false));
    EXPECT_FALSE(needs_compile([&](Look& look) { return before.take_changes(look, composer_); }));
    EXPECT_EQ(document_->look().entries[2].words, word(3));
    EXPECT_FALSE(document_->look().entries[3].state.enabled);
    document_->undo();
    follows();
    EXPECT_EQ(composer_.words(*composer_.find("exposure"))[0], word(1)[0]);
}

TEST_F(FollowByName, WhatATimelineHasSetIsNoConsoles) {
    begin(three);
    must(composer_.set_enabled(*composer_.find("tonemap"), false));  // an event's
    const ComposerValues before(composer_);
    must(composer_.set(*composer_.find("exposure"), "exposure", word(3)));
    must(document_->edit("exposure", [&](Look& look) { return before.take_changes(look, composer_); }));
    EXPECT_EQ(document_->look().entries[2].words, word(3));
    EXPECT_TRUE(document_->look().entries[3].state.enabled);
}

}  // namespace
}  // namespace darkroom::edit
