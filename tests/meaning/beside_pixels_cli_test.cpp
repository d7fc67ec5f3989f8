// SPDX-License-Identifier: MIT
// What files of other programs hold beside the pixels that are read: EXIF's word of their colours, further pages,
// frames and pictures. Pages are written by libtiff, the others byte by byte; colours are those of published matrices.
#include <fmt/format.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliBesidePixels : public test::CliFixture {
  protected:
    void make_files() override { write("plain.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n"); }
    struct Developed {
        std::array<double, 3> light{};
        std::string warnings;
    };
    /// Of the first pixel.
    [[nodiscard]] Developed develop(const std::string& from) const {
        const Outcome outcome = run(
            {"develop", path(from), "--look", path("plain.toml"), "-o", path("light.exr"), "--bits", "float", "-q"});
        EXPECT_EQ(outcome.code, 0) << from << outcome.err;
        if (outcome.code != 0) return {};
        const Picture out = picture("light.exr");
        return {{out.pixels[0], out.pixels[1], out.pixels[2]}, outcome.err};
    }
    [[nodiscard]] nlohmann::json info(const std::string& name) const {
        const Outcome outcome = run({"info", path(name), "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
    void expect_told(const std::string& name, const std::string& line) const {
        EXPECT_EQ(develop(name).warnings, fmt::format("darkroom: warning: {}: {}\n", path(name), line));
        EXPECT_EQ(info(name).at("warnings").at(0), line) << name;
    }
};

/// ColorSpace and InteroperabilityIndex, in directories that lie so far into a file.
struct Exif {
    std::uint16_t space = 0;
    std::string index;

    static std::string entry(std::uint16_t tag, std::uint16_t type, std::uint32_t count, const std::string& value) {
        return little_endian(tag) + little_endian(type) + little_endian(count) + value;
    }
    [[nodiscard]] std::string directories(std::uint32_t at) const {
        return little_endian(std::uint16_t{2}) + entry(0xa001, 3, 1, little_endian(std::uint32_t{space})) +
               entry(0xa005, 4, 1, little_endian(at + 30)) + little_endian(0U) + little_endian(std::uint16_t{1}) +
               entry(1, 2, 4, index + '\0') + little_endian(0U);
    }
    [[nodiscard]] std::string file() const {
        return std::string("II*\0", 4) + little_endian(8U) + little_endian(std::uint16_t{1}) +
               entry(0x8769, 4, 1, little_endian(26U)) + little_endian(0U) + directories(26);
    }
};

constexpr std::array<std::uint8_t, 3> color_codes{64, 160, 208};

std::string png_of(const Exif& exif, bool is_behind, const std::string& more = "") {
    const std::string row = '\0' + std::string(color_codes.begin(), color_codes.end()),
                      chunk = png_chunk("eXIf", exif.file());
    return png_start + png_header(1, 1, 8, 2) + more + (is_behind ? "" : chunk) + png_chunk("IDAT", stored(row)) +
           (is_behind ? chunk : "") + png_chunk("IEND", "");
}

std::string tiff_of(const Exif& exif) {
    TestTiff tiff = TestTiff::gray(1, 1);
    tiff.samples = std::string(color_codes.begin(), color_codes.end());
    tiff.tags[258] = {8, 8, 8};
    tiff.tags[262] = {2};
    tiff.tags[277] = {3};
    tiff.tags[279] = {3};
    tiff.tags[34665] = {0};
    const auto at = static_cast<std::uint32_t>(tiff.text().size());
    tiff.tags[34665] = {at};
    return tiff.text() + exif.directories(at);
}

std::string webp_of(const Exif& exif) {
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeLosslessRGB(color_codes.data(), 1, 1, 3, &bytes);
    const std::string picture(reinterpret_cast<const char*>(bytes) + 12, size - 12);
    WebPFree(bytes);
    const auto chunk = [](const std::string& name, const std::string& data) {
        return name + little_endian(static_cast<std::uint32_t>(data.size())) + data +
               std::string(data.size() % 2, '\0');
    };
    const std::string all =
        "WEBP" + chunk("VP8X", "\x08" + std::string(9, '\0')) + picture + chunk("EXIF", exif.file());
    return "RIFF" + little_endian(static_cast<std::uint32_t>(all.size())) + all;
}

/// Adobe Systems, "Adobe RGB (1998) Color Image Encoding", 2005, 4.3.5.3, and IEC 61966-2-1: light of Rec. 709.
std::array<double, 3> adobe_light() {
    constexpr std::array<std::array<double, 3>, 3> to_xyz{
        {{0.57667, 0.18556, 0.18823}, {0.29734, 0.62736, 0.07529}, {0.02703, 0.07069, 0.99134}}};
    constexpr std::array<std::array<double, 3>, 3> from_xyz{
        {{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}}};
    std::array<double, 3> xyz{}, out{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < 3; ++i) xyz[row] += to_xyz[row][i] * std::pow(color_codes[i] / 255.0, 563.0 / 256);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < 3; ++i) out[row] += from_xyz[row][i] * xyz[i];
    return out;
}
std::array<double, 3> srgb_light() {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = std::pow((color_codes[i] / 255.0 + 0.055) / 1.055, 2.4);
    return out;
}

TEST_F(CliBesidePixels, ExifSaysAdobeRgbWhereNothingElseSaysMore) {
    const Exif adobe{65535, "R03"};
    Picture flat(16, 16);
    for (std::size_t i = 0; i < flat.pixels.size(); ++i)
        flat.pixels[i] = i % 4 == 3 ? 1 : static_cast<float>(color_codes[i % 4]) / 255;
    ASSERT_TRUE(write_picture(path("flat.jpg"), flat, {.quality = 100}));
    const std::string jpeg = content(path("flat.jpg")), segment = std::string("Exif\0\0", 6) + adobe.file();
    write("a.jpg",
          jpeg.substr(0, 2) + "\xff\xe1" + '\0' + static_cast<char>(segment.size() + 2) + segment + jpeg.substr(2));
    write("a.png", png_of(adobe, false));
    write("behind.png", png_of(adobe, true));
    write("a.tif", tiff_of(adobe));
    write("a.webp", webp_of(adobe));
    const auto expect_near = [](const Developed& found, const std::array<double, 3>& right, double tolerance) {
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.light[i], right[i], tolerance) << i;
    };
    for (const std::string name : {"a.jpg", "a.png", "behind.png", "a.tif", "a.webp"}) {
        SCOPED_TRACE(name);
        const Developed found = develop(name);
        expect_near(found, adobe_light(), name == "a.jpg" ? 0.01 : 2e-4);  // a code of JPEG is 0.008 here
        EXPECT_EQ(found.warnings, "");
        EXPECT_EQ(info(name).at("color"), "by EXIF: Adobe RGB (1998)");
    }
    // What says more goes before, and what contradicts is told.
    write("srgb.png", png_of(adobe, false, png_chunk("sRGB", std::string(1, '\0'))));
    write("p3.png", png_of(adobe, false, png_chunk("cICP", std::string("\x0c\x0d\0\1", 4))));
    for (const auto& [name, said] : {std::pair("srgb.png", "sRGB"), std::pair("p3.png", "cICP 12 13 0 1")})
        expect_told(name, fmt::format("EXIF says Adobe RGB (1998), and {} another space, which is obeyed", said));
    expect_near(develop("srgb.png"), srgb_light(), 1e-4);
    for (const auto& [exif, line] :
         {std::pair(Exif{1, "R98"}, ""),
          std::pair(Exif{65535, "R98"},
                    "EXIF says that its colors are uncalibrated, and nothing says what they are: taken as sRGB"),
          std::pair(Exif{1, "R03"}, "EXIF says sRGB in one place and Adobe RGB in another: taken as sRGB")}) {
        write("b.tif", tiff_of(exif));
        expect_near(develop("b.tif"), srgb_light(), 1e-4);
        if (std::string(line).empty())
            EXPECT_EQ(develop("b.tif").warnings, "");
        else
            expect_told("b.tif", line);
    }
}

