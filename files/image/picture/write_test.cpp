// SPDX-License-Identifier: MIT
#include "image/picture/write.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/primaries.hpp"
#include "core/srgb.hpp"
#include "image/frame/frame_file.hpp"
#include "image/test_files.hpp"
#include "shared/color_state_reference.hpp"

namespace darkroom {
namespace {

class ImageWrite : public WithFolder {};

// Every 8-bit code in red, others spread; 32 x 24.
Picture codes() {
    Picture picture(32, 24);
    for (std::size_t i = 0; i < picture.pixels.size() / 4; ++i) {
        picture.pixels[i * 4] = static_cast<float>(i % 256) / 255;
        picture.pixels[i * 4 + 1] = static_cast<float>(i % 17) / 16;
        picture.pixels[i * 4 + 2] = static_cast<float>(i % 5) / 4;
        picture.pixels[i * 4 + 3] = static_cast<float>(i % 3) / 2;
    }
    return picture;
}

TEST_F(ImageWrite, IntegersComeBackDecodedToTheCode) {
    const Picture picture = codes();
    struct Case {
        const char* name;
        SampleKind samples;
        float largest;
    };
    for (const Case& c : {Case{"a.png", SampleKind::Integer8, 255}, Case{"b.png", SampleKind::Integer16, 65535},
                          Case{"c.tif", SampleKind::Integer8, 255}, Case{"d.TIFF", SampleKind::Integer16, 65535}}) {
        ASSERT_TRUE(write_picture(file(c.name), picture, {.samples = c.samples, .alpha = true})) << c.name;
        const auto back = read_frame(file(c.name));
        ASSERT_TRUE(back) << back.error().text;
        EXPECT_EQ(back->samples, c.samples) << c.name;
        EXPECT_TRUE(back->has_alpha);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
            const float encoded = i % 4 == 3 ? back->color.pixels[i] : srgb_encode(back->color.pixels[i]);
            ASSERT_NEAR(encoded, picture.pixels[i], 0.51f / c.largest) << c.name << " " << i;
        }
    }
}

TEST_F(ImageWrite, FloatsComeBackAsTheyWere) {
    Picture picture(7, 5);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = std::ldexp(1.0f, static_cast<int>(i % 30) - 14);
    for (const char* name : {"a.exr", "a.tif"}) {
        ASSERT_TRUE(write_picture(file(name), picture, {.samples = SampleKind::Float, .alpha = true}));
        const auto back = read_frame(file(name));
        ASSERT_TRUE(back) << back.error().text;
        EXPECT_EQ(back->color, picture) << name;
    }
    ASSERT_TRUE(write_picture(file("half.exr"), picture, {.alpha = true}));
    const auto half = read_frame(file("half.exr"));
    ASSERT_TRUE(half) << half.error().text;
    EXPECT_EQ(half->samples, SampleKind::Half);
    EXPECT_EQ(half->color, picture) << "powers of two are exact in half";
    ASSERT_TRUE(write_picture(file("a.hdr"), picture));
    const auto radiance = read_frame(file("a.hdr"));
    ASSERT_TRUE(radiance) << radiance.error().text;
    for (std::size_t i = 0; i < picture.pixels.size();
         i += 4)  // a shared exponent: half a step of 8 bits of the largest
        for (std::size_t c = 0; c < 3; ++c) {
            const float largest = std::max({picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]});
            ASSERT_NEAR(radiance->color.pixels[i + c], picture.pixels[i + c], largest / 256);
        }
}

TEST_F(ImageWrite, ValuesAreClampedToTheFormat) {
    Picture picture(2, 1);
    picture.pixels = {
        -1, 2, std::numeric_limits<float>::quiet_NaN(), 1, 1e9f, -std::numeric_limits<float>::infinity(), 0.5f, 1};
    ASSERT_TRUE(write_picture(file("a.exr"), picture));
    const auto half = read_frame(file("a.exr"));
    ASSERT_TRUE(half);
    EXPECT_EQ(half->counts, PixelCounts{});
    EXPECT_EQ(half->color.pixels, (std::vector<float>{-1, 2, 0, 1, 65504, -65504, 0.5f, 1}));
    ASSERT_TRUE(write_picture(file("a.png"), picture));
    const auto png = read_frame(file("a.png"));
    ASSERT_TRUE(png);
    EXPECT_FALSE(png->has_alpha) << "a PNG is opaque unless asked for";
    EXPECT_EQ(png->color.pixels[0], 0);
    EXPECT_EQ(png->color.pixels[1], 1);
    EXPECT_EQ(png->color.pixels[2], 0);
    EXPECT_EQ(png->color.pixels[3], 1);
}

