// SPDX-License-Identifier: MIT
// Files that lie about what is in them: what is refused before a decoder sees them, and what of a file it gets to see.
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/png/png_check.hpp"
#include "formats/tiff/tiff_check.hpp"
#include "image/frame/frame_file.hpp"
#include "image/test_bytes.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

template <class Check>
std::string told(const Check& check, const std::string& file) {
    const auto checked = check(std::as_bytes(std::span(file)));
    return checked ? "" : checked.error().text;
}

class HostilePictures : public WithFolder {
  protected:
    [[nodiscard]] std::string develop(const std::string& text) const {
        put(file("a"), text);
        const auto frame = read_frame(file("a"));
        return frame ? "" : frame.error().text.substr(file("a").string().size() + 2);
    }
};

TEST_F(HostilePictures, TiffIsWhatItsDirectorySays) {
    EXPECT_EQ(develop(TestTiff::gray(16, 16).text()), "");
    TestTiff lines = TestTiff::gray(16, 16);
    lines.tags[278] = {8};
    EXPECT_EQ(develop(lines.text()), "2 strips in a list of 1: truncated, or a damaged header");
    const std::uint32_t place = static_cast<std::uint32_t>(8 + 2 + 12 * 9 + 4 + 16);
    lines.tags[273] = {place, place + 128};
    lines.tags[279] = {128, 128};
    EXPECT_EQ(develop(lines.text()), "");
    lines.tags[279] = {128, 127};
    EXPECT_EQ(develop(lines.text()), "truncated: strip 2 of 2 has 127 bytes of 128");
    lines.tags[279] = {128, 128};
    lines.tags[273] = {place, 5000};
    EXPECT_EQ(develop(lines.text()), "truncated: strip 2 of 2 lies at byte 5000, outside the file of 394 bytes");
    TestTiff cut = TestTiff::gray(16, 16);
    cut.samples.resize(100);
    EXPECT_EQ(develop(cut.text()), "truncated: strip 1 of 1 lies at byte 122, outside the file of 222 bytes");
}

TEST_F(HostilePictures, TiffAsksForNoMoreThanIsAllowed) {
    const auto tiled = [&](std::uint32_t width, std::uint32_t height, std::uint32_t samples = 1,
                           std::uint32_t side = 16) {
        TestTiff file = TestTiff::gray(16, 16);
        file.tags[256] = file.tags[257] = {side};
        file.tags.erase(273), file.tags.erase(278), file.tags.erase(279);
        file.tags[259] = {8};
        file.tags[277] = {samples};
        file.tags[322] = {width}, file.tags[323] = {height};
        file.tags[324] = {TestTiff::samples_here}, file.tags[325] = {256};
        return told(check_tiff, file.text());
    };
    EXPECT_EQ(tiled(65536, 32768), "tiles of 65536x32768, [1, 8192] a side is allowed");
    EXPECT_EQ(tiled(8192, 8193), "tiles of 8192x8193, [1, 8192] a side is allowed");
    EXPECT_EQ(tiled(8192, 8192, 4, 8192), "") << "256 MiB";
    EXPECT_EQ(tiled(8192, 8192, 5, 8192),
              "tiles of 8192x8192 pixels need 335544320 bytes each, at most 268435456 are allowed");
    EXPECT_EQ(tiled(4096, 4096), "") << "16 MiB";
    EXPECT_EQ(tiled(4096, 4112), "tiles of 4096x4112 pixels need 16842752 bytes each, at most 16777216 are allowed");
    EXPECT_EQ(tiled(6016, 6016, 1, 6001), "") << "the picture in one tile";
    EXPECT_EQ(tiled(6032, 6016, 1, 6001),
              "tiles of 6032x6016 pixels need 36288512 bytes each, at most 36192256 are allowed");
    TestTiff wide = TestTiff::gray(16, 16);
    wide.tags[256] = {65537};
    EXPECT_EQ(told(check_tiff, wide.text()), "the picture is 65537x16, [1, 65536] a side is allowed");
    wide.tags[256] = {65536}, wide.tags[257] = {16385}, wide.tags[259] = {8};
    EXPECT_EQ(told(check_tiff, wide.text()).substr(0, 33), "its pixels need 1073807360 bytes,");
    TestTiff packed = TestTiff::gray(16, 16);
    packed.tags[259] = {34925};
    EXPECT_EQ(told(check_tiff, packed.text()),
              "compression 34925: none, fax, LZW, JPEG, Deflate, PackBits or Zstandard is read here");
    TestTiff many = TestTiff::gray(16, 16);
    many.tags[259] = {8}, many.tags[278] = {1};
    many.tags[273].assign(16, 250), many.tags[279].assign(16, 256);
    EXPECT_EQ(told(check_tiff, many.text()).substr(0, 30), "strips of 2048 bytes and more ");
}

