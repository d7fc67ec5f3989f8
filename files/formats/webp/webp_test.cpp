// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <random>

#include "formats/webp/webp_check.hpp"
#include "formats/webp/webp_source.hpp"
#include "image/frame/frame_file.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

constexpr int webp_width = 20, webp_height = 10;

/// Red grows to the right, green downwards; alpha is half.
std::vector<std::uint8_t> webp_pixels() {
    std::vector<std::uint8_t> out;
    for (int y = 0; y < webp_height; ++y)
        for (int x = 0; x < webp_width; ++x)
            for (const int value : {x * 12, y * 25, 40, 128}) out.push_back(static_cast<std::uint8_t>(value));
    return out;
}

enum class Packing { Lossless, Lossy, LossyOpaque };

std::string webp_file(Packing packing) {
    std::vector<std::uint8_t> pixels = webp_pixels();
    if (packing == Packing::LossyOpaque)
        for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 255;
    std::uint8_t* bytes = nullptr;
    const std::size_t size =
        packing == Packing::Lossless
            ? WebPEncodeLosslessRGBA(pixels.data(), webp_width, webp_height, 4 * webp_width, &bytes)
            : WebPEncodeRGBA(pixels.data(), webp_width, webp_height, 4 * webp_width, 95, &bytes);
    std::string out(reinterpret_cast<const char*>(bytes), size);
    WebPFree(bytes);
    return out;
}

/// A chunk, padded to an even size.
std::string chunk_of(const std::string& name, const std::string& data) {
    std::string out = name;
    for (std::size_t i = 0; i < 4; ++i) out += static_cast<char>(data.size() >> (8 * i));
    out += data;
    if (data.size() % 2 != 0) out += '\0';
    return out;
}

std::string riff(const std::string& chunks) { return chunk_of("RIFF", "WEBP" + chunks); }

std::string told_of(const std::string& file) {
    const auto checked = check_webp(std::as_bytes(std::span(file)));
    return checked ? "" : checked.error().text;
}

TEST(ImageWebp, PixelsAreThoseThatWerePacked) {
    for (const Packing packing : {Packing::Lossless, Packing::Lossy, Packing::LossyOpaque}) {
        const std::string text = webp_file(packing);
        const auto opened = open_source(std::as_bytes(std::span(text)));
        ASSERT_TRUE(opened) << opened.error().text;
        EXPECT_EQ(opened->format->name, "WebP");
        const FilePart& part = opened->source->parts()[0];
        ASSERT_EQ(part.width, 20U);
        ASSERT_EQ(part.height, 10U);
        ASSERT_EQ(part.channels.size(), packing == Packing::LossyOpaque ? 3U : 4U);
        const std::vector<std::uint8_t> pixels = webp_pixels();
        for (std::size_t channel = 0; channel < part.channels.size(); ++channel) {
            std::vector<float> floats(200);
            std::vector<std::uint16_t> words(200);
            const auto read = [&](SampleKind kind, void* first, std::ptrdiff_t size) {
                const SamplePlace place{.channel = channel,
                                        .kind = kind,
                                        .first = static_cast<std::byte*>(first) + 2 * webp_width * size,
                                        .pixel_bytes = size,
                                        .row_bytes = size * webp_width};
                return opened->source->read_rows(0, 2, 8, {&place, 1}).has_value();
            };
            ASSERT_TRUE(read(SampleKind::Float, floats.data(), sizeof(float)));
            ASSERT_TRUE(read(SampleKind::Integer16, words.data(), sizeof(std::uint16_t)));
            EXPECT_EQ(floats[2 * webp_width - 1], 0);
            for (std::size_t i = 2 * webp_width; i < 200; ++i) {
                const float expected = pixels[i * 4 + channel] / 255.0F;
                EXPECT_NEAR(floats[i], expected, packing == Packing::Lossless || channel == 3 ? 1e-6F : 0.12F) << i;
                EXPECT_NEAR(static_cast<float>(words[i]) / 65535, floats[i], 1e-5F);
            }
        }
    }
}

