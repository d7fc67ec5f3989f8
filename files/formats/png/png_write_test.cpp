// SPDX-License-Identifier: MIT
#include "formats/png/png_write.hpp"
#include "formats/png/png.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "image/codec/codecs.hpp"
#include "image/picture/picture_source.hpp"

namespace darkroom {
namespace {

enum class Kind { Noise, Smooth, Grainy, Flat };

template <class T>
std::vector<T> samples(Kind kind, std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
    std::mt19937 random(7);
    std::vector<T> out;
    const double most = std::numeric_limits<T>::max();
    std::normal_distribution<double> grain(0, 0.01);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::uint32_t c = 0; c < channels; ++c) {
                const double smooth = 0.5 + 0.4 * std::sin(0.02 * x + c) * std::cos(0.013 * y);
                double value = smooth;
                if (kind == Kind::Noise) value = std::uniform_real_distribution<double>(0, 1)(random);
                if (kind == Kind::Grainy) value = smooth + grain(random);
                if (kind == Kind::Flat) value = (x / 40 + y / 30) % 2 == 0 ? 0.1 : 0.7;
                out.push_back(static_cast<T>(std::lround(std::clamp(value, 0.0, 1.0) * most)));
            }
    return out;
}

template <class T>
void expect_back(Kind kind, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                 std::optional<int> level) {
    const std::vector<T> in = samples<T>(kind, width, height, channels);
    const auto file = encode_png({.kind = sizeof(T) == 1 ? SampleKind::Integer8 : SampleKind::Integer16,
                                  .width = width,
                                  .height = height,
                                  .channels = channels,
                                  .compression = level ? std::to_string(*level) : "",
                                  .samples = in.data()});
    ASSERT_TRUE(file);
    auto opened = open_source(*file);
    ASSERT_TRUE(opened) << opened.error().text;
    ASSERT_EQ(opened->format, &png_format());
    const FilePart& part = opened->source->parts().front();
    EXPECT_EQ(part.width, width);
    EXPECT_EQ(part.height, height);
    ASSERT_EQ(part.channels.size(), channels);
    std::vector<T> out(in.size());
    std::vector<SamplePlace> places;
    for (std::uint32_t c = 0; c < channels; ++c)
        places.push_back({.channel = c,
                          .kind = sizeof(T) == 1 ? SampleKind::Integer8 : SampleKind::Integer16,
                          .first = reinterpret_cast<std::byte*>(out.data() + c),
                          .pixel_bytes = static_cast<std::ptrdiff_t>(sizeof(T) * channels),
                          .row_bytes = static_cast<std::ptrdiff_t>(sizeof(T) * channels * width)});
    ASSERT_TRUE(opened->source->read_rows(0, 0, height, places));
    EXPECT_EQ(out, in);
}

TEST(ImagePng, WhatIsEncodedIsDecoded) {
    for (const Kind kind : {Kind::Noise, Kind::Smooth, Kind::Flat})
        for (const auto& [width, height] :
             {std::pair(1u, 1u), std::pair(1u, 9u), std::pair(37u, 23u), std::pair(640u, 3u)})
            for (const std::uint32_t channels : {3u, 4u}) {
                expect_back<std::uint8_t>(kind, width, height, channels, {});
                expect_back<std::uint16_t>(kind, width, height, channels, {});
            }
    for (const int level : {0, 1, 9, 12}) expect_back<std::uint8_t>(Kind::Grainy, 64, 48, 3, level);
}

TEST(ImagePng, SaysThatItIsSrgb) {
    const std::vector<std::uint8_t> pixel{1, 2, 3};
    const auto file = encode_png({.width = 1, .height = 1, .samples = pixel.data()});
    ASSERT_TRUE(file);
    const std::string_view text(reinterpret_cast<const char*>(file->data()), file->size());
    EXPECT_LT(text.find("sRGB"), text.find("IDAT"));
    EXPECT_NE(text.find("sRGB"), std::string_view::npos);
}

// What libpng makes at its default level is what people compare with.
TEST(ImagePng, IsAtMostATenthLargerThanLibpngMakesIt) {
    const auto library = codecs();
    ASSERT_TRUE(library) << library.error().text;
    constexpr std::uint32_t width = 640, height = 360;
    for (const Kind kind : {Kind::Noise, Kind::Smooth, Kind::Grainy, Kind::Flat}) {
        const std::vector<std::uint8_t> in = samples<std::uint8_t>(kind, width, height, 3);
        const auto ours = encode_png({.width = width, .height = height, .samples = in.data()});
        const auto theirs = (*library)->encode(png_format(), {.width = width, .height = height, .samples = in.data()});
        ASSERT_TRUE(ours && theirs);
        EXPECT_LE(static_cast<double>(ours->size()), 1.1 * static_cast<double>(theirs->size()))
            << static_cast<int>(kind);
    }
}

}  // namespace
}  // namespace darkroom
