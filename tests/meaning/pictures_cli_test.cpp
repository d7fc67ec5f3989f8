// SPDX-License-Identifier: MIT
// What pictures of other programs mean: alpha in and out, samples of TIFF, the header of Radiance, chroma of JPEG.
// Files are written by libtiff and byte by byte, numbers are closed forms.
#include <Imath/half.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/layer_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::Outcome;

double decoded(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
double encoded(double light) { return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055; }

/// `bits` of each sample, packed as TIFF has them: high bits first below a byte, else low byte first.
void store_tiff(const std::string& path, std::uint32_t width, std::uint32_t height, std::uint16_t channels,
                std::uint16_t bits, std::uint16_t format, std::uint16_t meaning,
                const std::vector<std::uint64_t>& samples, int extra = -1) {
    TIFF* const tiff = TIFFOpen(path.c_str(), "wl");
    ASSERT_NE(tiff, nullptr);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, meaning);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    if (extra >= 0) {
        const auto kind = static_cast<std::uint16_t>(extra);
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
    }
    std::vector<std::uint8_t> bytes;
    for (std::uint32_t y = 0; y < height; ++y) {
        std::size_t used = 0;
        for (std::size_t i = 0; i < std::size_t{width} * channels; ++i) {
            const std::uint64_t sample = samples[y * std::size_t{width} * channels + i];
            if (bits % 8 == 0) {
                for (int byte = 0; byte < bits; byte += 8) bytes.push_back(static_cast<std::uint8_t>(sample >> byte));
                continue;
            }
            for (int bit = bits; bit-- > 0; ++used) {
                if (used % 8 == 0) bytes.push_back(0);
                bytes.back() |= static_cast<std::uint8_t>((sample >> bit & 1) << (7 - used % 8));
            }
        }
    }
    EXPECT_GE(TIFFWriteRawStrip(tiff, 0, bytes.data(), static_cast<tmsize_t>(bytes.size())), 0);
    TIFFClose(tiff);
}

std::uint64_t bits_of(float value) {
    std::uint32_t out = 0;
    std::memcpy(&out, &value, sizeof out);
    return out;
}

class CliPictureMeaning : public test::CliFixture {
  protected:
    void make_files() override {
        write("plain.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n");
        write("encode.toml", "format = 1\n[[stack]]\neffect = \"encode\"\n");
    }
    [[nodiscard]] Outcome develop(const std::string& from, const std::string& to, std::vector<std::string> flags = {},
                                  const char* look = "plain.toml") const {
        flags.insert(flags.begin(), {"develop", path(from), "--look", path(look), "-o", path(to), "-q"});
        return run(flags);
    }
    /// Light, multiplied by alpha, of all pixels.
    [[nodiscard]] std::vector<float> light(const std::string& from) const {
        const Outcome outcome = develop(from, "light.exr", {"--alpha", "--bits", "float"});
        EXPECT_EQ(outcome.code, 0) << from << outcome.err;
        return outcome.code == 0 ? picture("light.exr").pixels : std::vector<float>(4096, -1.0f);
    }
};