// A directory that is written anew must not be what it points to.
TEST_F(HostilePictures, OfTiffADecoderSeesOnePictureAndItsSamples) {
    TestTiff file = TestTiff::gray(16, 16);
    file.tags[270] = {0x20202020}, file.tags[700] = {1, 2, 3, 4}, file.tags[34665] = {8};
    file.next = 8;
    const std::string text = file.text();
    const auto cleaned = check_tiff(std::as_bytes(std::span(text)));
    ASSERT_TRUE(cleaned) << cleaned.error().text;
    ASSERT_EQ(cleaned->size(), text.size());
    EXPECT_EQ((*cleaned)[8], std::byte{9}) << "tags";
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ((*cleaned)[10 + 9 * 12 + i], std::byte{0}) << "the next directory";
    EXPECT_EQ(develop(text), "");
    TestTiff inside = TestTiff::gray(16, 16);
    inside.tags[273] = {20};
    inside.tags[279] = {256};
    EXPECT_EQ(develop(inside.text()), "malformed header: strip 1 of 1 lies in the directory");
}

TEST_F(HostilePictures, ScansOfJpegAreCounted) {
    const auto jpeg = [](std::uint32_t side, std::size_t scans) {
        std::string file = "\xff\xd8\xff\xc2" + big_endian(11, 2) + '\x08' + big_endian(side, 2) + big_endian(side, 2) +
                           "\x01\x01\x11" + '\0';
        for (std::size_t i = 0; i < scans; ++i) file += "\xff\xda" + big_endian(8, 2) + "\x01\x01" + std::string(4, 0);
        file += "\xff\xd9";
        return told(check_jpeg, file);
    };
    EXPECT_EQ(jpeg(64, 100), "");
    EXPECT_EQ(jpeg(64, 101), "its picture comes in 101 scans, at most 100 are allowed");
    EXPECT_EQ(jpeg(8192, 32), "");
    EXPECT_EQ(jpeg(8192, 33), "33 scans of 67108864 pixels: scans times pixels may be 2147483648");
}

std::string pixel() { return png_chunk("IDAT", stored(std::string("\0\1\2\3", 4))); }

TEST_F(HostilePictures, OfPngADecoderSeesThePictureAndSmallNumbers) {
    const auto cleaned = [](const std::string& between) {
        const std::string file =
            png_start + png_header(1, 1, 8, 2) + between + pixel() + png_chunk("IEND", "") + "behind";
        const auto checked = check_png(std::as_bytes(std::span(file)));
        if (!checked) return checked.error().text;
        return std::string(reinterpret_cast<const char*>(checked->data()), checked->size());
    };
    const std::string plain = png_start + png_header(1, 1, 8, 2) + pixel() + png_chunk("IEND", "");
    const std::string gamma = png_chunk("gAMA", big_endian(45455, 4));
    const std::string text = png_chunk("zTXt", std::string("a\0\0", 3) + stored("b")) +
                             png_chunk("tEXt", std::string("a\0b", 3)) + png_chunk("iTXt", "a") +
                             png_chunk("prVt", "x") + png_chunk("gAMA", "too long");
    EXPECT_EQ(cleaned(text), plain);
    EXPECT_EQ(cleaned(gamma + text).size(), plain.size() + gamma.size());
    EXPECT_EQ(cleaned(gamma + gamma + text).size(), plain.size() + gamma.size()) << "the first alone";
    EXPECT_EQ(cleaned(png_chunk("ABCD", "x")), "a chunk of the unknown kind ABCD");

    std::string exif("MM\0*\0\0\0\x08\0\2\1\x0e\0\2\0\0\0\4text\1\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0", 38);
    const std::string turned = cleaned(png_chunk("eXIf", exif));
    EXPECT_EQ(turned.size(), plain.size() + 12 + 26);
    EXPECT_EQ(turned.find("text"), std::string::npos);
    EXPECT_NE(turned.find(std::string("\1\x12\0\3\0\0\0\1\0\6", 10)), std::string::npos);
    EXPECT_EQ(cleaned(png_chunk("eXIf", exif.substr(0, 30))).size(), plain.size() + 12 + 26) << "cut off: upright";
}

