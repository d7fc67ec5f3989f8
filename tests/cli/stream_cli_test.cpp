// SPDX-License-Identifier: MIT
// Pictures through a pipe: the bytes of every format against the pictures of files, and another program that reads
// them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/video_frame.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using test::content;
using test::Outcome;

TEST(VideoFrame, RatesAreThoseOfFilmAndTelevision) {
    const auto rate = [](double hertz) {
        const FrameRate found = frame_rate(hertz);
        return fmt::format("{}:{}", found.numerator, found.denominator);
    };
    EXPECT_EQ(rate(24), "24:1");
    EXPECT_EQ(rate(23.976), "24000:1001");
    EXPECT_EQ(rate(23.98), "24000:1001");
    EXPECT_EQ(rate(29.97), "30000:1001");
    EXPECT_EQ(rate(47.95), "48000:1001");
    EXPECT_EQ(rate(59.94), "60000:1001");
    EXPECT_EQ(rate(119.88), "120000:1001");
    EXPECT_EQ(rate(23.95), "23950:1000");
    EXPECT_EQ(rate(60000.0 / 1001), "60000:1001");
    EXPECT_EQ(rate(12.5), "12500:1000");
    EXPECT_EQ(rate(0.001), "1:1000");
    EXPECT_EQ(rate(1e6), "1000000:1");
}

// ITU-R BT.709, 8 bits: black, white and the primaries, as tables of the standard's equations have them.
TEST(VideoFrame, Y4mIsBt709InLimitedRange) {
    const std::vector<std::uint8_t> rgba{0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 7};
    const std::vector<std::byte> frame = video_frame(VideoFormat::Y4m, rgba);
    std::string text(frame.size(), '\0');
    std::ranges::transform(frame, text.begin(), [](std::byte b) { return static_cast<char>(b); });
    ASSERT_EQ(text.substr(0, 6), "FRAME\n");
    EXPECT_EQ(text.substr(6, 5), "\x10\xeb\x3f\xad\x20") << "luma: 16, 235, 63, 173, 32";
    EXPECT_EQ(text.substr(11, 5), "\x80\x80\x66\x2a\xf0") << "blue: 128, 128, 102, 42, 240";
    EXPECT_EQ(text.substr(16, 5), "\x80\x80\xf0\x1a\x76") << "red: 128, 128, 240, 26, 118";
    EXPECT_EQ(video_head(VideoFormat::Y4m, 5, 1, {24, 1}), "YUV4MPEG2 W5 H1 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n");
}

class CliStream : public test::CliFixture {
  protected:
    static constexpr int width = 24, height = 16;

    void make_files() override {
        for (int number = 1; number <= 5; ++number) {
            FrameFile frame;
            frame.color = Picture(width, height);
            for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
                frame.color.pixels[i] = i % 4 == 3 ? 0.25f : static_cast<float>((i * 37 + 11U * number) % 101) / 40.0f;
            frame.has_alpha = true;
            ASSERT_TRUE(write_frame(path(fmt::format("f.{:04}.exr", number)), frame));
        }
        write("empty.scene.toml", "[scene]\nname = \"empty\"\n");
    }
    /// What a command writes to its standard output.
    [[nodiscard]] std::string streamed(const std::string& command) const {
        const Outcome outcome = run_lines(command);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    }
    /// The codes of the pictures as files, without alpha.
    [[nodiscard]] std::vector<double> codes_of_files(double most, const std::string& flags = "") const {
        const Outcome outcome = run_lines("darkroom develop 'f.####.exr' " + flags + " -o 'p.##.png'");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        std::vector<double> codes;
        for (int number = 1; number <= 5; ++number) {
            const Picture one = picture(fmt::format("p.{:02}.png", number));
            for (std::size_t i = 0; i < one.pixels.size(); ++i)
                if (i % 4 != 3) codes.push_back(std::round(double{one.pixels[i]} * most));
        }
        return codes;
    }
    static double code(char byte) { return static_cast<unsigned char>(byte); }
};

