// SPDX-License-Identifier: MIT
// The panels over a look's file: undo, saving, and the files that it names.
#include "panels/panels.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "panels/look/test_look_panels.hpp"

namespace darkroom::panels {
namespace {

class PanelDocument : public ::testing::Test {
  protected:
    PanelDocument() { std::filesystem::create_directories(folder_); }
    ~PanelDocument() override { std::filesystem::remove_all(folder_); }

    /// The first effect of this build that has a place in the flat table and a parameter of this kind.
    static std::pair<const EffectInfo*, const ParamInfo*> find(Kind kind) {
        for (const EffectInfo* const effect : all_effects())
            for (const ParamInfo& row : effect->parameters.rows)
                if (effect->flat.documented >= 0 && row.kind == kind && effect->conflict == nullptr &&
                    !effect->flat.is_of_ui())
                    return {effect, &row};
        return {};
    }
    [[nodiscard]] std::string text(const char* file) const {
        std::ostringstream out;
        out << std::ifstream(folder_ / file).rdbuf();
        return out.str();
    }

    /// Gives the panels a document of this text, in the file a.toml.
    void open(TestPanels& own, const std::string& written) const {
        std::ofstream(folder_ / "a.toml") << written;
        auto opened = edit::LookDocument::open(folder_ / "a.toml", {});
        ASSERT_TRUE(opened) << opened.error().text;
        own.document = std::move(*opened);
        own.panels.show(own.document);
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("darkroom_panel_document_" + std::to_string(::getpid()));
};

TEST_F(PanelDocument, SavesWhatASliderChangedAndNothingElse) {
    const auto [effect, row] = find(Kind::Float);
    ASSERT_NE(effect, nullptr);
    const std::string before = "# A look.\n[post_process]   # flat\nenabled = true\n";
    TestPanels own(default_look(), {1280, 4000});
    open(own, before);
    own.select(effect->name);
    const std::string widget = fmt::format("{}.{}", effect->name, row->name);
    const WidgetPlace place = own.place(widget);
    own.gui.drag(place.center(), {place.least.x + 0.7f * (place.most.x - place.least.x), place.center().y});
    EXPECT_TRUE(own.document.is_changed());
    own.click("bar/save");
    EXPECT_TRUE(own.panels.messages().is_empty());
    EXPECT_FALSE(own.document.is_changed());
    const std::string after = text("a.toml");
    EXPECT_EQ(after.substr(0, before.size()), before);
    EXPECT_EQ(std::ranges::count(after, '\n'), std::ranges::count(before, '\n') + 1);
    own.gui.drag(place.center(), place.least);
    own.click("bar/revert");
    EXPECT_FALSE(own.document.is_changed());
    EXPECT_EQ(own.document.undo_name(), "revert");
    EXPECT_EQ(own.panels.selected(), effect->name);
    // Changed by others: told, and not overwritten.
    own.panels.undo();
    std::ofstream(folder_ / "a.toml") << "# Another's.\n";
    own.click("bar/save");
    EXPECT_EQ(own.panels.messages().texts().size(), 1u);
    EXPECT_EQ(text("a.toml"), "# Another's.\n");
}

TEST_F(PanelDocument, SavesUnderANewName) {
    TestPanels own(default_look());
    std::filesystem::current_path(folder_);
    own.click("bar/save");
    own.gui.frame(3);
    ASSERT_TRUE(own.panels.files().is_open());
    own.gui.type("new");
    own.gui.key(ImGuiKey_Enter);
    EXPECT_TRUE(own.panels.messages().is_empty());
    EXPECT_EQ(own.document.file().filename(), "new.toml");
    EXPECT_TRUE(read_look(folder_ / "new.toml"));
    std::filesystem::current_path("/");
}

TEST_F(PanelDocument, FilesAreChosenAndTakenAway) {
    const auto [effect, row] = find(Kind::Resource);
    if (effect == nullptr) GTEST_SKIP() << "no effect of this build names a file";
    std::ofstream(folder_ / "warm.cube") << "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
    std::ofstream(folder_ / "broken.cube") << "LUT_3D_SIZE 2\n0 0\n";
    TestPanels own(default_look(), {1280, 4000});
    open(own, "[post_process]\n");
    own.select(effect->name);
    const std::string widget = fmt::format("{}.{}", effect->name, row->name);
    const auto choose = [&](const char* name) {
        own.gui.click({own.place(widget).least.x + 20, own.place(widget).center().y});
        own.gui.frame(3);
        own.gui.type(name);
        own.gui.key(ImGuiKey_Enter);
        own.gui.frame(2);
    };
    choose("broken");
    ASSERT_EQ(own.panels.messages().texts().size(), 1u);
    EXPECT_NE(own.panels.messages().texts()[0].find("broken.cube"), std::string::npos);
    EXPECT_EQ(own.entry(effect->name).words[row->word], 0u);
    choose("warm");
    EXPECT_TRUE(own.panels.messages().is_empty());
    EXPECT_NE(own.entry(effect->name).words[row->word], 0u);
    ASSERT_EQ(own.entry(effect->name).resources.size(), 1u);
    EXPECT_EQ(own.entry(effect->name).resources[0].file, "warm.cube");
    own.gui.click({own.place(widget).most.x - 8, own.place(widget).center().y});
    EXPECT_EQ(own.entry(effect->name).words[row->word], 0u);
    own.panels.undo();
    EXPECT_NE(own.entry(effect->name).words[row->word], 0u);
}

TEST_F(PanelDocument, PulsesLayersAndTheInterfaceAreEditedAndSaved) {
    const auto [effect, row] = find(Kind::Float);
    ASSERT_NE(effect, nullptr);
    const std::string moved = fmt::format("{}.{}", effect->name, row->name);
    TestPanels own(default_look(), {1280, 4000});
    open(own, fmt::format("[[pulse]]\nevent = \"hit\"\nparameter = \"{0}\"\namount = 0.0 # pulse\n\n"
                          "[[layer]]\nname = \"night\"\nweight = 0.0 # layer\nvalues = {{ \"{0}\" = {1} }}\n\n"
                          "[ui]\ngame = {{ health = 80, is_armed = false }} # game\n",
                          moved, row->range.min));
    own.gui.frame(2);
    const auto slide = [&](const std::string& widget) {
        const WidgetPlace place = own.place(widget);
        own.gui.drag(place.center(), {place.least.x + 0.9F * (place.most.x - place.least.x), place.center().y});
    };
    own.click("stack/pulse/0");
    own.gui.frame(2);
    slide("pulse/0.amount");
    EXPECT_GT(own.document.look().pulses[0].amount[0], 0);
    own.click("stack/layer/night");
    own.gui.frame(2);
    slide("layer/night.weight");
    slide("layer/night." + moved);
    EXPECT_GT(own.document.look().layers[0].state.weight, 0.5F);
    EXPECT_GT(std::bit_cast<float>(own.document.look().layers[0].values[0].words[0]), row->range.min);
    own.gui.show("layer");
    own.click("stack/interface");
    own.gui.frame(2);
    own.click("game/is_armed");
    slide("game/health");
    EXPECT_EQ(own.document.look().ui->game.at("is_armed"), GameValue(true));
    EXPECT_NE(own.document.look().ui->game.at("health"), GameValue(80.0));
    own.gui.show("interface");
    own.click("bar/save");
    EXPECT_TRUE(own.panels.messages().is_empty());
    EXPECT_FALSE(own.document.is_changed());
    for (const char* const comment : {"# pulse\n", "# layer\n", "# game\n"})
        EXPECT_NE(text("a.toml").find(comment), std::string::npos) << text("a.toml");
    const auto again = read_look(folder_ / "a.toml");
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_EQ(write_look(*again), write_look(own.document.look()));
    for (int i = 0; i < 5; ++i) own.panels.undo();
    EXPECT_EQ(own.document.look().pulses[0].amount[0], 0);
    EXPECT_FALSE(own.document.can_undo());
    // What is selected may go.
    own.click("stack/layer/night");
    open(own, "[post_process]\n");
    own.gui.frame(2);
    EXPECT_FALSE(own.panels.places().empty());
}

}  // namespace
}  // namespace darkroom::panels
