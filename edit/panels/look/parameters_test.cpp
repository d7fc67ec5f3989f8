// SPDX-License-Identifier: MIT
// The parameters of every effect, moved by a mouse.
#include <gtest/gtest.h>

#include <set>

#include "core/text/param_text.hpp"
#include "panels/look/test_look_panels.hpp"
#include "panels/widgets/value_widgets.hpp"

namespace darkroom::panels {
namespace {

/// So high that no panel scrolls.
const ImVec2 tall{1280, 4800};

std::span<const std::uint32_t> words_of(const LookEntry& entry, const ParamInfo& row) {
    return std::span(entry.words).subspan(row.word, row.words);
}
bool is_number(const ParamInfo& row) {
    return row.kind != Kind::Toggle && row.kind != Kind::Choice && row.kind != Kind::Curve &&
           row.kind != Kind::Resource;
}
/// Of a row's first number.
ImVec2 on_slider(TestPanels& own, const std::string& widget, const ParamInfo& row, float part) {
    const WidgetPlace place = own.place(widget);
    const float swatch = row.kind == Kind::Rgb ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x : 0;
    const float count = row.kind == Kind::Int ? 1 : static_cast<float>(row.words);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = (place.most.x - place.least.x - swatch - gap * (count - 1)) / count;
    return {place.least.x + swatch + 1 + part * (width - 2), place.center().y};
}

/// Does `visit` for every row of every effect, one in a stack of its own.
void for_each_row(
    const std::function<void(TestPanels&, const EffectInfo&, const ParamInfo&, const std::string&)>& visit) {
    for (const EffectInfo* const effect : all_effects()) {
        const std::span<const std::uint32_t> defaults = effect->parameters.defaults;
        Look look{.is_flat = false, .shown_name = "one.toml"};
        look.entries.push_back({.effect = effect, .words = {defaults.begin(), defaults.end()}});
        TestPanels own(std::move(look), tall);
        own.select(effect->name);
        for (const ParamInfo& row : effect->parameters.rows)
            visit(own, *effect, row, fmt::format("{}.{}", effect->name, row.name));
    }
}

TEST(PanelParameters, EveryRowHasAWidget) {
    std::size_t rows = 0;
    for_each_row([&](TestPanels& own, const EffectInfo&, const ParamInfo&, const std::string& widget) {
        EXPECT_TRUE(own.has(widget)) << widget;
        EXPECT_TRUE(own.has(widget + ".name")) << widget;
        const WidgetPlace place = own.place(widget);
        EXPECT_GT(place.most.x - place.least.x, 15) << widget;
        ++rows;
    });
    EXPECT_GT(rows, 0u);
}

TEST(PanelParameters, DragsStayInTheIntervalAndAreOneStep) {
    for_each_row([&](TestPanels& own, const EffectInfo& effect, const ParamInfo& row, const std::string& widget) {
        if (!is_number(row)) return;
        SCOPED_TRACE(widget);
        const std::vector<std::uint32_t> before = own.entry(effect.name).words;
        bool has_moved = false;
        for (const float to : {0.0f, 1.0f, 0.37f, -3.0f, 4.0f}) {
            own.gui.drag(on_slider(own, widget, row, 0.5f), on_slider(own, widget, row, to));
            EXPECT_TRUE(check_words(row, words_of(own.entry(effect.name), row)));
            has_moved |= own.entry(effect.name).words != before;
        }
        // What depends on others may be refused, and is then told.
        const bool is_refused = !own.panels.messages().is_empty();
        EXPECT_TRUE(is_refused || has_moved);
        own.panels.messages().clear("edit");
        std::size_t steps = 0;
        for (; own.document.can_undo(); ++steps) own.document.undo();
        EXPECT_LE(steps, 5u);
        EXPECT_TRUE(is_refused || steps >= 4) << steps;
        EXPECT_EQ(own.entry(effect.name).words, before);
    });
}

TEST(PanelParameters, DoubleClickResets) {
    for_each_row([&](TestPanels& own, const EffectInfo& effect, const ParamInfo& row, const std::string& widget) {
        if (!is_number(row) || effect.conflict != nullptr) return;
        SCOPED_TRACE(widget);
        for (const std::string& place : {widget, widget + ".name"}) {
            own.gui.drag(on_slider(own, widget, row, 0.2f), on_slider(own, widget, row, 0.83f));
            EXPECT_NE(own.entry(effect.name).words,
                      std::vector(effect.parameters.defaults.begin(), effect.parameters.defaults.end()));
            // A hand that presses twice is not quite still.
            const ImVec2 hand = place == widget ? on_slider(own, widget, row, 0.9f) : own.place(place).center();
            own.gui.click(hand);
            own.gui.press();
            own.gui.move({hand.x + 2, hand.y});
            own.gui.release();
            EXPECT_TRUE(std::ranges::equal(own.entry(effect.name).words, effect.parameters.defaults)) << place;
        }
    });
}

TEST(PanelParameters, ChoicesAndToggles) {
    for_each_row([&](TestPanels& own, const EffectInfo& effect, const ParamInfo& row, const std::string& widget) {
        if (row.kind != Kind::Toggle && row.kind != Kind::Choice) return;
        SCOPED_TRACE(widget);
        const std::uint32_t before = own.entry(effect.name).words[row.word];
        own.click(widget);
        if (row.kind == Kind::Choice) {
            // The list opens below, the present one first under the mouse or not: the second from the top.
            own.gui.frame(2);
            const float line = ImGui::GetTextLineHeightWithSpacing();
            const ImVec2 below{own.place(widget).center().x,
                               own.place(widget).most.y + line * (before == 0 ? 1.8f : 0.8f)};
            own.gui.click(below);
        }
        EXPECT_NE(own.entry(effect.name).words[row.word], before);
        EXPECT_TRUE(check_words(row, words_of(own.entry(effect.name), row)));
        own.gui.double_click(own.place(widget + ".name").center());
        EXPECT_EQ(own.entry(effect.name).words[row.word], before);
    });
}

/// A row of a look of this test's own choice: the first of all effects that fits.
struct Found {
    const EffectInfo* effect = nullptr;
    const ParamInfo* row = nullptr;
    [[nodiscard]] std::string widget() const { return fmt::format("{}.{}", effect->name, row->name); }
};
Found find_row(const std::function<bool(const EffectInfo&, const ParamInfo&)>& fits) {
    for (const EffectInfo* const effect : all_effects())
        for (const ParamInfo& row : effect->parameters.rows)
            if (fits(*effect, row)) return {effect, &row};
    return {};
}

TEST(PanelParameters, CtrlClickTypes) {
    const Found found = find_row([](const EffectInfo& effect, const ParamInfo& row) {
        return row.kind == Kind::Float && row.range.max <= 16 && row.range.max > 0.5 && row.range.min <= 0 &&
               effect.conflict == nullptr;
    });
    ASSERT_NE(found.row, nullptr);
    TestPanels own(stack_of_all(), tall);
    own.select(found.effect->name);
    const auto type = [&](std::string_view text, ImGuiKey key) {
        own.gui.control(true);
        own.click(found.widget());
        own.gui.control(false);
        own.gui.type(text);
        own.gui.key(key);
        own.gui.frame();
    };
    const auto value = [&] { return std::bit_cast<float>(own.entry(found.effect->name).words[found.row->word]); };
    type("0.123456", ImGuiKey_Enter);
    EXPECT_EQ(value(), 0.123456f);
    type("0.3", ImGuiKey_Escape);
    EXPECT_EQ(value(), 0.123456f);
    type("100", ImGuiKey_Enter);
    EXPECT_EQ(value(), 0.123456f);
    ASSERT_EQ(own.panels.messages().texts().size(), 1u);
    EXPECT_NE(own.panels.messages().texts()[0].find(interval(*found.row)), std::string::npos);
    type("0.5", ImGuiKey_Enter);
    EXPECT_EQ(value(), 0.5f);
    EXPECT_TRUE(own.panels.messages().is_empty());
}

TEST(PanelParameters, MenuCopiesTextThatReadsBack) {
    for_each_row([&](TestPanels& own, const EffectInfo& effect, const ParamInfo& row, const std::string& widget) {
        if (row.kind == Kind::Resource) return;
        SCOPED_TRACE(widget);
        std::vector<std::uint32_t> given(own.entry(effect.name).words.begin() + row.word,
                                         own.entry(effect.name).words.begin() + row.word + row.words);
        if (row.kind == Kind::Curve) {
            const Curve curve{.count = 2, .x = {-0.5f, 1}, .y = {0.25f, 0}};
            const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Curve) / 4>>(curve);
            given.assign(words.begin(), words.end());
        }
        const std::string text = flag_text(row, given);
        const Result<ParamValue> value = parse_text(row, text);
        ASSERT_TRUE(value) << text;
        std::vector<std::uint32_t> words(effect.parameters.words(), 7u);
        ASSERT_TRUE(assign(row, words, *value));
        EXPECT_TRUE(std::ranges::equal(std::span(words).subspan(row.word, row.words), given));
    });
    const Found found = find_row([](const EffectInfo&, const ParamInfo& row) { return row.kind == Kind::Float; });
    TestPanels own(stack_of_all(), tall);
    own.select(found.effect->name);
    const std::string toml = format(*found.row, own.entry(found.effect->name).words);
    const auto pick = [&](float line) {
        own.gui.click(own.place(found.widget()).center(), 1);
        own.gui.frame(2);
        const ImVec2 corner = own.place(found.widget()).center();
        own.gui.click({corner.x + 20,
                       corner.y + ImGui::GetStyle().WindowPadding.y + line * ImGui::GetTextLineHeightWithSpacing()});
        return own.gui.clipboard;
    };
    EXPECT_EQ(pick(1.8f), fmt::format("--set {}={}", found.widget(), toml));
    EXPECT_EQ(pick(2.8f), fmt::format("{} = {}", found.row->name, toml));
}

TEST(PanelParameters, CurvesTakePointsAndKeepTheirOrder) {
    const Found found = find_row([](const EffectInfo&, const ParamInfo& row) { return row.kind == Kind::Curve; });
    if (found.row == nullptr) GTEST_SKIP() << "no effect of this build has a curve";
    TestPanels own(stack_of_all(), tall);
    own.select(found.effect->name);
    const auto count = [&] { return own.entry(found.effect->name).words[found.row->word]; };
    const WidgetPlace place = own.place(found.widget());
    const auto at = [&](float x, float y) {
        return ImVec2{place.least.x + x * (place.most.x - place.least.x), place.least.y + y * 130};
    };
    for (std::uint32_t i = 0; i < 20; ++i) {
        own.gui.click(at(0.02f + 0.048f * static_cast<float>(i * 7 % 20), 0.1f + 0.04f * static_cast<float>(i)));
        EXPECT_EQ(count(), std::min<std::uint32_t>(i + 1, Curve::capacity));
        EXPECT_TRUE(check_words(*found.row, words_of(own.entry(found.effect->name), *found.row)));
    }
    // A point that is dragged past all others, and out.
    own.gui.drag(at(0.02f, 0.1f), {5000, -300});
    own.gui.drag(at(0.02f + 0.048f * 18, 0.1f + 0.04f * 14), {-5000, 3000});
    EXPECT_TRUE(own.panels.messages().is_empty());
    EXPECT_TRUE(check_words(*found.row, words_of(own.entry(found.effect->name), *found.row)));
    const std::uint32_t before = count();
    own.gui.double_click(at(0.02f + 0.048f * 7, 0.14f));
    EXPECT_EQ(count(), before - 1);
    own.gui.double_click(own.place(found.widget() + ".name").center());
    EXPECT_EQ(count(), 0u);
}

TEST(PanelParameters, ColorsAreShownEncodedAndStayLinear) {
    const Found found = find_row([](const EffectInfo& effect, const ParamInfo& row) {
        return row.kind == Kind::Rgb && row.range.min >= 0 && row.range.max >= 1 && effect.conflict == nullptr;
    });
    ASSERT_NE(found.row, nullptr);
    Look look = stack_of_all();
    for (LookEntry& entry : look.entries)
        if (entry.effect == found.effect)
            for (const std::uint32_t i : {0u, 1u, 2u})
                entry.words[found.row->word + i] = std::bit_cast<std::uint32_t>(0.18f);
    TestPanels own(std::move(look), tall);
    own.select(found.effect->name);
    const WidgetPlace place = own.place(found.widget());
    const GuiPicture picture = own.gui.picture();
    const std::uint8_t* const swatch =
        picture.at(static_cast<int>(place.least.x) + 10, static_cast<int>(place.center().y));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(swatch[i], 118, 1);  // 18 % grey in sRGB
    own.gui.click({place.least.x + 10, place.center().y});
    own.gui.frame(3);
    // In the picker's square: another colour, of the row's interval.
    own.gui.click({place.least.x + 60, place.most.y + 60});
    const std::vector<std::uint32_t> words = own.entry(found.effect->name).words;
    EXPECT_NE(std::bit_cast<float>(words[found.row->word]), 0.18f);
    EXPECT_TRUE(check_words(*found.row, words_of(own.entry(found.effect->name), *found.row)));
}

TEST(PanelParameters, EntryStateAndWires) {
    TestPanels own(stack_of_all(), tall);
    const std::vector<std::string> names = own.names();
    const std::string last = names.back();
    own.select(last);
    for (const char* const widget : {"opacity", "blend", "scale", "format", "input", "mask"})
        EXPECT_TRUE(own.has(fmt::format("{}.{}", last, widget))) << widget;
    own.gui.drag(own.place(last + ".opacity").center(), own.place(last + ".opacity").least);
    EXPECT_EQ(own.entry(last).state.opacity, 0);
    own.gui.double_click(own.place(last + ".opacity.name").center());
    EXPECT_EQ(own.entry(last).state.opacity, 1);
    own.click(last + ".mask");
    own.gui.frame(2);
    own.click("wire/" + names[0]);
    EXPECT_EQ(own.entry(last).mask, names[0]);
    EXPECT_EQ(own.entry(names[0]).output, names[0]);
    own.panels.undo();
    EXPECT_EQ(own.entry(last).mask, "");
    EXPECT_EQ(own.entry(names[0]).output, "");
}

}  // namespace
}  // namespace darkroom::panels