TEST_F(CliStream, SamplesAreThoseOfTheFilesInTheirOrder) {
    const std::vector<double> codes = codes_of_files(255);
    for (const char* const jobs : {"1", "3"}) {
        const std::string bytes =
            streamed(fmt::format("darkroom develop 'f.####.exr' --jobs {} -o - --format rgb24", jobs));
        ASSERT_EQ(bytes.size(), codes.size());
        for (std::size_t i = 0; i < codes.size(); ++i) ASSERT_EQ(code(bytes[i]), codes[i]) << i;
    }
    for (const char* const alpha : {"", "--alpha", "--alpha=glow"}) {
        const std::vector<double> wide = codes_of_files(65535, fmt::format("--bits 16 {}", alpha));
        const std::string bytes =
            streamed(fmt::format("darkroom develop 'f.####.exr' -o - --format rgba64le {}", alpha));
        ASSERT_EQ(bytes.size(), wide.size() / 3 * 8);
        for (std::size_t pixel = 0; pixel < wide.size() / 3; ++pixel)
            for (std::size_t c = 0; c < 4; ++c) {
                const double value = code(bytes[8 * pixel + 2 * c]) + 256 * code(bytes[8 * pixel + 2 * c + 1]);
                const double opaque = *alpha == 0 ? 65535 : 16384;
                ASSERT_NEAR(value, c < 3 ? wide[3 * pixel + c] : opaque, c < 3 ? 0 : 1) << pixel;
            }
    }
}

// Back by the inverse of BT.709. A step of luma is 255/219 codes, one of a difference of colour up to 1.8556 * 255/224:
// half of each is 1.64.
TEST_F(CliStream, Y4mHasTheCodesOfTheFiles) {
    const std::string bytes = streamed("darkroom develop 'f.####.exr' --fps 23.976 -o - --format y4m");
    const std::vector<double> codes = codes_of_files(255, "--fps 23.976");
    const std::string head = "YUV4MPEG2 W24 H16 F24000:1001 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    constexpr std::size_t pixels = std::size_t{width} * height;
    ASSERT_EQ(bytes.substr(0, head.size()), head);
    ASSERT_EQ(bytes.size(), head.size() + 5 * (6 + 3 * pixels));
    for (std::size_t frame = 0; frame < 5; ++frame) {
        const std::size_t at = head.size() + frame * (6 + 3 * pixels);
        ASSERT_EQ(bytes.substr(at, 6), "FRAME\n");
        for (std::size_t i = 0; i < pixels; ++i) {
            const auto plane = [&](std::size_t number) { return code(bytes[at + 6 + number * pixels + i]); };
            const double luma = (plane(0) - 16) / 219, blue = (plane(1) - 128) / 224, red = (plane(2) - 128) / 224;
            const double r = luma + 1.5748 * red, b = luma + 1.8556 * blue;
            const double g = (luma - 0.2126 * r - 0.0722 * b) / 0.7152;
            for (const auto& [channel, value] : {std::pair(0U, r), std::pair(1U, g), std::pair(2U, b)})
                ASSERT_NEAR(255 * value, codes[3 * (frame * pixels + i) + channel], 1.65) << frame << " " << i;
        }
    }
}

TEST_F(CliStream, AnotherProgramReadsIt) {
    if (run_lines("command -v ffmpeg").code != 0) GTEST_SKIP() << "there is no ffmpeg on this machine";
    const std::vector<double> codes = codes_of_files(255);
    const std::string bytes = streamed(
        "darkroom develop 'f.####.exr' -o - --format y4m | ffmpeg -v error -i - -vf scale=in_color_matrix=bt709 "
        "-sws_flags accurate_rnd+full_chroma_int -f rawvideo -pix_fmt rgb24 -");
    ASSERT_EQ(bytes.size(), codes.size());
    for (std::size_t i = 0; i < codes.size(); ++i) ASSERT_NEAR(code(bytes[i]), codes[i], 3) << i;
    const Outcome movie = run_lines(
        "darkroom develop 'f.####.exr' --fps 25 -o - --format y4m | ffmpeg -v error -i - -pix_fmt yuv420p out.mp4\n"
        "ffmpeg -i out.mp4 2>&1 | grep Video: || true");
    EXPECT_EQ(movie.code, 0) << movie.err;
    EXPECT_NE(movie.out.find("24x16"), std::string::npos) << movie.out;
    EXPECT_NE(movie.out.find("25 fps"), std::string::npos) << movie.out;
    const Outcome range = run_lines("darkroom develop f.0001.exr -q -o - --format y4m | ffmpeg -i - -f null - 2>&1");
    EXPECT_NE(range.out.find("yuv444p(tv"), std::string::npos) << range.out;
}

TEST_F(CliStream, ScenesAreStreamedToo) {
    const std::string bytes =
        streamed("darkroom render empty.scene.toml --size 8x6 --frames 0-2 --timings -o - --format rgb24 2>said");
    EXPECT_EQ(bytes.size(), 3U * 8 * 6 * 3) << "what is said goes to standard error";
    EXPECT_NE(content(path("said")).find("Loaded scene"), std::string::npos);
    EXPECT_NE(content(path("said")).find("together"), std::string::npos);
}

