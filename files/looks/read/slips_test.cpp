// SPDX-License-Identifier: MIT
// What people type that is nearly right, and files that hold too much of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <darkroom/effect.hpp>
#include <darkroom/look.hpp>

namespace darkroom {
namespace {

std::vector<std::string> slips_of(std::string_view text) {
    std::vector<std::string> warnings;
    const Result<Look> look = parse_look(text, "a.toml", {.warnings = &warnings});
    EXPECT_TRUE(look) << look.error().text;
    return warnings;
}
std::string wrong_of(std::string_view text) {
    const Result<Look> look = parse_look(text, "a.toml", {});
    return look ? "accepted" : look.error().text;
}
bool holds(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

TEST(LookSlips, WordsForAnAmountMeanItsOwnKey) {
    if (find_effect("chromatic_aberration") == nullptr) GTEST_SKIP() << "the effect of this test is not in this build";
    const std::string meant = ", did you mean 'chromatic_aberration', which takes ";
    for (const std::string& word : std::vector<std::string>{"intensity", "amount", "strength"}) {
        const std::vector<std::string> flat = slips_of("[post_process]\nchromatic_aberration_" + word + " = 1\n");
        ASSERT_EQ(flat.size(), 1U);
        EXPECT_TRUE(holds(flat[0], meant)) << flat[0];
        for (const std::string& key : {word, "chromatic_aberration_" + word}) {
            const std::vector<std::string> stack =
                slips_of("[[stack]]\neffect = \"chromatic_aberration\"\n" + key + " = 1\n");
            ASSERT_EQ(stack.size(), 1U);
            EXPECT_TRUE(holds(stack[0], meant)) << stack[0];
        }
    }
    const std::vector<std::string> other = slips_of("[post_process]\nintensity = 1\n");
    ASSERT_EQ(other.size(), 1U);
    EXPECT_FALSE(holds(other[0], "chromatic_aberration'")) << "of which effect?";
}

// Looking for a name among hundreds, and planning many entries, is slow.
TEST(LookSlips, WhatAFileHoldsManyOfIsBounded) {
    if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect of this test is not in this build";
    std::string keys = "[post_process]\n";
    for (int i = 999; i >= 100; --i) keys += fmt::format("exposur{} = 1\n", i);  // read by name, told by line
    const std::vector<std::string> warnings = slips_of(keys);
    ASSERT_EQ(warnings.size(), 21U);
    EXPECT_FALSE(holds(warnings[0], "did you mean")) << warnings[0];
    EXPECT_EQ(warnings[20], "a.toml: and 880 more like these");
    const auto stack = [](std::size_t count) {
        std::string out;
        for (std::size_t i = 0; i < count; ++i) out += "[[stack]]\neffect = \"exposure\"\n";
        return wrong_of(out);
    };
    EXPECT_EQ(stack(4096), "accepted");
    EXPECT_EQ(stack(4097), "a.toml:1:1: 4097 entries of stack: allowed are 4096");
}

TEST(LookSlips, ANumberWithAUnitIsAText) {
    for (const std::string& value : std::vector<std::string>{"2ev", "6500K", "-0.5stops"}) {
        const std::string error = wrong_of("[post_process]\n\nexposure = " + value + "  # two\n");
        EXPECT_TRUE(holds(error, "; a number with a unit is a text: \"" + value + "\"")) << error;
    }
    for (const std::string& value : std::vector<std::string>{"1..2", "2020-13-01", "ev", "", "1 2", "1e400"}) {
        const std::string error = wrong_of("[post_process]\nexposure = " + value + "\n");
        EXPECT_FALSE(holds(error, "with a unit")) << error;
    }
}

}  // namespace
}  // namespace darkroom