// libtiff writes the directory; it has no place for the index.
TEST_F(CliBesidePixels, ExifOfBigTiffIsReadToo) {
    for (const char* const mode : {"wl8", "wb8", "wl", "wb"}) {
        TIFF* const tiff = TIFFOpen(path("big.tif").c_str(), mode);
        ASSERT_NE(tiff, nullptr);
        for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, 1),
                                         {TIFFTAG_IMAGELENGTH, 1},
                                         {TIFFTAG_SAMPLESPERPIXEL, 3},
                                         {TIFFTAG_BITSPERSAMPLE, 8},
                                         {TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB},
                                         {TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG}})
            TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
        std::array<std::uint8_t, 3> codes = color_codes;
        ASSERT_EQ(TIFFWriteEncodedStrip(tiff, 0, codes.data(), 3), 3);
        ASSERT_EQ(TIFFWriteDirectory(tiff), 1);
        ASSERT_EQ(TIFFCreateEXIFDirectory(tiff), 0);
        TIFFSetField(tiff, EXIFTAG_COLORSPACE, 2);  // Adobe RGB, as cameras write it
        std::uint64_t exif = 0;
        ASSERT_EQ(TIFFWriteCustomDirectory(tiff, &exif), 1);
        ASSERT_EQ(TIFFSetDirectory(tiff, 0), 1);
        TIFFSetField(tiff, TIFFTAG_EXIFIFD, exif);
        ASSERT_EQ(TIFFRewriteDirectory(tiff), 1);
        TIFFClose(tiff);
        const Developed found = develop("big.tif");
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.light[i], adobe_light()[i], 2e-4) << mode << i;
    }
}

