// SPDX-License-Identifier: MIT
// What is spliced into a text: the edited values, and nothing else.

#include <gtest/gtest.h>

#include <darkroom/effects.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/param_text.hpp"
#include "edit/compare.hpp"
#include "edit/document.hpp"
#include "edit/splice.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::edit {
namespace {

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> shipped_files() {
    std::vector<std::filesystem::path> out;
    for (const char* const folder : {DARKROOM_SOURCE_FOLDER "/looks", DARKROOM_SOURCE_FOLDER "/scenes"})
        for (const auto& file : std::filesystem::directory_iterator(folder))
            if (file.path().extension() == ".toml") out.push_back(file.path());
    std::ranges::sort(out);
    return out;
}

LookOptions options_of(const std::filesystem::path& path) {
    return {.is_scene = path.filename().string().ends_with(".scene.toml"), .folder = path.parent_path()};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::stringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::string key_of(const std::string& line) {
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string::npos ? "" : line.substr(first, line.find_first_of(" =", first) - first);
}

/// The lines that are not the same, as "key" or, where there is one more, "+key"; anything else as it is.
std::vector<std::string> changed_lines(const std::string& before, const std::string& after) {
    const std::vector<std::string> a = lines_of(before), b = lines_of(after);
    std::vector<std::string> out;
    std::size_t i = 0, k = 0;
    while (i < a.size() || k < b.size()) {
        if (i < a.size() && k < b.size() && a[i] == b[k]) {
            ++i, ++k;
        } else if (i < a.size() && k < b.size() && key_of(a[i]) == key_of(b[k]) && !key_of(a[i]).empty()) {
            out.push_back(key_of(b[k]));
            ++i, ++k;
        } else if (b.size() - k > a.size() - i) {
            out.push_back("+" + key_of(b[k++]));
        } else {
            out.push_back(i < a.size() ? "-" + a[i++] : "+" + b[k++]);
        }
    }
    return out;
}

class Splice : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "bloom", "vignette", "fog", "tonemap", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
    static Look read(const std::string& text, const LookOptions& options = {.is_scene = true}) {
        Result<Look> look = parse_look(text, "a.toml", options);
        EXPECT_TRUE(look) << look.error().text << "\n" << text;
        return look ? std::move(*look) : Look{};
    }
    /// The text after an edit; it reads as what was edited.
    static std::string edited(const std::string& text, const std::function<Result<>(Look&)>& change) {
        const Look was = read(text);
        Look is = was;
        const Result<> done = change(is);
        EXPECT_TRUE(done) << done.error().text;
        const Result<std::string> out = splice_look(text, was, is);
        EXPECT_TRUE(out) << out.error().text;
        if (!out) return {};
        EXPECT_TRUE(says_same(read(*out), is)) << *out;
        return *out;
    }
    static Result<> set(Look& look, std::string_view entry, std::string_view row, const std::vector<float>& numbers) {
        std::vector<std::uint32_t> words;
        for (const float number : numbers) words.push_back(std::bit_cast<std::uint32_t>(number));
        return set_value(look, entry, row, words);
    }
    static std::string exposed(const std::string& text, float value = 2) {
        return edited(text, [&](Look& look) { return set(look, "exposure", "exposure", {value}); });
    }
};

TEST_F(Splice, RandomValuesOfEveryShippedFileChangeTheirOwnBytesAlone) {
    std::mt19937 random(1);
    std::size_t files = 0;
    for (const std::filesystem::path& path : shipped_files()) {
        const LookOptions options = options_of(path);
        std::string text = text_of(path);
        const auto first = parse_look(text, path.string(), options);
        if (!first) continue;  // names an effect that this build has not
        ++files;
        Look look = *first;
        for (int edit = 0; edit < 1000; ++edit) {
            const test::RandomEdit one = test::random_value_edit(random, look);
            Look next = look;
            if (!test::apply_edit(next, one)) continue;  // its effect's values contradict each other
            const Result<std::string> spliced = splice_look(text, look, next);
            ASSERT_TRUE(spliced) << spliced.error().text;
            const LookEntry& entry = *find_entry(next, one.entry);
            const bool is_table = next.is_flat || entry.is_of_ui;
            const std::string key = is_table ? flat_key(entry.effect->name, one.row) : one.row;
            const std::string toggle = is_table ? flat_key(entry.effect->name, "enabled") : "enabled";
            for (const std::string& line : changed_lines(text, *spliced)) {
                const bool is_header = line == "+" || line == "+[post_process]" || line == "+[ui]";
                ASSERT_TRUE(line == key || line == "+" + key || line == toggle || line == "+" + toggle || is_header)
                    << path << " " << one.entry << "." << one.row << ": " << line << "\n"
                    << *spliced;
            }
            if (edit % 25 == 0 || edit == 999) {
                const auto again = parse_look(*spliced, path.string(), options);
                ASSERT_TRUE(again) << again.error().text;
                ASSERT_TRUE(says_same(*again, next)) << path << " " << one.entry << "." << one.row << "\n" << *spliced;
            }
            look = std::move(next);
            text = *spliced;
        }
    }
    EXPECT_GE(files, 5u);
}

TEST_F(Splice, RandomRestructuringOfEveryShippedFileReadsAsTheEditedLook) {
    std::mt19937 random(2);
    std::size_t count = 0;
    for (const std::filesystem::path& path : shipped_files()) {
        const LookOptions options = options_of(path);
        auto first = parse_look(text_of(path), path.string(), options);
        if (!first) continue;
        LookDocument document(std::move(*first), options);
        std::string text = text_of(path);
        Look written = document.look();
        for (int edit = 0; edit < 100; ++edit) {
            const bool is_value = test::below(random, 2) == 0;
            const auto change = [&](Look& look) {
                if (is_value && !look.entries.empty())
                    return test::apply_edit(look, test::random_value_edit(random, look));
                return test::random_restructuring(random, look);
            };
            if (test::below(random, 8) == 0)
                document.undo();
            else
                (void)document.edit("Something", change);
            if (test::below(random, 3) == 0) continue;  // several at once
            const Result<std::string> spliced = splice_look(text, written, document.look());
            ASSERT_TRUE(spliced) << path << ": " << spliced.error().text << "\n" << text;
            const auto again = parse_look(*spliced, path.string(), options);
            ASSERT_TRUE(again) << again.error().text << "\n" << text << "\n=====\n" << *spliced;
            ASSERT_TRUE(says_same(*again, document.look())) << path << "\n"
                                                            << text << "\n=====\n"
                                                            << *spliced << "\n=====\n"
                                                            << write_look(document.look());
            text = *spliced;
            written = document.look();
            ++count;
        }
    }
    EXPECT_GE(count, 100u);
}

}  // namespace
}  // namespace darkroom::edit
