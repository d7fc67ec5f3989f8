// SPDX-License-Identifier: MIT
#include "image/frame/sequence.hpp"

#include "image/frame/frame_set.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImageSequence : public WithFolder {
  protected:
    using Numbers = std::vector<long long>;

    [[nodiscard]] Numbers numbers_of(const std::vector<std::string>& inputs) const {
        std::vector<std::string> paths;
        for (const std::string& input : inputs) paths.push_back(file(input).string());
        const auto files = expand_inputs(paths);
        EXPECT_TRUE(files) << files.error().text;
        Numbers out;
        if (files)
            for (const NumberedFile& one : *files) out.push_back(one.number);
        return out;
    }
};

TEST_F(ImageSequence, PatternFindsFilesByNumber) {
    for (const char* name : {"shot.0010.exr", "shot.0002.exr", "shot.0001.exr", "shot.12.exr", "shot.12345.exr",
                             "shot.00x1.exr", "other.0003.exr"})
        put(file(name), "");
    for (const char* const pattern : {"shot.%04d.exr", "shot.####.exr", "shot.@@@@.exr", "shot.$F4.exr"}) {
        const auto files = expand_inputs(std::vector<std::string>{file(pattern).string()});
        ASSERT_TRUE(files) << files.error().text;
        const std::vector<NumberedFile> expected{{file("shot.0001.exr"), 1},
                                                 {file("shot.0002.exr"), 2},
                                                 {file("shot.0010.exr"), 10},
                                                 {file("shot.12345.exr"), 12345}};
        EXPECT_EQ(*files, expected) << pattern;
    }
}

TEST_F(ImageSequence, ThePatternKnowsTheNumber) {
    for (const char* const name : {"shot_0010_v2.exr", "shot_0011_v2.exr", "shot_0012_v2.exr"}) put(file(name), "");
    EXPECT_EQ(numbers_of({"shot_####_v2.exr"}), (Numbers{10, 11, 12}));
    EXPECT_EQ(numbers_of({"shot_$F4_v2.exr"}), (Numbers{10, 11, 12}));
    // As a shell lists them.
    EXPECT_EQ(numbers_of({"shot_0010_v2.exr", "shot_0012_v2.exr"}), (Numbers{10, 12}));
    EXPECT_EQ(numbers_of({"shot_0012_v2.exr"}), Numbers{12});
}

TEST_F(ImageSequence, NumbersMayBeNegative) {
    for (const char* const name : {"s.-002.exr", "s.-001.exr", "s.0000.exr", "s.0001.exr"}) put(file(name), "");
    EXPECT_EQ(numbers_of({"s.%04d.exr"}), (Numbers{-2, -1, 0, 1}));
    EXPECT_EQ(numbers_of({"s.####.exr[-1-0]"}), (Numbers{-1, 0}));
    EXPECT_EQ(numbered("s.%04d.exr", -2), "s.-002.exr");
}

TEST_F(ImageSequence, FilesWithoutNumbersOfTheirOwnAreCounted) {
    EXPECT_EQ(numbers_of({"a.exr", "b.exr"}), (Numbers{1, 2}));
    EXPECT_EQ(numbers_of({"a7.exr", "b7.exr"}), (Numbers{1, 2}));
    EXPECT_EQ(numbers_of({"a7.exr", "b8.exr"}), (Numbers{7, 8}));
    EXPECT_EQ(numbers_of({"a1_2.exr", "a3_4.exr"}), (Numbers{2, 4})) << "two groups differ: the last counts";
}

TEST_F(ImageSequence, FramesInBracketsAreChosenAndNothingIsAnError) {
    for (int i = 1; i < 9; ++i) put(numbered(file("s%02d.exr"), i), "");
    EXPECT_EQ(numbers_of({"s%02d.exr[3-5]"}), (Numbers{3, 4, 5}));
    EXPECT_EQ(numbers_of({"s%02d.exr[1-8x3,8]"}), (Numbers{1, 4, 7, 8}));
    const auto none = expand_inputs(std::vector<std::string>{file("s%02d.exr[30-50]").string()});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().text, file("s%02d.exr[30-50]").string() + ": no file matches");
    EXPECT_FALSE(expand_inputs(std::vector<std::string>{file("s%02d.exr[5-3]").string()}));
    EXPECT_FALSE(expand_inputs(std::vector<std::string>{file("no/s%02d.exr").string()}));
}

