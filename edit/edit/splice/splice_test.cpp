// SPDX-License-Identifier: MIT
// What is spliced into a text: the edited values, and nothing else.

#include <gtest/gtest.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/text/param_text.hpp"
#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "edit/splice/splice.hpp"
#include "edit/splice/toml_editor.hpp"
#include "edit/test_random_edits.hpp"
#include "tests/places.hpp"

namespace darkroom::edit {
namespace {

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> shipped_files() {
    std::vector<std::filesystem::path> out;
    for (const std::string& folder : {std::string(darkroom::test::source_folder) + "/looks",
                                      std::string(darkroom::test::source_folder) + "/scenes"})
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

TEST_F(Splice, ValuesAreReplacedWhereTheyStand) {
    const std::string head = "\xEF\xBB\xBF# \xC3\xA4\n\n",
                      tail = "  # \xE2\x82\xAC, behind\r\n[other]\r\nexposure = 7\r\n";
    EXPECT_EQ(exposed(head + "[post_process]\r\n\texposure=1" + tail),
              head + "[post_process]\r\n\texposure=2.0" + tail);
    EXPECT_EQ(exposed("post_process.exposure = 0x1_0\nformat = 1\n"), "post_process.exposure = 2.0\nformat = 1\n");
    EXPECT_EQ(exposed("post_process = { exposure = 1_0.5_0 , bloom_intensity = 0.1 } # all\n"),
              "post_process = { exposure = 2.0 , bloom_intensity = 0.1 } # all\n");
    EXPECT_EQ(exposed("[ \"post_process\" ]\n\"expo\\u0073ure\" = +1e0"),
              "[ \"post_process\" ]\n\"expo\\u0073ure\" = 2.0");
    EXPECT_EQ(exposed("['post_process']#\n'exposure' = 1 #1"), "['post_process']#\n'exposure' = 2.0 #1");
    EXPECT_EQ(exposed("[[stack]]\neffect='encode'\n[[stack]]\n'exposure'=1#\neffect = \"\"\"exposure\"\"\"\n"),
              "[[stack]]\neffect='encode'\n[[stack]]\n'exposure'=2.0#\neffect = \"\"\"exposure\"\"\"\n");
    // What reads as the value already stays as it is written.
    EXPECT_EQ(exposed("[post_process]\nexposure = 200e-2\n"), "[post_process]\nexposure = 200e-2\n");
}

TEST_F(Splice, NumbersOfAValueAreReplacedOneByOne) {
    EXPECT_EQ(edited("[post_process]\nui_layers = 1\nfog_color = [0, 0, 1]\n",
                     [](Look& look) {
                         return set(look, "fog", "color", {-0.0f, 0, 1});
                     }),
              "[post_process]\nui_layers = 1\nfog_color = [-0.0, 0, 1]\n");
    const auto colored = [](const std::string& text) {
        return edited(text, [](Look& look) { return set(look, "fog", "color", {0.5f, 0.25f, 1}); });
    };
    EXPECT_EQ(colored("[post_process]\nfog_color = [ 5e-1, # red\n  0.75,\n  1, ]\n"),
              "[post_process]\nfog_color = [ 5e-1, # red\n  0.25,\n  1, ]\n");
    EXPECT_EQ(colored("[post_process]\nfog_color = { b = 1, g = 0, r = 0.5 }\n"),
              "[post_process]\nfog_color = { b = 1, g = 0.25, r = 0.5 }\n");
    EXPECT_EQ(colored("[post_process]\nfog_color.r = 0\nfog_color.g = 0\nfog_color.b = 0\nexposure = 1\n"),
              "[post_process]\nfog_color.r = 0.5\nfog_color.g = 0.25\nfog_color.b = 1.0\nexposure = 1\n");
    EXPECT_EQ(colored("[post_process.fog_color]\nr = 0\ng = 0\nb = 0\n"),
              "[post_process.fog_color]\nr = 0.5\ng = 0.25\nb = 1.0\n");
    // One that was refused is written whole.
    EXPECT_EQ(colored("[post_process]\nfog_color = [-1, 0.25, 9]\n"), "[post_process]\nfog_color = [0.5, 0.25, 1.0]\n");
}

TEST_F(Splice, NewKeysComeBehindThoseOfTheirEffect) {
    EXPECT_EQ(exposed("[post_process]\n  bloom_intensity = 0.1\n\n[other]\na = 1\n"),
              "[post_process]\n  bloom_intensity = 0.1\n  exposure = 2.0\n\n[other]\na = 1\n");
    const auto blooming = [](const std::string& text) {
        return edited(text, [](Look& look) { return set(look, "bloom", "threshold", {2}); });
    };
    EXPECT_EQ(blooming("[post_process]\nbloom_intensity = 0.1 # glow\nexposure = 2\n"),
              "[post_process]\nbloom_intensity = 0.1 # glow\nbloom_threshold = 2.0\nexposure = 2\n");
    EXPECT_EQ(blooming("[post_process]\nfog_color = [\n 1,\n 1,\n 1]\r\n"),
              "[post_process]\nfog_color = [\n 1,\n 1,\n 1]\r\nbloom_threshold = 2.0\n");
    EXPECT_EQ(blooming("[post_process]"), "[post_process]\nbloom_threshold = 2.0");
    // A table that is new says the order that held without it.
    EXPECT_EQ(blooming(""), "[post_process]\nbloom_threshold = 2.0\norder = \"scene_linear\"\n");
    EXPECT_EQ(blooming("a = 1\r\n[b]"),
              "a = 1\r\n[b]\r\n\r\n[post_process]\r\nbloom_threshold = 2.0\r\norder = \"scene_linear\"\r\n");
    EXPECT_EQ(blooming("post_process = {}\n"), "post_process = { bloom_threshold = 2.0 }\n");
    EXPECT_EQ(blooming("post_process = { exposure = 2 }\n"),
              "post_process = { exposure = 2, bloom_threshold = 2.0 }\n");
    EXPECT_EQ(blooming("post_process.exposure = 2\nformat = 1\n"),
              "post_process.exposure = 2\npost_process.bloom_threshold = 2.0\nformat = 1\n");
    EXPECT_EQ(blooming("[post_process.fog_color]\nr = 0\ng = 0\nb = 0\n"),
              "[post_process.fog_color]\nr = 0\ng = 0\nb = 0\n\n[post_process]\nbloom_threshold = 2.0\n");
    EXPECT_EQ(edited("[[stack]]\n  effect = \"fog\"\n  [stack.color]\n  r = 0\n  g = 0\n  b = 0\n",
                     [](Look& look) { return set(look, "fog", "density", {0.5f}); }),
              "[[stack]]\n  effect = \"fog\"\n  density = 0.5\n  [stack.color]\n  r = 0\n  g = 0\n  b = 0\n");
}

// In the flat table an amount switches its effect, unless the table says so itself.
TEST_F(Splice, SwitchesAreWrittenWhereAmountsDoNotSayThem) {
    const auto switched = [](const std::string& text, bool is_on) {
        const std::array words{is_on ? 1u : 0u};
        return edited(text, [&](Look& look) { return set_state(look, "vignette", "enabled", words); });
    };
    EXPECT_EQ(switched("[post_process]\nvignette_enabled = true\n", false),
              "[post_process]\nvignette_enabled = false\n");
    EXPECT_EQ(switched("[post_process]\nvignette_intensity = 0.5\n", false),
              "[post_process]\nvignette_intensity = 0.5\nvignette_enabled = false\n");
    EXPECT_EQ(switched("[post_process]\nvignette_smoothness = 3\n", true),
              "[post_process]\nvignette_smoothness = 3\nvignette_enabled = true\n");
    const auto turned = [](const std::string& text, float intensity) {
        return edited(text, [&](Look& look) { return set(look, "vignette", "intensity", {intensity}); });
    };
    EXPECT_EQ(turned("[post_process]\nvignette_intensity = 0.5\n", 0), "[post_process]\nvignette_intensity = 0.0\n");
    EXPECT_EQ(turned("[post_process]\n", 0.5f), "[post_process]\nvignette_intensity = 0.5\n");
    EXPECT_EQ(turned("[post_process]\nvignette_enabled = true\n", 0),
              "[post_process]\nvignette_enabled = false\nvignette_intensity = 0.0\n");
}

const std::string blocks =
    "# a look\n\nformat = 1\n\n# expose\n[[stack]]\neffect = \"exposure\" # e\n# off: exposure = 2\n\n"
    "[[stack]]\neffect = \"fog\"\n[stack.color]\nr = 0\ng = 0\nb = 0\n\n\n"
    "# tone\n# map\n[[stack]]\neffect = \"tonemap\"\n\n[other]\na = 1\n";

TEST_F(Splice, EntriesMoveAsBlocksWithTheirComments) {
    EXPECT_EQ(edited(blocks, [](Look& look) { return move_entry(look, "tonemap", "exposure"); }),
              "# a look\n\nformat = 1\n\n# tone\n# map\n[[stack]]\neffect = \"tonemap\"\n\n"
              "# expose\n[[stack]]\neffect = \"exposure\" # e\n# off: exposure = 2\n\n"
              "[[stack]]\neffect = \"fog\"\n[stack.color]\nr = 0\ng = 0\nb = 0\n\n[other]\na = 1\n");
    EXPECT_EQ(edited(blocks, [](Look& look) { return remove_entry(look, "exposure"); }),
              "# a look\n\nformat = 1\n\n[[stack]]\neffect = \"fog\"\n[stack.color]\nr = 0\ng = 0\nb = 0\n\n\n"
              "# tone\n# map\n[[stack]]\neffect = \"tonemap\"\n\n[other]\na = 1\n");
    EXPECT_EQ(edited("[[stack]]\neffect = \"exposure\"\n\n[[stack]]\neffect = \"tonemap\"",
                     [](Look& look) { return move_entry(look, "tonemap", "exposure"); }),
              "[[stack]]\neffect = \"tonemap\"\n\n[[stack]]\neffect = \"exposure\"");
    EXPECT_EQ(edited("stack = [ { effect = \"exposure\" }, { effect = \"tonemap\", curve = 'hable' } ]\n",
                     [](Look& look) { return move_entry(look, "tonemap", "exposure"); }),
              "stack = [ { effect = \"tonemap\", curve = 'hable' }, { effect = \"exposure\" } ]\n");
}

TEST_F(Splice, NewEntriesSayWhatIsNotByDefault) {
    const auto added = [](Look& look) -> Result<> {
        DARKROOM_TRY(add_effect(look, *find_effect("vignette"), "tonemap"));
        return set(look, "vignette", "intensity", {0.75f});
    };
    EXPECT_EQ(edited("[[stack]]\r\neffect = \"tonemap\"\r\n", added),
              "[[stack]]\r\neffect = \"vignette\"\r\nintensity = 0.75\r\n\r\n[[stack]]\r\neffect = \"tonemap\"\r\n");
    const std::string without =
        edited("# mine\n[[stack]]\neffect = \"tonemap\"\n", [](Look& look) { return remove_entry(look, "tonemap"); });
    EXPECT_EQ(without, "# mine\nstack = []\n");
    EXPECT_EQ(
        edited("stack = []\n", [](Look& look) { return add_effect(look, *find_effect("tonemap")).map([](auto&&) {}); }),
        "stack = [{ effect = \"tonemap\" }]\n");
}

TEST_F(Splice, AFlatTableBecomesAStackAndBack) {
    const std::string text =
        "# mine\nformat = 1\n\n[post_process] # all\nexposure = 2 # bright\n# why\n\n[other]\na = 1\n";
    const Look was = read(text);
    Look is = was;
    ASSERT_TRUE(move_entry(is, "exposure", "tonemap"));
    const auto stack = splice_look(text, was, is);
    ASSERT_TRUE(stack) << stack.error().text;
    EXPECT_TRUE(says_same(read(*stack), is)) << *stack;
    EXPECT_EQ(stack->rfind("# mine\nformat = 1\n\n[[stack]]", 0), 0u) << *stack;
    EXPECT_NE(stack->find("[other]\na = 1\n"), std::string::npos) << *stack;
    EXPECT_NE(stack->find("# why\n"), std::string::npos) << *stack;
    const auto flat = splice_look(*stack, is, was);
    ASSERT_TRUE(flat) << flat.error().text;
    EXPECT_TRUE(says_same(read(*flat), was)) << *flat;
}

// As undo does, of a table that says nothing.
TEST_F(Splice, AStackBecomesATableOfItsOrder) {
    for (const std::string order : {"documented", "scene_linear"}) {
        const Look was = read("[post_process]\norder = \"" + order + "\"\n"),
                   is = read("[[stack]]\neffect = \"bloom\"\n");
        const auto flat = splice_look("[[stack]]\neffect = \"bloom\"\n", is, was);
        ASSERT_TRUE(flat) << flat.error().text;
        EXPECT_TRUE(says_same(read(*flat), was)) << *flat;
    }
}

TEST_F(Splice, SizesStayInPercent) {
    const auto sigma = [&](const std::string& text, float value) {
        return edited(text, [&](Look& look) { return set(look, "gaussian_blur", "sigma", {value}); });
    };
    const std::string stack = "[[stack]]\neffect = \"gaussian_blur\"\n", flat = "[post_process]\n";
    EXPECT_EQ(sigma(stack + "sigma = \"1%\"\n", 21.6f), stack + "sigma = \"2%\"\n");
    EXPECT_EQ(sigma(stack + "sigma = 10\n", 21.5f), stack + "sigma = 21.5\n");
    EXPECT_EQ(sigma(flat + "gaussian_blur_sigma = \"1%\"\n", 21.6f), flat + "gaussian_blur_sigma = \"2%\"\n");
    const std::string pixels = edited(stack + "sigma = \"1%\"\n", [&](Look& look) {
        const std::uint32_t in_pixels = 0;
        return set_value(look, "gaussian_blur", "reach", {&in_pixels, 1});
    });
    EXPECT_EQ(pixels, stack + "sigma = 10.8\nreach = \"pixels\"\n");
}

TEST_F(Splice, TheInterfaceKeepsItsTable) {
    if (find_effect("ui_chroma") == nullptr) GTEST_SKIP() << "this build has no effect ui_chroma";
    const std::string text = "[post_process]\n\n[ui]\nui_chroma_strength = 0.5 # parted\n";
    const Look was = read(text);
    Look without = was;
    ASSERT_TRUE(remove_entry(without, "ui_chroma"));
    ASSERT_TRUE(move_entry(without, "exposure", "tonemap"));  // a stack has nothing that is off
    const auto stack = splice_look(text, was, without);
    ASSERT_TRUE(stack) << stack.error().text;
    EXPECT_NE(stack->find("ui_chroma_strength = 0.5 # parted\nui_chroma_enabled = false\n"), std::string::npos)
        << *stack;
    Look again = without;
    again.entries.push_back(entry_of(*find_effect("ui_chroma")));
    again.entries.back().is_of_ui = true;
    ASSERT_TRUE(set(again, "ui_chroma", "strength", {0}));
    const auto back = splice_look(*stack, without, again);
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_NE(back->find("ui_chroma_strength = 0.0 # parted\nui_chroma_enabled = true\n"), std::string::npos) << *back;
    // Without the table, its first edit makes it.
    const std::string made =
        edited("[post_process]\n", [](Look& look) { return set(look, "ui_chroma", "strength", {0.25f}); });
    EXPECT_EQ(made, "[post_process]\n\n[ui]\nui_chroma_strength = 0.25\n");
    const Look with = read(made);
    const Look plain = read("[post_process]\n");
    const auto removed = splice_look(made, with, plain);
    ASSERT_TRUE(removed) << removed.error().text;
    EXPECT_EQ(*removed, "[post_process]\n\n");
}

// Callers read a text before; what is none has no places, but an end.
TEST_F(Splice, WhatIsNoTomlHasNoPlaces) {
    for (const std::string text : {"a = \n", "a = [ , ]", "a = { b = , }", "[a", "a", "= 1", "a = \"b", "a = '''b",
                                   "a = [[", "\"", "a = {", "a = [1  , , ]"})
        EXPECT_FALSE(items_of(text)) << text;
}

TEST_F(Splice, WhatCannotBeSplicedIsAnError) {
    const auto error = [](const std::string& text, const std::function<Result<>(Look&)>& change) {
        const Look was = read(text);
        Look is = was;
        const Result<> done = change(is);
        EXPECT_TRUE(done) << done.error().text;
        const auto out = splice_look(text, was, is);
        return out ? "spliced:\n" + *out : out.error().text;
    };
    const auto swapped = [](Look& look) { return move_entry(look, "tonemap", "exposure"); };
    const std::string commented = "stack = [ { effect = \"exposure\" }, # one\n { effect = \"tonemap\" } ]\n";
    EXPECT_NE(error(commented, swapped).find("holds comments"), std::string::npos);
    const std::string parted =
        "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"tonemap\"\n[other]\na = 1\n"
        "[stack.exposure_bias]\na = 1\n";
    EXPECT_NE(error(parted, swapped).find("whole blocks"), std::string::npos);
    const auto without_pulses = [](Look& look) {
        look.pulses.clear();
        return Result<>();
    };
    const std::string pulse =
        "[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\namount = 1\n[other]\na = 1\n[pulse.more]\na = 1\n";
    EXPECT_NE(error(pulse, without_pulses).find("pulse: its entries are not whole blocks"), std::string::npos);
    const Look look = default_look();
    EXPECT_FALSE(splice_look("[post_process\n", look, look));
    Look stack = read("[[stack]]\neffect = \"exposure\"\n");
    EXPECT_FALSE(splice_look("[[stack]]\n[[stack]]\n", stack, stack));
}

/// `count` edits of each file that ships.
void edit_values_at_random(std::uint32_t seed, int count) {
    std::mt19937 random(seed);
    std::size_t files = 0;
    for (const std::filesystem::path& path : shipped_files()) {
        const LookOptions options = options_of(path);
        std::string text = text_of(path);
        const auto first = parse_look(text, path.string(), options);
        if (!first) continue;  // names an effect that this build has not
        ++files;
        Look look = *first;
        for (int edit = 0; edit < count; ++edit) {
            const test::RandomEdit one = test::random_value_edit(random, look);
            Look next = look;
            if (!test::apply_edit(next, one)) continue;  // its effect's values contradict each other
            const Result<std::string> spliced = splice_look(text, look, next);
            ASSERT_TRUE(spliced) << spliced.error().text;
            const LookEntry& entry = *find_entry(next, one.entry);
            const bool is_table = next.is_flat || entry.is_of_ui;
            const std::string key = is_table ? flat_key(entry.effect->name, one.row) : one.row;
            const std::string toggle = is_table ? flat_key(entry.effect->name, "enabled") : "enabled";
            // What sizes are measured in stands beside their numbers.
            const auto rows = entry.effect->parameters.rows;
            const auto of_edit = std::ranges::find(rows, one.row, &ParamInfo::name);
            const auto is_size = [&](std::string_view line) {
                return std::ranges::any_of(rows, [&](const ParamInfo& row) {
                    const std::string size = is_table ? flat_key(entry.effect->name, row.name) : std::string(row.name);
                    return of_edit != rows.end() && row.reach_word == of_edit->word && line == "+" + size;
                });
            };
            for (const std::string& line : changed_lines(text, *spliced)) {
                const bool is_header = line == "+" || line == "+[post_process]" || line == "+[ui]";
                ASSERT_TRUE(line == key || line == "+" + key || line == toggle || line == "+" + toggle || is_header ||
                            is_size(line) || is_size("+" + line))
                    << path << " " << one.entry << "." << one.row << ": " << line << "\n"
                    << *spliced;
            }
            if (edit % 25 == 0 || edit == count - 1) {
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

TEST_F(Splice, RandomValuesOfEveryShippedFileChangeTheirOwnBytesAlone) { edit_values_at_random(1, 200); }

class SoakSplice : public Splice {};
TEST_F(SoakSplice, ManyRandomValuesOfEveryShippedFileChangeTheirOwnBytesAlone) { edit_values_at_random(2, 1000); }

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
            ASSERT_TRUE(reads_as(*again, document.look())) << path << "\n"
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