// A decoder inflates all that there is, for a picture of one pixel, too.
TEST_F(HostilePictures, PixelsOfPngArePackedInNoMoreThanTheyNeed) {
    const auto packed = [](std::size_t bytes) {
        return told(check_png, png_start + png_header(1, 1, 8, 2) + png_chunk("IDAT", std::string(bytes - 9, '\0')) +
                                   png_chunk("IDAT", std::string(9, '\0')) + png_chunk("IEND", ""));
    };
    EXPECT_EQ(packed(65550), "");
    EXPECT_EQ(packed(65551), "its pixels are packed in 65551 bytes, 65550 are allowed for a picture of 1x1");
}

TEST_F(HostilePictures, AProfileOfPngIsInflatedHere) {
    const auto with = [](const std::string& profile) {
        return told(check_png, png_start + png_header(1, 1, 8, 2) +
                                   png_chunk("iCCP", std::string("name\0\0", 6) + profile) + pixel() +
                                   png_chunk("IEND", ""));
    };
    EXPECT_EQ(with(stored(std::string(std::size_t{4} << 20, 'p'))), "");
    EXPECT_EQ(with(stored(std::string((std::size_t{4} << 20) + 1, 'p'))),
              "the profile of its colors has more than 4194304 bytes");
    EXPECT_EQ(with("no stream"), "damaged: the profile of its colors cannot be inflated");
}

TEST_F(HostilePictures, APaletteHasTheColorsThatPixelsName) {
    // 4 bits: 2 pixels a byte; rows have a filter: none, left, above, mean, Paeth.
    const auto picture = [&](std::size_t colors, std::uint32_t width, std::uint32_t height, const std::string& rows,
                             char bits = 4, bool is_interlaced = false) {
        return develop(png_start + png_header(width, height, bits, 3, is_interlaced) +
                       png_chunk("PLTE", std::string(3 * colors, 'c')) + png_chunk("IDAT", stored(rows)) +
                       png_chunk("IEND", ""));
    };
    const std::string rows("\0\x12\x34\1\x10\x03\2\x01\x01\3\x10\x01\4\x01\x01", 15);
    EXPECT_EQ(picture(16, 4, 5, rows), "");
    EXPECT_EQ(picture(5, 4, 1, rows.substr(0, 3)), "");
    EXPECT_EQ(picture(4, 4, 1, rows.substr(0, 3)), "a pixel has color 4 of the palette, [0, 3] is allowed");
    EXPECT_EQ(picture(4, 3, 1, rows.substr(0, 3)), "") << "what fills the last byte is no pixel";
    const auto second_row = [&](const std::string& row) { return picture(3, 2, 2, std::string("\0\1\1", 3) + row, 8); };
    EXPECT_EQ(second_row(std::string("\3\2\0", 3)), "") << "2 and half of 0 and 1, then half of 2 and 1";
    EXPECT_EQ(second_row("\3\2\2"), "a pixel has color 3 of the palette, [0, 2] is allowed");
    EXPECT_EQ(second_row(std::string("\4\1\0", 3)), "") << "1 and above, then the left";
    EXPECT_EQ(second_row("\4\1\1"), "a pixel has color 3 of the palette, [0, 2] is allowed");
    EXPECT_EQ(picture(3, 1, 2, std::string("\0\1\2\1", 4), 8), "") << "1, then 1 and 1";
    EXPECT_EQ(picture(3, 1, 2, std::string("\0\1\2\2", 4), 8), "a pixel has color 3 of the palette, [0, 2] is allowed");
    EXPECT_EQ(picture(3, 2, 1, std::string("\0\1\0\2", 4), 8, true), "") << "passes of a pixel each";
    EXPECT_EQ(picture(2, 2, 1, std::string("\0\1\0\2", 4), 8, true),
              "a pixel has color 2 of the palette, [0, 1] is allowed");
    EXPECT_EQ(picture(4, 4, 2, rows.substr(0, 3)), "damaged or truncated: its pixels cannot be inflated");
}

}  // namespace
}  // namespace darkroom