TEST_F(ImageSequence, NumbersBelowZeroAreFoundWithTheirSignBeforeOrAmongTheDigits) {
    for (const char* const name : {"b.-0002.exr", "b.-001.exr", "b.0000.exr", "b.-3.exr"}) put(file(name), "");
    EXPECT_EQ(numbers_of({"b.####.exr"}), (Numbers{-2, -1, 0}));
    EXPECT_EQ(numbers_of({"b.%04d.exr"}), (Numbers{-2, -1, 0}));
    put(file("b.-002.exr"), "");
    const auto twice = expand_inputs(std::vector<std::string>{file("b.####.exr").string()});
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().text, file("b.####.exr").string() + ": b.-0002.exr and b.-002.exr are both frame -2");
}

TEST(ImageSequenceNames, NumbersGoIntoPatterns) {
    EXPECT_EQ(numbered("a/b.%04d.png", 7), "a/b.0007.png");
    EXPECT_EQ(numbered("a/b.%d.png", 12345), "a/b.12345.png");
    EXPECT_EQ(numbered("a/b.$F.png", 7), "a/b.7.png");
    EXPECT_EQ(numbered("a/b.$F4.png", 7), "a/b.0007.png");
    EXPECT_EQ(numbered("a/b.png", 7), "a/b.png");
    EXPECT_EQ(frame_number("v2.shot_0042.exr"), 42);
    EXPECT_EQ(frame_number("shot_0042_v2.exr"), 42);
    EXPECT_EQ(frame_number("cav2.exr"), 2) << "a word, and no version";
    EXPECT_EQ(frame_number("shot.exr"), std::nullopt);
}

TEST(ImageFrameSet, ReadsWhatPeopleType) {
    const auto numbers = [](std::string_view text) {
        const auto set = FrameSet::parse(text);
        EXPECT_TRUE(set) << text;
        return set ? set->numbers() : std::vector<long long>();
    };
    using Numbers = std::vector<long long>;
    EXPECT_EQ(numbers("7"), Numbers{7});
    EXPECT_EQ(numbers("3-5"), (Numbers{3, 4, 5}));
    EXPECT_EQ(numbers("1-10x4"), (Numbers{1, 5, 9}));
    EXPECT_EQ(numbers("9-12, 1,5"), (Numbers{1, 5, 9, 10, 11, 12}));
    EXPECT_EQ(numbers("-3--1"), (Numbers{-3, -2, -1}));
    EXPECT_EQ(numbers("-1-1"), (Numbers{-1, 0, 1}));
    EXPECT_EQ(FrameSet::parse("1-100x2,7")->count(), 51U);
    EXPECT_TRUE(FrameSet::parse("1-100x2")->contains(99));
    EXPECT_FALSE(FrameSet::parse("1-100x2")->contains(100));
    for (const char* const wrong : {"", "a", "1-", "-", "1,,2", "1-2x", "1-2x0", "1-2x-1", "5-3", "1-2-3", "1x2", "1.5",
                                    "1000000001", "99999999999999999999", "1-2x9999999999"})
        EXPECT_FALSE(FrameSet::parse(wrong)) << wrong;
    std::string many = "1";
    for (std::size_t i = 0; i < FrameSet::max_ranges; ++i) many += ",1";
    EXPECT_FALSE(FrameSet::parse(many));
}

TEST(ImageFrameSet, TextIsReadBack) {
    EXPECT_EQ(frame_set_text({1, 2, 3, 7, 9, 11, 20}), "1-3,7-11x2,20");
    EXPECT_EQ(frame_set_text({1, 2}), "1-2");
    EXPECT_EQ(frame_set_text({1, 5}), "1,5");
    EXPECT_EQ(frame_set_text({-3, -2, -1}), "-3--1");
    unsigned state = 1;
    for (int round = 0; round < 200; ++round) {
        std::vector<long long> numbers;
        for (long long i = -20; i < 20; ++i) {
            state = state * 1664525U + 1013904223U;
            if (state >> 31U != 0 || numbers.empty()) numbers.push_back(i);
        }
        EXPECT_EQ(FrameSet::parse(frame_set_text(numbers))->numbers(), numbers);
    }
}

}  // namespace
}  // namespace darkroom