/// A page of 2x2 of one grey; kind: NewSubfileType.
void add_page(TIFF* tiff, std::uint8_t grey, std::uint32_t kind = 0, std::uint32_t side = 2) {
    TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, kind);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, side);
    std::string samples(std::size_t{side} * side, static_cast<char>(grey));
    EXPECT_GT(TIFFWriteEncodedStrip(tiff, 0, samples.data(), static_cast<tmsize_t>(samples.size())), 0);
    EXPECT_EQ(TIFFWriteDirectory(tiff), 1);
}

TEST_F(CliBesidePixels, OfPagesTheFirstWholeOneIsReadAndTheOthersAreTold) {
    constexpr std::uint8_t other = 10, right = 200;
    const double light = std::pow((right / 255.0 + 0.055) / 1.055, 2.4);
    const auto store = [&](const std::string& name, const char* mode, auto pages) {
        TIFF* const tiff = TIFFOpen(path(name).c_str(), mode);
        ASSERT_NE(tiff, nullptr);
        pages(tiff);
        TIFFClose(tiff);
    };
    for (const char* const mode : {"wl", "wb", "w8"}) {
        store("three.tif", mode, [&](TIFF* tiff) {
            add_page(tiff, right);
            add_page(tiff, other);
            add_page(tiff, other);
        });
        EXPECT_NEAR(develop("three.tif").light[0], light, 1e-5) << mode;
        expect_told("three.tif", "has 3 pages: the first is read");
        store("small_first.tif", mode, [&](TIFF* tiff) {
            add_page(tiff, other, FILETYPE_REDUCEDIMAGE, 1);
            add_page(tiff, right);
        });
        EXPECT_EQ(info("small_first.tif").at("size"), (nlohmann::json{2, 2})) << mode;
        EXPECT_EQ(develop("small_first.tif").warnings, "") << "nothing is lost";
        EXPECT_NEAR(develop("small_first.tif").light[0], light, 1e-5) << mode;
        store("small_and_two.tif", mode, [&](TIFF* tiff) {
            add_page(tiff, other, FILETYPE_REDUCEDIMAGE, 1);
            add_page(tiff, right);
            add_page(tiff, other);
        });
        EXPECT_NEAR(develop("small_and_two.tif").light[0], light, 1e-5) << mode;
        expect_told("small_and_two.tif", "has 3 pages: page 2 is read");
        // As cameras have it: the whole picture is named by its small copy alone.
        store("inner.tif", mode, [&](TIFF* tiff) {
            const std::array<toff_t, 1> room{0};
            TIFFSetField(tiff, TIFFTAG_SUBIFD, std::uint16_t{1}, room.data());
            add_page(tiff, other, FILETYPE_REDUCEDIMAGE, 1);
            add_page(tiff, right);
        });
        EXPECT_NEAR(develop("inner.tif").light[0], light, 1e-5) << mode;
    }
    // Levels of a texture, as maketx writes them.
    store("levels.tif", "wl", [&](TIFF* tiff) {
        for (const std::uint32_t side : {5U, 2U, 1U}) add_page(tiff, right, 0, side);
    });
    EXPECT_EQ(develop("levels.tif").warnings, "");
    const Outcome compared = run({"compare", path("three.tif"), path("three.tif")});
    EXPECT_EQ(compared.code, 0);
    EXPECT_NE(compared.err.find("three.tif: has 3 pages: the first is read"), std::string::npos) << compared.err;
    // Pictures of numbers, too: masks, and tables.
    write("mask.toml", "format = 1\n[[stack]]\neffect = \"auto_exposure\"\nmetering_mask = \"three.tif\"\n");
    write("table.toml", "format = 1\n[[stack]]\neffect = \"lut\"\nlut = \"table.png\"\n");
    std::string rows;
    for (int i = 0; i < 64; ++i) {
        if (i % 8 == 0) rows += '\0';
        for (const int value : {i % 4, i / 4 % 4, i / 16}) rows += static_cast<char>(85 * value);
    }
    write("table.png",
          png_start + png_header(8, 8, 8, 2) + png_chunk("acTL", big_endian(12, 4) + big_endian(0, 4)) +
              png_chunk("fcTL", big_endian(0, 4) + big_endian(8, 4) + big_endian(8, 4) + std::string(14, '\0')) +
              png_chunk("IDAT", stored(rows)) + png_chunk("IEND", ""));
    for (const auto& [look, line] :
         {std::pair("mask", "three.tif: has 3 pages: the first is read"),
          std::pair("table", "table.png: is an animation of 12 frames: the first is read")}) {
        const Outcome told =
            run({"develop", path("levels.tif"), "--look", path(look) + ".toml", "-o", path("o.png"), "-q"});
        EXPECT_EQ(told.code, 0) << told.err;
        EXPECT_NE(told.err.find(line), std::string::npos) << told.err;
    }
    TestTiff round = TestTiff::gray(2, 2);
    round.next = 8;
    write("round.tif", round.text());
    EXPECT_EQ(develop("round.tif").warnings, "") << "its one page is followed by itself";
    TestTiff sensor = TestTiff::gray(2, 2);
    sensor.tags[262] = {32803};
    write("sensor.tif", sensor.text());
    expect_refused({"info", path("sensor.tif")}, 1, "the meaning 32803 of its samples (numbers of a camera's sensor)");
}

