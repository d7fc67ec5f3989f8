// SPDX-License-Identifier: MIT
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "formats/exr/exr_check.hpp"
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/png/png_check.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

long peak_memory_mib() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

bool is_finite(const FrameFile& frame) {
    for (const float value : frame.color.pixels)
        if (!std::isfinite(value)) return false;
    return true;
}

// Sanitizers keep freed memory and shadow it, so that a limit says nothing there.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool is_memory_known = false;
#else
constexpr bool is_memory_known = true;
#endif

class ImageMalformed : public WithData {};

TEST_F(ImageMalformed, EveryFileIsDecodedOrRefused) {
    std::size_t count = 0;
    for (const char* folder : {"openexr_damaged", "openexr_test", "tinyexr_regression", "hdr", "exr_oiio"})
        for (const auto& entry : std::filesystem::directory_iterator(data_ / "malformed" / folder)) {
            ++count;
            const auto start = std::chrono::steady_clock::now();
            const auto frame = read_frame(entry.path());
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
            EXPECT_LT(seconds.count(), 5.0) << entry.path();
            if (is_memory_known) {
                EXPECT_LT(peak_memory_mib(), 512) << entry.path();
            }
            if (frame) {
                EXPECT_TRUE(is_finite(*frame)) << entry.path();
                continue;
            }
            EXPECT_TRUE(frame.error().text.starts_with(entry.path().string() + ": ")) << frame.error().text;
            EXPECT_EQ(frame.error().text.find('\n'), std::string::npos) << frame.error().text;
        }
    EXPECT_GE(count, 130u);
}

TEST_F(ImageMalformed, FilesOfTheTestSuitesThatAreBrokenAreRefused) {
    for (const auto& entry : std::filesystem::directory_iterator(data_ / "malformed" / "openexr_test"))
        EXPECT_FALSE(read_frame(entry.path())) << entry.path();
    EXPECT_TRUE(read_frame(data_ / "malformed/tinyexr_regression/2by2.exr"));
    EXPECT_TRUE(read_frame(data_ / "malformed/exr_oiio/bad_nan.exr"));
    EXPECT_FALSE(read_frame(data_ / "malformed/exr_oiio/partial_missingtiles.exr"));
}

TEST_F(ImageMalformed, ReasonsAreNamed) {
    const auto reason = [&](const char* name) {
        const auto frame = read_frame(data_ / "hostile" / name);
        return frame ? std::string("accepted") : frame.error().text;
    };
    EXPECT_NE(reason("01_exr_truncated_pixels.exr").find("unexpected end of file"), std::string::npos);
    EXPECT_NE(reason("02_exr_absurd_dims.exr").find("2147483647x2147483647"), std::string::npos);
    EXPECT_NE(reason("04_exr_zero_size.exr").find("empty (0x0)"), std::string::npos);
    EXPECT_NE(reason("05_exr_depth_only_no_rgb.exr").find("channels found: Z; needed: R, G, B"), std::string::npos);
    EXPECT_NE(reason("07_hdr_rle_overrun_truncated.hdr").find("bad scanline 4 data"), std::string::npos);
    EXPECT_EQ(reason("06_png_renamed_to.exr"), "accepted");
}

TEST_F(ImageMalformed, PixelsThatAreNotFiniteAreCountedAndMended) {
    const auto frame = read_frame(data_ / "hostile/03_exr_nan_inf_pixels.exr");
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_TRUE(is_finite(*frame));
    EXPECT_EQ(frame->counts, (PixelCounts{.nan_color = 1, .infinite_color = 2, .nan_alpha = 1}));
    EXPECT_EQ(frame->warnings.size(), 1u);
    EXPECT_EQ(frame->color.at(10, 10)[0], 0);
    EXPECT_EQ(frame->color.at(20, 20)[1], 65504);
    EXPECT_EQ(frame->color.at(30, 30)[2], -65504);
    EXPECT_EQ(frame->color.at(40, 40)[0], 65504);
    EXPECT_EQ(frame->color.at(50, 50)[0], -5);
    EXPECT_EQ(frame->color.at(12, 40)[3], 1);
    EXPECT_NEAR(frame->color.at(1, 1)[0], 0.18f, 1e-4f);
}

class ImageTruncated : public WithFolder {};

// Cut anywhere, a file is refused: half a picture is not a picture.
TEST_F(ImageTruncated, EveryFormatRefusesAPartOfAFile) {
    Picture picture(61, 47);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = static_cast<float>((i * 2654435761u >> 7) % 1000) / 1000;
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.hdr"}) {
        ASSERT_TRUE(write_picture(file(name), picture));
        ASSERT_TRUE(read_frame(file(name)));
        const std::string whole = content(file(name));
        for (std::size_t tenth = 0; tenth < 10; ++tenth) {
            put(file("cut"), whole.substr(0, whole.size() * tenth / 10));
            const auto cut = read_frame(file("cut"));
            EXPECT_FALSE(cut) << name << " cut at " << tenth << " tenths";
        }
    }
}