TEST_F(ImageWrite, BytesAreWrittenUnchanged) {
    std::vector<std::uint8_t> rgba(256 * 4);
    for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? i / 8 : i / 4);
    ASSERT_TRUE(write_bytes(file("a.png"), 16, 16, rgba, {.alpha = true}));
    const auto back = read_frame(file("a.png"));
    ASSERT_TRUE(back);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        const float value = i % 4 == 3 ? back->color.pixels[i] : srgb_encode(back->color.pixels[i]);
        ASSERT_EQ(std::lround(value * 255), rgba[i]) << i;
    }
    EXPECT_TRUE(write_bytes(file("a.jpg"), 16, 16, rgba));
    EXPECT_TRUE(read_frame(file("a.jpg")));
    EXPECT_FALSE(write_bytes(file("a.exr"), 16, 16, rgba)) << "bytes have no place in OpenEXR";
}

/// The numbers that a picture of this light has in a state; light 1 is 203 cd/m2.
Picture numbers_in(const Picture& light, const ColorState& state) {
    Picture out = light;
    for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
        std::array<double, 3> nits{};
        for (std::size_t c = 0; c < 3; ++c) nits[c] = 203.0 * light.pixels[i + c];
        const auto numbers = numbers_of(nits, state);
        for (std::size_t c = 0; c < 3; ++c) out.pixels[i + c] = static_cast<float>(numbers[c]);
    }
    return out;
}
// CTA-861.3: the brightest component of a pixel, and the mean of each pixel's brightest.
TEST_F(ImageWrite, PqSaysHowBrightItIs) {
    Picture picture(4, 1);
    // Published codes of 203, 1000 and 100 cd/m2 (ITU-R BT.2408-7), and black.
    const std::array<float, 4> codes{0.5807F, 0.7518F, 0.5081F, 0};
    for (std::uint32_t x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c) picture.at(x, 0)[c] = c == static_cast<int>(x % 3) ? codes[x] : 0;
    ASSERT_TRUE(
        write_picture(file("a.png"), picture, {.samples = SampleKind::Integer16, .space = *find_output_space("pq")}));
    const std::string text = content(file("a.png"));
    const auto number = [&](std::size_t at) {
        std::uint32_t out = 0;
        for (std::size_t i = 0; i < 4; ++i) out = out << 8 | static_cast<unsigned char>(text.at(at + i));
        return out;
    };
    const std::size_t light = text.find("cLLI"), display = text.find("mDCV");
    ASSERT_TRUE(light != std::string::npos && display != std::string::npos && light < text.find("IDAT"));
    EXPECT_NEAR(number(light + 4) / 1e4, 1000, 2);
    EXPECT_NEAR(number(light + 8) / 1e4, (203 + 1000 + 100) / 4.0, 1);
    EXPECT_EQ(number(display + 4), 35400U << 16 | 14600U) << "red of Rec. 2020, in fiftieths of a thousandth";
    EXPECT_EQ(number(display + 20), 10000000U);
    EXPECT_NE(read_frame(file("a.png"))->color_said.find("cd/m2"), std::string::npos);
    ASSERT_TRUE(write_picture(file("b.png"), picture));
    EXPECT_EQ(content(file("b.png")).find("cLLI"), std::string::npos);
}

TEST_F(ImageWrite, EverySpaceIsSaidByTheFileAndReadAgain) {
    for (const char* const name : {"srgb", "p3", "pq", "hlg"}) {
        const Result<OutputSpace> space = find_output_space(name);
        ASSERT_TRUE(space);
        const Picture light = codes();
        const auto path = file(std::string(name) + ".png");
        ASSERT_TRUE(write_picture(path, numbers_in(light, *space->integers),
                                  {.samples = SampleKind::Integer16, .space = *space}));
        const auto back = read_frame(path);
        ASSERT_TRUE(back) << back.error().text;
        EXPECT_EQ(back->samples, SampleKind::Integer16);
        EXPECT_TRUE(back->warnings.empty()) << name;
        for (std::size_t i = 0; i < light.pixels.size(); ++i)
            if (i % 4 != 3) {
                ASSERT_NEAR(back->color.pixels[i], light.pixels[i], 4e-4) << name << " " << i;
            }
        EXPECT_EQ(content(path).find("cICP") != std::string::npos, name != std::string_view("srgb")) << name;
    }
    for (const char* const name : {"srgb", "p3", "rec2020"}) {
        const Result<OutputSpace> space = find_output_space(name);
        ASSERT_TRUE(space);
        const Picture light = codes();
        const auto path = file(std::string(name) + ".exr");
        ASSERT_TRUE(
            write_picture(path, numbers_in(light, *space->floats), {.samples = SampleKind::Float, .space = *space}));
        const auto back = read_frame(path);
        ASSERT_TRUE(back) << back.error().text;
        for (std::size_t i = 0; i < light.pixels.size(); ++i)
            if (i % 4 != 3) {
                ASSERT_NEAR(back->color.pixels[i], light.pixels[i], 1e-5) << name << " " << i;
            }
    }
}