TEST_F(CliBesidePixels, AnimationsAreToldWithTheirFrames) {
    const auto png = [&](std::uint32_t frames, bool is_first) {
        const std::string control =
            png_chunk("fcTL", big_endian(0, 4) + big_endian(1, 4) + big_endian(1, 4) + std::string(14, '\0'));
        return png_start + png_header(1, 1, 8, 2) + png_chunk("acTL", big_endian(frames, 4) + big_endian(0, 4)) +
               (is_first ? control : "") +
               png_chunk("IDAT", stored('\0' + std::string(color_codes.begin(), color_codes.end()))) +
               (is_first ? "" : control) + png_chunk("IEND", "");
    };
    write("many.png", png(12, true));
    expect_told("many.png", "is an animation of 12 frames: the first is read");
    write("beside.png", png(3, false));
    expect_told("beside.png", "has an animation of 3 frames beside its picture: the picture is read");
    write("one.png", png(1, true));
    EXPECT_EQ(develop("one.png").warnings, "");
    const std::string anim = "ANIM" + little_endian(6U) + std::string(6, '\0');
    write("many.webp", "RIFF" + little_endian(static_cast<std::uint32_t>(anim.size() + 4)) + "WEBP" + anim);
    expect_refused({"info", path("many.webp")}, 1, "is animated, which is not read");
}

TEST_F(CliBesidePixels, FurtherPicturesOfAJpegAreTold) {
    ASSERT_TRUE(write_picture(path("flat.jpg"), Picture(16, 16)));
    const std::string plain = content(path("flat.jpg"));
    const auto segment = [](char kind, const std::string& data) {
        return std::string("\xff") + kind + big_endian(static_cast<std::uint32_t>(data.size() + 2), 2) + data;
    };
    // CIPA DC-007: a directory with the number of pictures and a list of 16 bytes each, which count from its head.
    const auto with = [&](std::uint32_t kind, const std::string& second) {
        const auto mpf = [&](std::uint32_t place) {
            const std::string head = std::string("II*\0", 4) + little_endian(8U) + little_endian(std::uint16_t{2}) +
                                     Exif::entry(0xb001, 4, 1, little_endian(2U)) +
                                     Exif::entry(0xb002, 7, 32, little_endian(38U)) + little_endian(0U);
            return segment('\xe2', std::string("MPF\0", 4) + head + little_endian(0x030000U) + std::string(12, '\0') +
                                       little_endian(kind) + little_endian(static_cast<std::uint32_t>(second.size())) +
                                       little_endian(place) + little_endian(0U));
        };
        const auto end = static_cast<std::uint32_t>(plain.size() + mpf(0).size());
        return plain.substr(0, 2) + mpf(end - 10) + plain.substr(2) + second;
    };
    write("two.jpg", with(0x020002, plain));
    expect_told("two.jpg", "has 2 pictures: the first is read");
    write("copy.jpg", with(0x010001, plain));
    EXPECT_EQ(develop("copy.jpg").warnings, "") << "a smaller copy for displays";
}

TEST_F(CliBesidePixels, RadianceOfTristimulusValuesIsRefusedByItsName) {
    write("xyz.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\x80\x40\x20\x81");
    expect_refused({"info", path("xyz.hdr")}, 1, "its pixels are CIE X, Y and Z (32-bit_rle_xyze)");
}

}  // namespace
}  // namespace darkroom