TEST_F(ImageTruncated, WhatIsNoImageIsRefused) {
    put(file("a.exr"), "[bloom]\nintensity = 1\n");
    const auto text = read_frame(file("a.exr"));
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().text,
              file("a.exr").string() + ": is not a picture of a known format (" + format_names() + ")");
    EXPECT_FALSE(read_frame(folder_));
    EXPECT_FALSE(read_frame(file("missing.exr")));
}

/// An OpenEXR file whose header asks for a picture, and zeros where its chunks should be.
struct EmptyExr {
    std::int32_t width = 1, height = 1;
    int float_channels = 4;
    char compression = 3;  // ZIP
    std::uint32_t tile = 0;
    std::size_t size = std::size_t{2} << 20;
    std::string attributes = "";                         // besides
    std::int32_t display_width = 0, display_height = 0;  // 0: those of the data

    [[nodiscard]] std::string text() const {
        std::string channels;
        for (int i = 0; i < float_channels; ++i)
            channels += (i < 26 ? std::string(1, static_cast<char>('A' + i)) : fmt::format("c{}", i)) + '\0' +
                        little_endian(2U) + little_endian(0U) + little_endian(1U) + little_endian(1U);
        const auto window = [](std::int32_t wide, std::int32_t high) {
            return little_endian(0) + little_endian(0) + little_endian(wide - 1) + little_endian(high - 1);
        };
        std::string out = little_endian(0x01312f76U) + little_endian(tile > 0 ? 0x202U : 2U) +
                          exr_attribute("channels", "chlist", channels + '\0') +
                          exr_attribute("compression", "compression", std::string(1, compression)) +
                          exr_attribute("dataWindow", "box2i", window(width, height)) +
                          exr_attribute("displayWindow", "box2i",
                                        window(display_width > 0 ? display_width : width,
                                               display_height > 0 ? display_height : height));
        if (tile > 0)
            out += exr_attribute("tiles", "tiledesc", little_endian(tile) + little_endian(tile) + std::string(1, '\0'));
        out += attributes + '\0';
        out.resize(std::max(out.size(), size));
        return out;
    }
};

template <class Check>
std::string refusal(const Check& check, const std::string& file) {
    const auto checked = check(std::as_bytes(std::span(file)));
    return checked ? "none" : checked.error().text;
}

TEST(ImageProportions, AnExrOfZerosIsRefusedForWhatItAsksFor) {
    const auto told = [](const EmptyExr& file) { return refusal(check_exr, file.text()); };
    const std::string unfinished = "unfinished: its table has no place for chunk 1 of";
    EXPECT_TRUE(told({.width = 7680, .height = 4320}).starts_with(unfinished)) << "8K in floats";
    EXPECT_TRUE(told({.width = 7680, .height = 4320, .compression = 9, .size = 17000}).starts_with(unfinished));
    EXPECT_TRUE(told({.width = 8192, .height = 8192}).starts_with(unfinished)) << "1 GiB";
    EXPECT_EQ(told({.width = 8192, .height = 8193}),
              "its pixels need 1073872896 bytes, a file of 2097152 bytes may need 1073741824");
    EXPECT_TRUE(told({.width = 8192, .height = 8193, .size = 9 << 20}).starts_with(unfinished)) << "a larger file";
}

TEST(ImageProportions, AChunkOfAnExrIsBounded) {
    const auto told = [](const EmptyExr& file) { return refusal(check_exr, file.text()); };
    EXPECT_TRUE(told({.tile = 4096}).starts_with("unfinished"));
    EXPECT_EQ(told({.tile = 4097}),
              "chunks of 4097x4097 pixels need 268566544 bytes each, at most 268435456 are allowed");
    EXPECT_EQ(told({.width = 65536, .height = 128, .float_channels = 16, .compression = 9}).substr(0, 25),
              "chunks of 65536x128 pixel");
}