TEST_F(ImageWrite, SpacesThatAFileCannotHoldAreRefused) {
    const auto error = [&](const char* name, const char* space, std::optional<SampleKind> samples = std::nullopt) {
        const auto kind = sample_kind(name, {.samples = samples, .space = *find_output_space(space)});
        return kind ? std::string(name_of(*kind)) : kind.error().text;
    };
    EXPECT_EQ(error("a.png", "pq"), name_of(SampleKind::Integer16)) << "eight bits are not enough";
    EXPECT_EQ(error("a.png", "pq", SampleKind::Integer8),
              "a.png: pq in 8 bits shows steps (ITU-R BT.2100 asks for 10); --bits 16 is allowed");
    EXPECT_EQ(error("a.png", "srgb"), name_of(SampleKind::Integer8));
    EXPECT_EQ(error("a.jpg", "p3"), "a.jpg: JPEG cannot be marked as p3; .exr .png can");
    EXPECT_EQ(error("a.png", "rec2020"), "a.png: rec2020 in 16-bit integer samples; allowed: srgb, p3, pq, hlg");
    EXPECT_EQ(error("a.exr", "pq"), "a.exr: pq in half samples; allowed: srgb, p3, rec2020");
}

TEST_F(ImageWrite, WhatCannotBeIsRefusedInOneLine) {
    const Picture picture(2, 2);
    const auto text = [&](const char* name, const WriteOptions& options) {
        const auto written = write_picture(file(name), picture, options);
        return written ? std::string("written") : written.error().text.substr(folder_.string().size() + 1);
    };
    EXPECT_EQ(text("a.gif", {}), "a.gif: unknown extension .gif; " + written_extensions() + " can be written");
    EXPECT_EQ(text("a", {}), "a: no extension; " + written_extensions() + " can be written");
    EXPECT_EQ(text("a.png", {.samples = SampleKind::Half}),
              "a.png: half samples in PNG; allowed: 8-bit integer, 16-bit integer");
    EXPECT_EQ(text("a.jpg", {.alpha = true}), "a.jpg: JPEG has no alpha; .exr .png .tif have");
    EXPECT_EQ(text("a.jpg", {.quality = 0}), "a.jpg: a JPEG quality of 0; [1, 100] is allowed");
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(ImageWrite, NoTimeIsWritten) {
    for (const char* const name : {"a.jpg", "a.tif", "a.png", "a.exr", "a.hdr"}) {
        ASSERT_TRUE(write_picture(file(name), codes())) << name;
        const std::string text = content(file(name));
        for (const char* const century : {"19", "20"})
            for (std::size_t at = text.find(century); at != std::string::npos; at = text.find(century, at + 1))
                EXPECT_FALSE(at + 5 < text.size() && std::isdigit(static_cast<unsigned char>(text[at + 3])) != 0 &&
                             text[at + 4] == ':')
                    << name << ": " << text.substr(at, 19);
    }
}

TEST_F(ImageWrite, FailureLeavesTheOldFile) {
    const Picture picture(2, 2);
    put(file("a.png"), "old");
    EXPECT_FALSE(write_picture(file("a.png"), Picture(), {}));
    EXPECT_FALSE(write_picture(file("a.png"), picture, {.samples = SampleKind::Float}));
    EXPECT_EQ(content(file("a.png")), "old");
    EXPECT_FALSE(write_picture(file("no/such.png"), picture));
    EXPECT_EQ(file_count(), 1u);
    ASSERT_TRUE(write_picture(file("a.png"), picture));
    EXPECT_NE(content(file("a.png")), "old");
    EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace darkroom