TEST(ImageWebp, WhatItsChunksDoNotHoldIsRefused) {
    for (const Packing packing : {Packing::Lossless, Packing::Lossy}) {
        const std::string text = webp_file(packing);
        EXPECT_EQ(told_of(text), "");
        EXPECT_EQ(told_of(text + "tail"), "");
        EXPECT_TRUE(told_of(text.substr(0, 40)).starts_with("truncated: 40 bytes of ")) << told_of(text.substr(0, 40));
        EXPECT_EQ(told_of(text.substr(0, 12)), "truncated: 12 bytes are not a WebP file");
    }
    EXPECT_EQ(told_of(riff(std::string("VP8L\xff\0\0\0", 8) + "abcd")), "truncated: chunk VP8L has 4 bytes of 255");
    EXPECT_EQ(told_of(riff(chunk_of("EXIF", "abcd"))), "has no picture");
    EXPECT_EQ(told_of(riff(chunk_of("VP8L", "abcdefgh"))), "chunk VP8L begins with no picture");
    EXPECT_EQ(told_of(riff(chunk_of("VP8 ", "abcdefghijkl"))), "chunk VP8  begins with no picture");
    EXPECT_EQ(told_of(riff(chunk_of("VP8X", std::string("\2\0\0\0\0\0\0\0\0\0", 10)))),
              "is animated, which is not read");
    const std::string lossless = chunk_of("VP8L", std::string("\x2f\3\0\0\0", 5));
    EXPECT_EQ(told_of(riff(lossless)), "");
    EXPECT_EQ(told_of(riff(lossless + lossless)), "has more than one picture");
    EXPECT_EQ(told_of(riff(chunk_of("VP8X", std::string("\0\0\0\0\7\0\0\0\0\0", 10)) + lossless)),
              "the picture is 4x1 on a canvas of 8x1");
}

TEST(ImageWebp, NoDamageEndsTheProgram) {
    std::mt19937 random(3);
    for (const Packing packing : {Packing::Lossless, Packing::Lossy}) {
        const std::string text = webp_file(packing);
        int refused = 0;
        for (int round = 0; round < 500; ++round) {
            std::string damaged = text;
            for (int i = 0; i < 1 + round % 4; ++i)
                damaged[30 + random() % (damaged.size() - 30)] = static_cast<char>(random());
            const auto opened = open_source(std::as_bytes(std::span(damaged)));
            std::vector<float> floats(200);
            const SamplePlace place{.first = reinterpret_cast<std::byte*>(floats.data()),
                                    .pixel_bytes = sizeof(float),
                                    .row_bytes = webp_width * sizeof(float)};
            if (!opened || opened->source->parts()[0].width != 20 || opened->source->parts()[0].height != 10 ||
                !opened->source->read_rows(0, 0, 10, {&place, 1}))
                ++refused;
        }
        EXPECT_GT(refused, 20);
    }
}

class ImageWebpFile : public WithFolder {};

TEST_F(ImageWebpFile, IsAFrameOfItsPicture) {
    put(file("a"), webp_file(Packing::Lossless));
    const auto frame = read_frame(file("a"));
    ASSERT_TRUE(frame) << frame.error().text;
    ASSERT_EQ(frame->color.width, 20U);
    ASSERT_EQ(frame->color.height, 10U);
    // sRGB is decoded: 40 of 255.
    EXPECT_NEAR(frame->color.pixels[2], std::pow((40 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
}

// EXIF 2.32, 4.6.4: at 6 the first row of the file is the right edge of what is shown.
TEST_F(ImageWebpFile, ItIsShownUpright) {
    const std::string picture = webp_file(Packing::Lossless).substr(12);
    const std::string extended = chunk_of("VP8X", std::string("\x18\0\0\0\x13\0\0\x09\0\0", 10)) + picture;
    const std::string exif("II*\0\x08\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0\0\0\0\0", 26);
    for (const std::string& head : {std::string(), std::string("Exif\0\0", 6)}) {
        put(file("turned"), riff(extended + chunk_of("EXIF", head + exif)));
        const auto frame = read_frame(file("turned"));
        ASSERT_TRUE(frame) << frame.error().text;
        ASSERT_EQ(frame->color.width, 10U);
        ASSERT_EQ(frame->color.height, 20U);
        const float* const corner = frame->color.pixels.data() + 9 * 4;
        EXPECT_EQ(corner[0], 0) << "red grows downwards";
        EXPECT_EQ(corner[1], 0) << "green grows to the left";
        EXPECT_GT(corner[19 * 10 * 4], 0.1);
        EXPECT_EQ(corner[19 * 10 * 4 + 1], 0);
    }
    put(file("damaged"), riff(extended + chunk_of("EXIF", exif.substr(0, 20))));
    const auto frame = read_frame(file("damaged"));
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(frame->color.width, 20U);
}

TEST_F(ImageWebpFile, ItsProfileSaysWhichColorsTheyAre) {
    const std::string picture = webp_file(Packing::Lossless).substr(12);
    // A profile of no name is not read, which is told.
    const std::string text = riff(chunk_of("VP8X", std::string("\x30\0\0\0\x13\0\0\x09\0\0", 10)) +
                                  chunk_of("ICCP", std::string(200, 'x')) + picture);
    const auto bytes = std::as_bytes(std::span(text));
    const FileColor color = (*format_of_file(bytes))->color(bytes, true);
    EXPECT_FALSE(color.coding);
    EXPECT_TRUE(color.warning.starts_with("its ICC profile is not read")) << color.warning;
    EXPECT_TRUE(open_source(std::as_bytes(std::span(text))));
}

}  // namespace
}  // namespace darkroom