TEST_F(CliStream, FramesThatAreMissingAreHeldOrRefused) {
    fs::copy(path("f.0005.exr"), path("f.0006.exr"));
    for (const char* const name : {"f.0003.exr", "f.0004.exr"}) fs::remove(path(name));
    const auto stream = [&](const std::string& flags) {
        return run_lines("darkroom develop 'f.####.exr' -q -o - --format rgb24 --size 24x16 " + flags);
    };
    const auto picture_of = [&](int number) { return stream(fmt::format("--frames {}", number)).out; };
    const std::string one = picture_of(1), two = picture_of(2), five = picture_of(5), six = picture_of(6);
    ASSERT_NE(two, five);
    const Outcome between = stream("--frames 1-4,6");
    EXPECT_EQ(between.out, one + two + two + two + six) << "frame 5 is there, and nobody asked for it";
    EXPECT_NE(between.err.find("2 frames are missing before f.0006.exr"), std::string::npos) << between.err;
    const Outcome begin = stream("--frames 3-6"), end = stream("--frames 5-9");
    EXPECT_EQ(begin.out, five + five + five + six);
    EXPECT_NE(begin.err.find("2 frames are missing before f.0005.exr"), std::string::npos) << begin.err;
    EXPECT_EQ(end.out, five + six + six + six + six);
    EXPECT_NE(end.err.find("3 frames are missing behind f.0006.exr"), std::string::npos) << end.err;
    for (const auto& [flags, line] : {std::pair("--frames 1-4,6", "2 frames are missing before f.0006.exr"),
                                      std::pair("--frames 3-6", "2 frames are missing before f.0005.exr"),
                                      std::pair("--frames 5-9", "3 frames are missing behind f.0006.exr")}) {
        const Outcome refused = stream(fmt::format("--gaps stop {}", flags));
        EXPECT_EQ(refused.code, 1) << flags;
        EXPECT_EQ(refused.out, "") << flags;
        EXPECT_EQ(refused.err, fmt::format("darkroom: --gaps stop: {}\n", line));
    }
    fs::copy(path("f.0005.exr"), path("f.20261129.exr"));
    const Outcome stray = run_lines("timeout 20 darkroom develop 'f.####.exr' -q -o - --format rgb24 | head -c 99999");
    EXPECT_EQ(stray.out, "");
    EXPECT_EQ(stray.err,
              "darkroom: --gaps hold: 20261122 frames are missing before f.20261129.exr, at most 100000 are held\n");
}

TEST_F(CliStream, AReaderThatEndsIsOneLine) {
    const Outcome outcome =
        run_lines("set +o pipefail\ndarkroom develop 'f.####.exr' --size 512x512 -q -o - --format rgb24 | head -c 9");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "darkroom: standard output: Broken pipe\n");
}

TEST_F(CliStream, WhatCannotBeStreamedIsRefused) {
    const std::string frame = path("f.0001.exr");
    const auto refused = [&](std::vector<std::string> flags, const std::string& part) {
        flags.insert(flags.begin(), {"develop", frame});
        expect_refused(flags, 1, part);
    };
    refused({"-o", "-"}, "-o -: --format y4m|rgb24|rgba64le is needed");
    refused({"-o", "-", "--format", "avi"}, "--format avi: allowed is y4m, rgb24, rgba64le");
    refused({"-o", path("a.png"), "--format", "y4m"}, "--format y4m: works for -o -, not for files");
    refused({"-o", "-", "--format", "y4m", "--bits", "16"}, "--bits: works for files");
    refused({"-o", "-", "--format", "y4m", "--alpha"}, "--alpha: --format y4m holds no alpha");
    refused({"-o", "-", "--format", "y4m", "--skip-existing"}, "--skip-existing: a stream has no gaps");
    refused({"-o", "-", "--format", "y4m", "--keep-going"}, "--keep-going: a stream has no gaps");
    FrameFile larger;
    larger.color = Picture(32, 16);
    ASSERT_TRUE(write_frame(path("f.0002.exr"), larger));
    const Outcome sizes = run_lines("darkroom develop 'f.####.exr' -q -o - --format rgb24");
    EXPECT_EQ(sizes.code, 1);
    EXPECT_EQ(sizes.out.size(), std::size_t{width} * height * 3) << "the picture before it is whole";
    EXPECT_EQ(sizes.err, "darkroom: f.0002.exr: 32x16, the stream is 24x16; --size makes them the same\n");
}

}  // namespace
}  // namespace darkroom