// One picture, in every kind of file and every meaning of its alpha, and out again into every kind.
TEST_F(CliPictureMeaning, AlphaIsTheSameInEveryFormatDepthAndDirection) {
    constexpr std::uint32_t width = 16, height = 4;
    std::vector<double> straight, alphas;  // three light, one alpha a pixel
    for (std::uint32_t i = 0; i < width * height; ++i) {
        alphas.push_back(i < 4 ? 0 : i / double(width * height - 1));
        for (const double value : {i / 80.0, 0.5, 1 - i / 70.0}) straight.push_back(value);
    }
    const auto right = [&](std::size_t pixel, std::size_t c) {
        return c == 3 ? alphas[pixel] : straight[pixel * 3 + c] * alphas[pixel];
    };
    std::vector<std::pair<std::string, double>> files;  // and how far it may be off
    for (const bool is_associated : {false, true})
        for (const int bits : {8, 16, 32}) {
            std::vector<std::uint64_t> samples;
            for (std::size_t i = 0; i < alphas.size(); ++i)
                for (std::size_t c = 0; c < 4; ++c) {
                    const double by = is_associated ? alphas[i] : 1;
                    const double code =
                        c == 3 ? alphas[i] : (bits == 32 ? straight[3 * i + c] : encoded(straight[3 * i + c])) * by;
                    samples.push_back(bits == 32 ? bits_of(static_cast<float>(code))
                                                 : static_cast<std::uint64_t>(std::lround(code * ((1 << bits) - 1))));
                }
            const std::string name = fmt::format("{}{}.tif", is_associated ? "associated" : "straight", bits);
            store_tiff(path(name), width, height, 4, static_cast<std::uint16_t>(bits),
                       bits == 32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB, samples,
                       is_associated ? EXTRASAMPLE_ASSOCALPHA : EXTRASAMPLE_UNASSALPHA);
            files.emplace_back(name, bits == 8 ? 0.02 : bits == 16 ? 2e-4 : 1e-6);
        }
    for (const SampleKind kind : {SampleKind::Integer8, SampleKind::Integer16}) {
        Picture codes(width, height);
        for (std::size_t i = 0; i < codes.pixels.size(); ++i)
            codes.pixels[i] = static_cast<float>(i % 4 == 3 ? alphas[i / 4] : encoded(straight[i / 4 * 3 + i % 4]));
        const std::string name = fmt::format("straight{}.png", size_of(kind) * 8);
        ASSERT_TRUE(write_picture(path(name), codes, {.samples = kind, .alpha = true}));
        files.emplace_back(name, kind == SampleKind::Integer8 ? 0.01 : 1e-4);
    }
    std::vector<float> values;
    for (std::size_t i = 0; i < alphas.size() * 4; ++i) values.push_back(static_cast<float>(right(i / 4, i % 4)));
    test::store_floats(path("associated.exr"), {"R", "G", "B", "A"}, width, values);
    files.emplace_back("associated.exr", 1e-6);

    for (const auto& [name, allowed] : files) {
        const std::vector<float> found = light(name);
        ASSERT_EQ(found.size(), values.size()) << name;
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_NEAR(found[i], values[i], allowed) << name << " at " << i;
    }
    // Out: what comes back is what went in, by what each file says of itself.
    for (const auto& [to, bits, allowed] :
         {std::tuple("a.tif", "float", 1e-6), std::tuple("a.exr", "float", 1e-6), std::tuple("a.exr", "half", 1e-3),
          std::tuple("a.tif", "16", 3e-4), std::tuple("a.tif", "8", 0.02), std::tuple("a.png", "16", 3e-4),
          std::tuple("a.png", "8", 0.02)}) {
        const bool is_code = std::string(bits) == "8" || std::string(bits) == "16";
        ASSERT_EQ(
            develop("associated.exr", to, {"--alpha", "--bits", bits}, is_code ? "encode.toml" : "plain.toml").code, 0);
        if (std::string(to) == "a.tif") {
            TIFF* const tiff = TIFFOpen(path(to).c_str(), "r");
            std::uint16_t count = 0, *kinds = nullptr;
            EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &kinds), 1);
            EXPECT_EQ(kinds[0], is_code ? EXTRASAMPLE_UNASSALPHA : EXTRASAMPLE_ASSOCALPHA) << bits;
            TIFFClose(tiff);
        }
        const std::vector<float> found = light(to);
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_NEAR(found[i], values[i], allowed) << to << bits << " at " << i;
    }
}