TEST(ImageProportions, SidesPartsAndChannelsOfAnExrAreBounded) {
    const auto told = [](const EmptyExr& file) { return refusal(check_exr, file.text()); };
    EXPECT_TRUE(told({.width = 65536, .float_channels = 1}).starts_with("unfinished"));
    EXPECT_NE(told({.width = 65537, .float_channels = 1}).find("65536"), std::string::npos);
    EXPECT_TRUE(told({.float_channels = 1, .tile = 8192}).starts_with("unfinished"));
    EXPECT_EQ(told({.float_channels = 1, .tile = 8193}),
              "malformed header: tiles of 8193x8193, [1, 8192] a side is allowed");
    EXPECT_TRUE(told({.float_channels = 1024}).starts_with("unfinished"));
    EXPECT_EQ(told({.float_channels = 1025}), "malformed header: more than 1024 channels");
    EXPECT_EQ(refusal(check_exr, exr_of_layers(256, 1)), "none");
    EXPECT_EQ(refusal(check_exr, exr_of_layers(257, 1)), "malformed header: more than 256 parts");
    // 2^25 pixels are 8192x4096.
    const auto shown = [&](std::int32_t height, std::int32_t side) {
        return told({.width = side, .height = side, .display_width = 8192, .display_height = height});
    };
    EXPECT_TRUE(shown(4096, 1).starts_with("unfinished"));
    EXPECT_TRUE(shown(4608, 768).starts_with("unfinished")) << "64 times";
    EXPECT_NE(shown(4617, 768).find("is out of proportion to the data window"), std::string::npos);
}

// The library reads on where the value of a type ends, and would take the rest for sizes to allocate.
TEST(ImageProportions, AttributesOfAnExrHaveTheSizeOfTheirType) {
    const auto told = [](const std::string& type, const std::string& value) {
        return refusal(check_exr, EmptyExr{.attributes = exr_attribute("a", type, value)}.text());
    };
    EXPECT_TRUE(told("float", little_endian(1U)).starts_with("unfinished"));
    EXPECT_EQ(told("float", little_endian(1U) + "bc"), "malformed header: attribute a has 6 bytes, a float has 4");
    EXPECT_EQ(told("m44f", ""), "malformed header: attribute a has 0 bytes, a m44f has 64");
    EXPECT_TRUE(told("mine", "any bytes").starts_with("unfinished"));
    const std::string channel =
        std::string("A\0", 2) + little_endian(2U) + little_endian(0U) + little_endian(1U) + little_endian(1U);
    EXPECT_TRUE(told("chlist", channel + '\0').starts_with("unfinished"));
    EXPECT_EQ(told("chlist", channel), "malformed header: the channel list has no end");
    EXPECT_EQ(told("chlist", channel + '\0' + channel),
              "malformed header: the channel list ends before its attribute does");
}

TEST(ImageProportions, AttributesOfAnExrAreCounted) {
    const auto told = [](const std::string& attributes) {
        return refusal(check_exr, EmptyExr{.size = std::size_t{40} << 20, .attributes = attributes}.text());
    };
    const auto many = [](std::size_t count) {
        std::string out;
        for (std::size_t i = 0; i < count; ++i) out += exr_attribute("a" + std::to_string(i), "x", "");
        return out;
    };
    constexpr std::size_t own = 4;  // of EmptyExr
    EXPECT_TRUE(told(many(65536 - own)).starts_with("unfinished"));
    EXPECT_EQ(told(many(65536 - own + 1)), "malformed header: more than 65536 attributes");
    EXPECT_EQ(told(exr_attribute("list", "stringvector", std::string(std::size_t{65536} * 4, '\0'))),
              "malformed header: more than 65536 attributes")
        << "strings count";
    const std::size_t left = (std::size_t{32} << 20) - (4 * 18 + 1 + 1 + 16 + 16);
    EXPECT_TRUE(told(exr_attribute("a", "x", std::string(left, 'x'))).starts_with("unfinished"));
    EXPECT_EQ(told(exr_attribute("a", "x", std::string(left / 2, 'x')) +
                   exr_attribute("b", "x", std::string(left / 2 + 2, 'x'))),
              "malformed header: attributes of more than 33554432 bytes");
}

TEST(ImageProportions, PngAndJpegAreRefusedForWhatTheyAskFor) {
    const auto png = [](std::uint32_t width, std::uint32_t height) {
        std::string file = png_start + png_header(width, height, 16, 6);
        file.resize(4 << 20);
        return refusal(check_png, file);
    };
    EXPECT_NE(png(11585, 11585).find("checksum"), std::string::npos) << "it goes on to what follows";
    EXPECT_TRUE(png(16384, 16384).starts_with("its pixels need 2147483648 bytes")) << png(16384, 16384);
    const auto jpeg = [](std::uint32_t width, std::uint32_t height) {
        std::string file = "\xff\xd8\xff\xc0" + big_endian(17, 2) + '\x08' + big_endian(height, 2) +
                           big_endian(width, 2) + '\x03' + std::string(9, 0);
        file.resize(2 << 20);
        return refusal(check_jpeg, file);
    };
    EXPECT_TRUE(jpeg(16000, 16000).starts_with("truncated"));
    EXPECT_TRUE(jpeg(65000, 65000).starts_with("its pixels need 12675000000 bytes")) << jpeg(65000, 65000);
}

}  // namespace
}  // namespace darkroom
