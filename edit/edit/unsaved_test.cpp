// SPDX-License-Identifier: MIT
// What is not saved yet as a text that another document of the same file takes up.
#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <fstream>

#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::edit {
namespace {

namespace fs = std::filesystem;

class DocumentUnsaved : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "fog", "exposure"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("darkroom_unsaved_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    fs::path write(const std::string& text) {
        std::ofstream(folder_ / "my.toml", std::ios::binary) << text;
        return folder_ / "my.toml";
    }
    [[nodiscard]] std::string text() const {
        std::ifstream file(folder_ / "my.toml", std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    static LookDocument open(const fs::path& path) {
        Result<LookDocument> out = LookDocument::open(path, {});
        EXPECT_TRUE(out) << out.error().text;
        return out ? std::move(*out) : LookDocument();
    }

    fs::path folder_;
};

constexpr const char* flat_text =
    "# mine\n\n[post_process]\nbloom_intensity = 0.20  # it glows\n\n\nfog_density = 0.05\n";
constexpr const char* stack_text =
    "[[stack]]\neffect = \"bloom\"  # first\n\n[[stack]]\neffect = \"exposure\"\nexposure = 2.0\n";

TEST_F(DocumentUnsaved, IsTakenUpAsOneStepAndSavedAsItWouldHaveBeen) {
    std::mt19937 random(3);
    for (const char* const before : {flat_text, stack_text})
        for (int round = 0; round < 20; ++round) {
            const fs::path file = write(before);
            LookDocument document = open(file);
            for (int i = 0; i < 6; ++i)
                static_cast<void>(document.edit(
                    "edit", [&](Look& look) { return test::apply_edit(look, test::random_value_edit(random, look)); }));
            const Result<std::string> unsaved = document.unsaved_text();
            ASSERT_TRUE(unsaved) << unsaved.error().text;
            EXPECT_EQ(text(), before) << "nothing is written";

            LookDocument again = open(file);
            ASSERT_TRUE(again.take_unsaved(*unsaved));
            EXPECT_EQ(again.is_changed(), document.is_changed());
            ASSERT_TRUE(again.save());
            EXPECT_EQ(text(), *unsaved);
            while (again.can_undo()) again.undo();
            ASSERT_TRUE(again.save());
            EXPECT_EQ(text(), before);
        }
}

TEST_F(DocumentUnsaved, WhatIsNoLookChangesNothing) {
    LookDocument document = open(write(flat_text));
    EXPECT_FALSE(document.take_unsaved("[post_process\n"));
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.is_changed());
}

TEST_F(DocumentUnsaved, ALookWithoutAFileHasATextToo) {
    LookDocument document;
    const std::array words{std::bit_cast<std::uint32_t>(2.0f)};
    ASSERT_TRUE(document.edit("exposure", [&](Look& look) { return set_value(look, "exposure", "exposure", words); }));
    const Result<std::string> unsaved = document.unsaved_text();
    ASSERT_TRUE(unsaved) << unsaved.error().text;
    LookDocument again;
    ASSERT_TRUE(again.take_unsaved(*unsaved));
    EXPECT_TRUE(again.is_changed());
    again.undo();
    EXPECT_FALSE(again.is_changed());
}

TEST_F(DocumentUnsaved, APulseMayGoAlongWithItsEntry) {
    const fs::path file = write(
        "[[pulse]]\nevent = \"hit\"\nparameter = \"exposure.exposure\"\namount = 1\n\n"
        "[[stack]]\neffect = \"bloom\"\n\n[[stack]]\neffect = \"exposure\"\n");
    LookDocument document = open(file);
    ASSERT_EQ(document.look().pulses.size(), 1U);
    Result<> done = document.edit("both", [](Look& look) -> Result<> {
        look.pulses.clear();
        look.entries.pop_back();
        return {};
    });
    ASSERT_TRUE(done) << done.error().text;
    const Result<std::string> unsaved = document.unsaved_text();
    ASSERT_TRUE(unsaved) << unsaved.error().text;
    LookDocument next = open(file);
    done = next.take_unsaved(*unsaved);
    ASSERT_TRUE(done) << done.error().text;
    EXPECT_TRUE(says_same(next.look(), document.look()));
    next.undo();
    EXPECT_EQ(next.look().pulses.size(), 1U);
    EXPECT_FALSE(next.is_changed());
}

}  // namespace
}  // namespace darkroom::edit