// The mean of colours counts each as much as it is seen.
TEST_F(CliPictureMeaning, WhatIsTransparentLendsNoColourToItsNeighbours) {
    Picture disc(64, 64);
    double share = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const bool is_inside = std::hypot(x - 31.5, y - 31.5) < 20.3;
            share += is_inside / 4096.0;
            const std::array<float, 4> pixel =
                is_inside ? std::array<float, 4>{1, 0, 0, 1} : std::array<float, 4>{0, 1, 0, 0};
            std::ranges::copy(pixel, disc.at(x, y));
        }
    ASSERT_TRUE(write_picture(path("disc.png"), disc, {.alpha = true}));
    ASSERT_TRUE(write_picture(path("disc.tif"), disc, {.alpha = true}));
    for (const char* const from : {"disc.png", "disc.tif"})
        for (const auto& [flag, size] :
             {std::pair("--size", "32x32"), std::pair("--size", "48x48"), std::pair("--output-size", "96x96")}) {
            ASSERT_EQ(develop(from, "out.png", {"--alpha", flag, size}, "encode.toml").code, 0);
            const Picture out = picture("out.png");
            double mean = 0;
            for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
                mean += out.pixels[i + 3] / (static_cast<double>(out.pixels.size()) / 4);
                if (out.pixels[i + 3] < 0.05f) continue;
                ASSERT_NEAR(out.pixels[i], 1, 0.02) << from << flag << size;
                ASSERT_NEAR(out.pixels[i + 1], 0, 0.02) << from << flag << size;
            }
            EXPECT_NEAR(mean, share, 0.02);
        }
    std::vector<float> back = light("disc.png");
    for (std::size_t i = 0; i < back.size(); i += 4)
        ASSERT_TRUE(back[i + 3] > 0 || back[i + 1] == 0) << "no green under alpha 0 reaches a file of light";
}

