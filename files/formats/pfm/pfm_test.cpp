// SPDX-License-Identifier: MIT
// Files of PFM byte by byte, and by Netpbm's programs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImagePfm : public WithFolder {
  protected:
    std::string error_of(const std::string& text) const {
        put(file("bad.pfm"), text);
        const auto frame = read_frame(file("bad.pfm"));
        return frame ? "read" : frame.error().text.substr(file("bad.pfm").string().size() + 2);
    }
    /// A line of the shell in the test's folder.
    [[nodiscard]] int shell(const std::string& line) const {
        return std::system(fmt::format("cd '{}' && {}", folder_.string(), line).c_str());
    }
};

// 0.5 is 3f 00 00 00, 2 is 40 00 00 00, -1 is bf 80 00 00 (IEEE 754); the bottom row comes first.
TEST_F(ImagePfm, BothByteOrdersAreReadFromTheBottomUp) {
    const std::string half("\x3f\0\0\0", 4), two("\x40\0\0\0", 4), less("\xbf\x80\0\0", 4);
    const std::string large = half + half + half + two + two + two, small = less + two + half + half + less + two;
    std::string swapped = large + small;
    for (std::size_t i = 0; i < swapped.size(); i += 4) std::reverse(&swapped[i], &swapped[i] + 4);
    put(file("big.pfm"), "PF\n2 2\n1.0\n" + large + small);
    put(file("little.pfm"), "PF 2\t2 -1\n" + swapped);
    for (const char* const name : {"big.pfm", "little.pfm"}) {
        const auto frame = read_frame(file(name));
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_EQ(frame->samples, SampleKind::Float);
        EXPECT_EQ(frame->color.pixels, (std::vector<float>{-1, 2, 0.5f, 1, 0.5f, -1, 2, 1,  //
                                                           0.5f, 0.5f, 0.5f, 1, 2, 2, 2, 1}))
            << name;
    }
    put(file("grey.pfm"), "Pf\n1 2\n1\n" + half + two);
    const auto grey = read_frame(file("grey.pfm"));
    ASSERT_TRUE(grey) << grey.error().text;
    EXPECT_EQ(grey->color.pixels, (std::vector<float>{2, 2, 2, 1, 0.5f, 0.5f, 0.5f, 1}));
}

// The blank that ends the header is one byte, unless the file has one more than its samples need.
TEST_F(ImagePfm, LinesMayEndWithCarriageReturns) {
    const std::string two("\0\0\0\x40", 4), newline_first("\n\0\0\x40", 4);
    put(file("both.pfm"), "Pf\r\n2 1\r\n-1\r\n" + two + two);
    put(file("one.pfm"), "Pf\r2 1\r-1\r" + newline_first + two);
    for (const char* const name : {"both.pfm", "one.pfm"}) {
        const auto frame = read_frame(file(name));
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_NEAR(frame->color.pixels[0], 2, 1e-5) << name;
        EXPECT_EQ(frame->color.pixels[4], 2) << name;
    }
}

TEST_F(ImagePfm, WhatIsBrokenIsRefusedInOneLine) {
    const std::string pixel(12, '\0');
    EXPECT_EQ(error_of("PF\n1 1\n-1\n" + pixel), "read");
    EXPECT_EQ(error_of("PF\n1 1\n-1\n" + pixel.substr(1)), "truncated: 11 bytes of samples of 12");
    EXPECT_EQ(error_of("PF\n65536 65536\n-1\n" + pixel), "truncated: 12 bytes of samples of 51539607552");
    EXPECT_EQ(error_of("PF\n0 1\n-1\n" + pixel), "a side of '0': [1, 65536] is allowed");
    EXPECT_EQ(error_of("PF\n1 65537\n-1\n" + pixel), "a side of '65537': [1, 65536] is allowed");
    EXPECT_EQ(error_of("PF\n1 1\n-2.5\n" + pixel), "a scale of '-2.5': 1 and -1 are allowed");
    EXPECT_EQ(error_of("PF\n1 1\nnan\n" + pixel), "a scale of 'nan': 1 and -1 are allowed");
    EXPECT_EQ(error_of("PF\n1 1\n"), "damaged or truncated: its header has no end");
    EXPECT_EQ(error_of("PF " + std::string(5000, ' ')), "damaged or truncated: its header has no end");
    EXPECT_FALSE(write_picture(file("a.pfm"), Picture(1, 1), {.alpha = true}));
    EXPECT_FALSE(write_picture(file("a.pfm"), Picture(1, 1), {.samples = SampleKind::Half}));
}

TEST_F(ImagePfm, IsWhatNetpbmReadsAndWrites) {
    if (shell("command -v pfmtopam pamtopfm > where") != 0) GTEST_SKIP() << "Netpbm is not on this machine";
    constexpr std::uint32_t width = 5, height = 3;
    Picture picture(width, height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i) / 255;
    ASSERT_TRUE(write_picture(file("ours.pfm"), picture));
    ASSERT_EQ(shell("pfmtopam ours.pfm > theirs.pam"), 0);
    const std::string pam = content(file("theirs.pam"));
    const std::size_t samples = pam.find("ENDHDR\n") + 7;
    ASSERT_EQ(pam.size() - samples, std::size_t{width} * height * 3) << pam.substr(0, samples);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(static_cast<unsigned char>(pam[samples + i / 4 * 3 + c]), i + c) << "codes, top row first";
    for (const char* const order : {"big", "little"}) {
        ASSERT_EQ(shell(fmt::format("pamtopfm -endian={} theirs.pam > back.pfm", order)), 0);
        const auto back = read_frame(file("back.pfm"));
        ASSERT_TRUE(back) << back.error().text;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            EXPECT_NEAR(back->color.pixels[i], picture.pixels[i], 1e-6f) << order << i;
    }
}

// Which writes a comment into the header.
TEST_F(ImagePfm, IsWhatLibvipsReadsAndWrites) {
    if (shell("command -v vips > where") != 0) GTEST_SKIP() << "libvips is not on this machine";
    Picture picture(7, 5);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 4 == 3 ? 1.0f : std::ldexp(i % 8 < 4 ? -1.3f : 1.7f, static_cast<int>(i) - 70);
    ASSERT_TRUE(write_picture(file("ours.pfm"), picture));
    ASSERT_EQ(shell("vips copy ours.pfm theirs.pfm"), 0);
    EXPECT_NE(content(file("theirs.pfm")), content(file("ours.pfm")));
    const auto back = read_frame(file("theirs.pfm"));
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_EQ(back->color, picture);
}

}  // namespace
}  // namespace darkroom
