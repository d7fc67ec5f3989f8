// SPDX-License-Identifier: MIT
// Pictures are shown as whoever stored them held the camera: each of the eight ways, in a file of each kind that has
// it.
#include "image/picture/oriented_source.hpp"

#include <gtest/gtest.h>

#include "image/codec/decoder.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/picture_numbers.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImageOriented : public WithFolder {
  protected:
    /// All samples, three a pixel.
    struct Shown {
        std::uint32_t width = 0, height = 0;
        std::vector<float> rgb;
        friend bool operator==(const Shown&, const Shown&) = default;
        [[nodiscard]] std::array<float, 3> at(std::uint32_t x, std::uint32_t y) const {
            const std::size_t i = (std::size_t{y} * width + x) * 3;
            return {rgb[i], rgb[i + 1], rgb[i + 2]};
        }
    };
    static Shown shown(const std::filesystem::path& path) {
        auto decoder = Decoder::open(path);
        EXPECT_TRUE(decoder) << decoder.error().text;
        if (!decoder) return {};
        const FilePart& part = decoder->parts()[0];
        Shown out{part.width, part.height, {}};
        // In bands that do not divide the height.
        out.rgb.resize(std::size_t{part.width} * part.height * 3);
        const auto read = [&](std::uint32_t row, std::uint32_t rows, float* to) {
            std::vector<SamplePlace> places;
            for (std::size_t c = 0; c < 3; ++c)
                places.push_back({.channel = c,
                                  .first = reinterpret_cast<std::byte*>(to + c),
                                  .pixel_bytes = 3 * sizeof(float),
                                  .row_bytes = static_cast<std::ptrdiff_t>(part.width * 3 * sizeof(float))});
            const auto done = decoder->read_rows(0, row, rows, places);
            EXPECT_TRUE(done) << done.error().text;
        };
        for (std::uint32_t row = 0; row < part.height; row += 5)
            read(row, std::min(5U, part.height - row), out.rgb.data() + std::size_t{row} * part.width * 3);
        return out;
    }
    /// By turning and mirroring step by step, unlike the code.
    static Shown turned(Shown from, int orientation) {
        const auto mirror = [](const Shown& of) {
            Shown out = of;
            for (std::uint32_t y = 0; y < of.height; ++y)
                for (std::uint32_t x = 0; x < of.width; ++x)
                    std::ranges::copy(of.at(of.width - 1 - x, y), out.rgb.begin() + (y * of.width + x) * 3);
            return out;
        };
        const auto clockwise = [](const Shown& of) {
            Shown out{of.height, of.width, std::vector<float>(of.rgb.size())};
            for (std::uint32_t y = 0; y < of.height; ++y)
                for (std::uint32_t x = 0; x < of.width; ++x)
                    std::ranges::copy(of.at(x, y), out.rgb.begin() + (x * out.width + of.height - 1 - y) * 3);
            return out;
        };
        // EXIF's names: mirrored; upside down; both; and those that lie, to be turned by a quarter.
        const std::array<std::pair<bool, int>, 8> steps{
            {{false, 0}, {true, 0}, {false, 2}, {true, 2}, {true, 3}, {false, 1}, {true, 1}, {false, 3}}};
        const auto [is_mirrored, quarters] = steps[static_cast<std::size_t>(orientation - 1)];
        if (is_mirrored) from = mirror(from);
        for (int i = 0; i < quarters; ++i) from = clockwise(from);
        return from;
    }
};

TEST_F(ImageOriented, JpegByItsExif) {
    Picture picture(27, 17);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i * 31 % 101) / 101;
    ASSERT_TRUE(write_picture(file("plain.jpg"), picture));
    const std::string plain = content(file("plain.jpg"));
    const Shown upright = shown(file("plain.jpg"));
    ASSERT_EQ(upright.width, 27U);
    for (int orientation = 0; orientation <= 9; ++orientation) {
        std::string tiff("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18);
        tiff += static_cast<char>(orientation);
        tiff.resize(26);
        const std::string exif = std::string("Exif\0\0", 6) + tiff;
        put(file("a.jpg"),
            plain.substr(0, 2) + "\xff\xe1" + '\0' + static_cast<char>(exif.size() + 2) + exif + plain.substr(2));
        const bool is_known = orientation >= 1 && orientation <= 8;
        EXPECT_EQ(shown(file("a.jpg")), is_known ? turned(upright, orientation) : upright) << orientation;
        const auto frame = read_frame(file("a.jpg"));
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_EQ(frame->color.width, is_known && orientation >= 5 ? 17U : 27U);
        const auto numbers = read_numbers(file("a.jpg"), nullptr);
        ASSERT_TRUE(numbers) << numbers.error().text;
        EXPECT_EQ(numbers->width, is_known && orientation >= 5 ? 17U : 27U);
    }
}

TEST_F(ImageOriented, RadianceByItsAxes) {
    const auto write = [&](const std::string& axes, int width, int height) {
        std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + axes + "\n";
        for (int i = 0; i < width * height; ++i) text += {static_cast<char>(i + 64), 'a', 'b', static_cast<char>(0x80)};
        put(file("a.hdr"), text);
        return shown(file("a.hdr"));
    };
    const Shown upright = write("-Y 5 +X 3", 3, 5);
    ASSERT_EQ(upright.width, 3U);
    ASSERT_NE(upright.at(0, 0), upright.at(0, 4));
    // A line is a row from the top down or from the bottom up, or a column from the left or from the right.
    EXPECT_EQ(write("-Y 5 -X 3", 3, 5), turned(upright, 2));
    EXPECT_EQ(write("+Y 5 -X 3", 3, 5), turned(upright, 3));
    EXPECT_EQ(write("+Y 5 +X 3", 3, 5), turned(upright, 4));
    const Shown columns = write("+X 5 -Y 3", 3, 5);
    EXPECT_EQ(columns.width, 5U);
    for (std::uint32_t x = 0; x < 5; ++x)
        for (std::uint32_t y = 0; y < 3; ++y) EXPECT_EQ(columns.at(x, y), upright.at(y, x));
    const auto expect_columns = [&](const std::string& axes, bool is_from_right, bool is_from_bottom) {
        const Shown found = write(axes, 3, 5);
        for (std::uint32_t x = 0; x < 5; ++x)
            for (std::uint32_t y = 0; y < 3; ++y)
                EXPECT_EQ(found.at(is_from_right ? 4 - x : x, is_from_bottom ? 2 - y : y), upright.at(y, x)) << axes;
    };
    expect_columns("+X 5 +Y 3", false, true);
    expect_columns("-X 5 -Y 3", true, false);
    expect_columns("-X 5 +Y 3", true, true);
}

TEST_F(ImageOriented, RadianceWithOtherAxesIsRefused) {
    for (const std::string axes : {"-Y 2 +Y 2", "+X 2 +X 2", "-Z 2 +X 2", "2 2", ""}) {
        put(file("a.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + axes + "\n" + std::string(16, 'a'));
        EXPECT_FALSE(Decoder::open(file("a.hdr"))) << axes;
    }
}

}  // namespace
}  // namespace darkroom