TEST_F(CliPictureMeaning, GlowOverNothingKeepsItsLightWhereItIsAskedFor) {
    Picture lamp(64, 64);
    for (std::uint32_t y = 28; y < 36; ++y)
        for (std::uint32_t x = 28; x < 36; ++x)
            for (std::uint32_t c = 0; c < 4; ++c) lamp.at(x, y)[c] = c == 3 ? 1.0f : 12.0f;
    test::store_floats(path("lamp.exr"), {"R", "G", "B", "A"}, 64, lamp.pixels);
    const auto glow = [&](const char* flag, const char* to) {
        const Outcome outcome =
            run({"develop", path("lamp.exr"), "--bloom-intensity", "4", "--no-dither", flag, "-o", path(to), "-q"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err.find("nothing is brighter"), std::string::npos) << outcome.err;
        const Picture out = picture(to);
        return std::vector<float>(out.at(25, 32), out.at(25, 32) + 4);
    };
    EXPECT_EQ(glow("--alpha", "plain.png")[3], 0);
    const std::vector<float> made = glow("--alpha=glow", "glow.png");
    EXPECT_GT(made[3], 0.02f);
    // Over black it is what a picture without alpha shows there.
    ASSERT_EQ(
        run({"develop", path("lamp.exr"), "--bloom-intensity", "4", "--no-dither", "-o", path("black.png"), "-q"}).code,
        0);
    EXPECT_NEAR(made[0] * made[3], picture("black.png").at(25, 32)[0], 2.1 / 255);
    expect_refused({"develop", path("lamp.exr"), "--alpha=glw", "-o", path("x.png")}, 1,
                   "--alpha=glw: allowed is glow");
}

TEST_F(CliPictureMeaning, EveryPairOfBitsAndKindOfTiffIsReadRightOrRefusedByName) {
    std::mt19937 random(7);
    constexpr std::uint32_t width = 9, height = 3;
    std::size_t read = 0;
    using Tags = std::initializer_list<std::uint16_t>;
    for (const std::uint16_t meaning : Tags{PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE, PHOTOMETRIC_RGB})
        for (const std::uint16_t format : Tags{SAMPLEFORMAT_UINT, SAMPLEFORMAT_INT, SAMPLEFORMAT_IEEEFP})
            for (const std::uint16_t bits : Tags{1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 15, 16, 20, 24, 32, 64}) {
                if (format != SAMPLEFORMAT_UINT && bits < 8) continue;
                const std::uint16_t channels = meaning == PHOTOMETRIC_RGB ? 3 : 1;
                std::vector<std::uint64_t> samples;
                std::vector<double> right;
                for (std::size_t i = 0; i < std::size_t{width} * height * channels; ++i) {
                    const float value = static_cast<float>(random() % 1000) / 1000;
                    double light = value;
                    if (format == SAMPLEFORMAT_IEEEFP) {
                        samples.push_back(bits == 16   ? Imath::half(value).bits()
                                          : bits == 24 ? bits_of(value) >> 8
                                                       : bits_of(value));
                        if (bits == 16) light = Imath::half(value);
                        if (meaning == PHOTOMETRIC_MINISWHITE) light = 1 - light;
                    } else {
                        const double most = std::pow(2.0, bits) - 1;
                        samples.push_back(static_cast<std::uint64_t>(value * most));
                        const double code = static_cast<double>(samples.back()) / most;
                        light = decoded(meaning == PHOTOMETRIC_MINISWHITE ? 1 - code : code);
                    }
                    right.push_back(light);
                }
                store_tiff(path("a.tif"), width, height, channels, bits, format, meaning, samples);
                const std::string what = fmt::format("{} bits of format {}, meaning {}", bits, format, meaning);
                const Outcome outcome = develop("a.tif", "a.exr", {"--bits", "float"});
                if (outcome.code != 0) {
                    EXPECT_EQ(outcome.code, 1) << what;
                    EXPECT_NE(outcome.err.find(fmt::format("of {} bits", bits)), std::string::npos) << outcome.err;
                    continue;
                }
                ++read;
                const Picture out = picture("a.exr");
                for (std::size_t i = 0; i < right.size(); ++i)
                    // Half an ulp of a half below 1 is 2.4e-4.
                    ASSERT_NEAR(out.pixels[i / channels * 4 + i % channels], right[i], 2.5e-4) << what << " at " << i;
            }
    EXPECT_EQ(read, 2U * 10 + 7) << "8 kinds of whole numbers and 2 of floats, 5 and 2 where 0 is white";
}

// TIFF 6.0, 4: a file that says no BitsPerSample has one.
TEST_F(CliPictureMeaning, ATiffThatSaysNoBitsHasOneForEachSample) {
    TestTiff tiff = TestTiff::gray(16, 1);
    tiff.tags.erase(258);
    tiff.tags[279] = {2};
    tiff.samples = "\xa5\x0f";
    for (const bool has_room : {false, true}) {
        if (has_room) tiff.tags[297] = {0};  // the number of the page, which no decoder needs
        write("bits.tif", tiff.text());
        const std::vector<float> found = light("bits.tif");
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ(found[4 * i], static_cast<float>(0xa50fU >> (15 - i) & 1U)) << has_room << i;
    }
}

// c / 255 is 257 c / 65535, and a float has one number for it.
TEST_F(CliPictureMeaning, ACodeIsTheSameLightInEightAndInSixteenBits) {
    std::vector<std::uint64_t> codes(256 * 3), wide;
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = i / 3;
    for (const std::uint64_t code : codes) wide.push_back(code * 257);
    store_tiff(path("8.tif"), 256, 1, 3, 8, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB, codes);
    store_tiff(path("16.tif"), 256, 1, 3, 16, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB, wide);
    Picture numbers(256, 1);
    for (std::size_t i = 0; i < numbers.pixels.size(); ++i)
        numbers.pixels[i] = i % 4 == 3 ? 1 : static_cast<float>(i / 4) / 255;
    ASSERT_TRUE(write_picture(path("8.png"), numbers));
    ASSERT_TRUE(write_picture(path("16.png"), numbers, {.samples = SampleKind::Integer16}));
    for (const std::string a : {"8.tif", "16.tif", "8.png", "16.png"}) {
        EXPECT_EQ(picture(a).pixels, numbers.pixels) << a;
        for (const std::string b : {"8.tif", "16.tif", "8.png", "16.png"})
            EXPECT_EQ(run({"compare", path(a), path(b), "--fail-max", "0"}).code, 0) << a << ' ' << b;
    }
}

// Ward: a picture's numbers were multiplied by every EXPOSURE and COLORCORR of its header.
TEST_F(CliPictureMeaning, RadianceIsReadAsItsHeaderSays) {
    const std::string pixels("\x80\x40\x20\x81\xff\x01\x00\x80", 8);  // two pixels, (m + 0.5) / 256 * 2^(e - 128)
    const auto red = [&](const std::string& name, const std::string& lines) {
        write(name, "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + pixels);
        const std::vector<float> found = light(name);
        return std::array<float, 3>{found[0], found[1], found[2]};
    };
    using Light = std::array<float, 3>;
    constexpr float r = 128.5f / 128, g = 64.5f / 128, b = 32.5f / 128;
    EXPECT_EQ(red("plain.hdr", ""), (Light{r, g, b})) << "the mantissa is (m + 0.5) / 256";
    EXPECT_EQ(red("one.hdr", "EXPOSURE=0.5\n"), (Light{2 * r, 2 * g, 2 * b}));
    EXPECT_EQ(red("two.hdr", "EXPOSURE= 0.5\nEXPOSURE=4\n"), (Light{r / 2, g / 2, b / 2}));
    EXPECT_EQ(red("corrected.hdr", "COLORCORR=2 1 0.5\n"), (Light{r / 2, g, 2 * b}));
    EXPECT_EQ(red("wrong.hdr", "EXPOSURE=0\nCOLORCORR=1 2\n"), (Light{r, g, b}));
    // The primaries of Rec. 709 change nothing; with red and blue for each other, red and blue are.
    const Light same = red("same.hdr", "PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n");
    const Light turned = red("turned.hdr", "PRIMARIES=0.15 0.06 0.3 0.6 0.64 0.33 0.3127 0.329\n");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(same[i], (Light{r, g, b})[i], 1e-5f);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(turned[i], (Light{b, g, r})[i], 1e-5f);
}

TEST_F(CliPictureMeaning, JpegOfHighQualityKeepsRedAndBlueAtFullResolution) {
    Picture columns(64, 16);
    for (std::size_t i = 0; i < columns.pixels.size(); ++i) {
        const bool is_red = i / 4 % 2 == 0;
        columns.pixels[i] = i % 4 == 3 || i % 4 == (is_red ? 0U : 2U) ? 1.0f : 0.0f;
    }
    ASSERT_TRUE(write_picture(path("columns.png"), columns));
    const auto off = [&](const std::vector<std::string>& flags) {
        const Outcome outcome = develop("columns.png", "a.jpg", flags, "encode.toml");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Picture out = picture("a.jpg");
        float most = 0;
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            most = std::max(most, std::abs(out.pixels[i] - columns.pixels[i]));
        return 255 * most;
    };
    EXPECT_LT(off({"--quality", "100"}), 4);
    EXPECT_LT(off({}), 30) << "of the usual 95, too";
    EXPECT_GT(off({"--quality", "89"}), 100);
    EXPECT_GT(off({"--quality", "100", "--chroma", "4:2:0"}), 100);
    EXPECT_LT(off({"--quality", "89", "--chroma", "4:4:4"}), 60);
    expect_refused({"develop", path("columns.png"), "--chroma", "4:4:4", "-o", path("x.png")}, 1, "PNG has no chroma");
    expect_refused({"develop", path("columns.png"), "--chroma", "4:1:1", "-o", path("x.jpg")}, 1,
                   "allowed: 4:4:4, 4:2:2, 4:2:0");
}

TEST_F(CliPictureMeaning, InfoTellsOfEveryFormatAndOfAnyNumberOfAttributes) {
    const std::array<std::uint8_t, 4> black{0, 0, 0, 255};
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(black.data(), 1, 1, 4, &bytes);
    write("a.webp", std::string(reinterpret_cast<const char*>(bytes), size));
    WebPFree(bytes);
    const Outcome told = run({"info", path("a.webp"), "--json"});
    ASSERT_EQ(told.code, 0) << told.err;
    EXPECT_EQ(nlohmann::json::parse(told.out).at("format"), "WebP");
    const std::vector<float> grey(3 * 4, 0.5f);
    test::store_floats(path("many.exr"), {"R", "G", "B"}, 2, grey, [](Imf::Header& header) {
        for (int i = 0; i < 20000; ++i) header.insert(fmt::format("attribute{:05}", i), Imf::StringAttribute("x"));
    });
    const auto before = std::chrono::steady_clock::now();
    EXPECT_EQ(run({"info", path("many.exr")}).code, 0);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - before;
    EXPECT_LT(taken.count(), 6) << "twenty thousand, each looked for among all, took twice as long";
}

}  // namespace
}  // namespace darkroom
