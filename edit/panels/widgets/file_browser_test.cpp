// SPDX-License-Identifier: MIT
#include "panels/widgets/file_browser.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "panels/test_gui.hpp"

namespace darkroom::panels {
namespace {

class PanelFiles : public ::testing::Test {
  protected:
    PanelFiles() {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_ / "tables" / "film");
        for (const char* const name : {"b.toml", "A.toml", "notes.txt", ".hidden.toml", "tables/print.cube"})
            std::ofstream(folder_ / name) << name;
        gui_.draw = [this] { browser_.draw(); };
    }
    ~PanelFiles() override { std::filesystem::remove_all(folder_); }

    void open(bool is_saving, std::vector<std::string> extensions = {".toml"}) {
        browser_.open({.title = "A look",
                       .start = folder_,
                       .extensions = std::move(extensions),
                       .is_saving = is_saving,
                       .then = [this](const std::filesystem::path& file) { chosen_.push_back(file); }});
        gui_.frame(3);
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("darkroom_panel_files_" + std::to_string(::getpid()));
    TestGui gui_{1280, 720, 1};
    FileBrowser browser_;
    std::vector<std::filesystem::path> chosen_;
};

TEST_F(PanelFiles, ListsFoldersFirstAndHidesWhatBeginsWithADot) {
    open(false);
    std::vector<std::string> names;
    for (const FileBrowser::Entry& entry : browser_.entries()) names.push_back(entry.shown);
    EXPECT_EQ(names, (std::vector<std::string>{"tables", "A.toml", "b.toml", "notes.txt"}));
    gui_.show("files");
}

TEST_F(PanelFiles, KeysChoose) {
    open(false);
    gui_.key(ImGuiKey_DownArrow);
    gui_.key(ImGuiKey_DownArrow);
    gui_.key(ImGuiKey_DownArrow);
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(chosen_, std::vector{folder_ / "b.toml"});
    EXPECT_FALSE(browser_.is_open());
    open(false);
    gui_.type("a.to");
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(chosen_.back(), folder_ / "A.toml");
    open(false, {".cube"});
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(browser_.folder(), folder_ / "tables");
    gui_.frame(2);
    gui_.type("x");
    gui_.key(ImGuiKey_Backspace);
    EXPECT_EQ(browser_.folder(), folder_ / "tables");
    gui_.key(ImGuiKey_Backspace);
    EXPECT_EQ(browser_.folder(), folder_);
    gui_.key(ImGuiKey_Escape);
    EXPECT_FALSE(browser_.is_open());
    EXPECT_EQ(chosen_.size(), 2u);
}

TEST_F(PanelFiles, APathThatIsTypedIsTaken) {
    open(false, {".cube"});
    gui_.type("tables/none.cube");
    gui_.key(ImGuiKey_Enter);
    EXPECT_TRUE(browser_.is_open() && chosen_.empty());
    open(false, {".cube"});
    gui_.type((folder_ / "tables/print.cube").string());
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(chosen_, std::vector{folder_ / "tables/print.cube"});
    open(false);
    gui_.type("tables/film");
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(browser_.folder(), folder_ / "tables" / "film");
}

TEST_F(PanelFiles, SavingNamesAndAsksBeforeItReplaces) {
    open(true);
    gui_.type("new");
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(chosen_, std::vector{folder_ / "new.toml"});
    open(true);
    gui_.type("b.toml");
    gui_.key(ImGuiKey_Enter);
    EXPECT_TRUE(browser_.is_open());
    EXPECT_EQ(chosen_.size(), 1u);
    gui_.frame();
    gui_.key(ImGuiKey_Enter);
    EXPECT_EQ(chosen_.back(), folder_ / "b.toml");
    EXPECT_FALSE(browser_.is_open());
}

TEST_F(PanelFiles, AFolderThatCannotBeReadIsTold) {
    browser_.open({.title = "A look", .start = folder_ / "none" / "look.toml"});
    gui_.frame(3);
    EXPECT_TRUE(browser_.entries().empty());
    gui_.key(ImGuiKey_Backspace);
    EXPECT_EQ(browser_.folder(), folder_);
    EXPECT_FALSE(browser_.entries().empty());
}

}  // namespace
}  // namespace darkroom::panels
