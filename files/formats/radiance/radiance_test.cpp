// SPDX-License-Identifier: MIT
// Radiance HDR, held by OpenImageIO, which packs and unpacks the same mantissas and reads them half a step lower, and
// by libvips, which reads them as Radiance does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "image/codec/codecs.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/picture_source.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImageRadiance : public WithFolder {
  protected:
    /// Runs, noise, black and all that lies between, of all sizes of light.
    static Picture mixed(std::uint32_t width, std::uint32_t height) {
        Picture out(width, height);
        std::mt19937 random(8);
        const auto number = [&] { return static_cast<float>(random() % 4096) / 4096; };
        for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
            if (i > 0 && random() % 3 != 0) {
                for (std::size_t c = 0; c < 4; ++c) out.pixels[i + c] = out.pixels[i - 4 + c];
                continue;
            }
            const float size = random() % 5 == 0 ? 0.0f : std::ldexp(1.0f, static_cast<int>(random() % 240) - 120);
            for (std::size_t c = 0; c < 3; ++c) out.pixels[i + c] = size * number();
            out.pixels[i + 3] = 1;
        }
        return out;
    }

    [[nodiscard]] Picture read(const std::string& name) const {
        const auto frame = read_frame(file(name));
        EXPECT_TRUE(frame) << frame.error().text;
        return frame ? frame->color : Picture();
    }

    /// By OpenImageIO, three floats a pixel.
    [[nodiscard]] static std::vector<float> theirs(std::span<const std::byte> bytes, const Picture& size) {
        std::vector<float> out(std::size_t{size.width} * size.height * 3);
        const auto source = (*codecs())->open(**format_of_file(bytes), bytes);
        EXPECT_TRUE(source) << source.error().text;
        std::vector<SamplePlace> places;
        for (std::size_t c = 0; c < 3; ++c)
            places.push_back({.channel = c,
                              .first = reinterpret_cast<std::byte*>(out.data() + c),
                              .pixel_bytes = 12,
                              .row_bytes = static_cast<std::ptrdiff_t>(std::size_t{size.width} * 12)});
        EXPECT_TRUE(source && (*source)->read_rows(0, 0, size.height, places));
        return out;
    }
};

TEST_F(ImageRadiance, IsReadHalfAStepAboveOpenImageIoAndWrittenToTheNearest) {
    for (const auto& [width, height] :
         {std::pair(7u, 5u), std::pair(8u, 3u), std::pair(300u, 20u), std::pair(1000u, 4u)}) {
        const Picture picture = mixed(width, height);
        ASSERT_TRUE(write_picture(file("ours.hdr"), picture));
        std::vector<float> samples;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            if (i % 4 < 3) samples.push_back(picture.pixels[i]);
        const auto packed = (*codecs())->encode(
            **written_format("a.hdr"),
            {.kind = SampleKind::Float, .width = width, .height = height, .samples = samples.data()});
        ASSERT_TRUE(packed) << packed.error().text;
        put(file("theirs.hdr"), {reinterpret_cast<const char*>(packed->data()), packed->size()});
        for (const char* const name : {"ours.hdr", "theirs.hdr"}) {
            const Picture found = read(name);
            ASSERT_EQ(found.pixels.size(), picture.pixels.size());
            const std::vector<float> expected = theirs(*read_file(file(name)), picture);
            for (std::size_t i = 0; i < picture.pixels.size() / 4; ++i) {
                const float* const lower = &expected[3 * i];
                const float largest = std::max({lower[0], lower[1], lower[2]});
                int exponent = 0;
                std::frexp(largest * (1 + 0x1p-20f), &exponent);
                const float half_step = largest > 0 ? std::ldexp(1.0f, exponent - 9) : 0.0f;
                for (std::size_t c = 0; c < 3; ++c) {
                    // OpenImageIO's are off by a last bit.
                    ASSERT_NEAR(found.pixels[4 * i + c], lower[c] + half_step, 1e-3f * half_step) << name << " " << i;
                    // Theirs are black below 1e-32.
                    if (std::string_view(name) == "ours.hdr") {
                        ASSERT_LE(std::abs(found.pixels[4 * i + c] - picture.pixels[4 * i + c]), half_step) << i;
                    }
                }
            }
        }
    }
}

TEST_F(ImageRadiance, IsWhatLibvipsReads) {
    if (std::system("command -v vips > /dev/null") != 0) GTEST_SKIP() << "libvips is not on this machine";
    ASSERT_TRUE(write_picture(file("ours.hdr"), mixed(6000, 1)));  // one row: version 8.14 has those of PFM upside down
    ASSERT_EQ(std::system(fmt::format("cd '{}' && vips rad2float ours.hdr theirs.pfm", folder_.string()).c_str()), 0);
    EXPECT_EQ(read("ours.hdr"), read("theirs.pfm"));
}

// Pixels in a row that are 1, 1, 1 repeat the last one, as files before 1991 have them.
TEST_F(ImageRadiance, OldRunsRepeatTheLastPixel) {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 300\n", first("\x80\x40\x20\x81", 4),
                      second("\x90\x40\x20\x81", 4), run("\x01\x01\x01\x2b\x01\x01\x01\x01", 8);  // 43 + 256
    put(file("a.hdr"), head + first + run + second + run);
    const Picture found = read("a.hdr");
    ASSERT_EQ(found.width, 300u);
    for (std::uint32_t x = 0; x < 300; ++x) {
        EXPECT_EQ(found.pixels[4 * x], 128.5f / 128);
        EXPECT_EQ(found.pixels[4 * (300 + x)], 144.5f / 128);
    }
    put(file("b.hdr"), head + run + second + run);
    const auto broken = read_frame(file("b.hdr"));
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().text.find("bad scanline 0 data"), std::string::npos) << broken.error().text;
}

}  // namespace
}  // namespace darkroom
