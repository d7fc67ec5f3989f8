// SPDX-License-Identifier: MIT
// PNG, JPEG and TIFF by their own libraries, against what OpenImageIO makes of the same files.
#include <csetjmp>
#include <cstdio>
#include <cstdlib>

// After <cstdio>, which it needs.
#include <jpeglib.h>
#include <tiffio.h>

#include "core/files.hpp"
#include "formats/exif.hpp"
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/jpeg/jpeg_source.hpp"
#include "formats/png/png_check.hpp"
#include "formats/png/png_source.hpp"
#include "formats/tiff/tiff_check.hpp"
#include "formats/tiff/tiff_source.hpp"
#include "image/codec/codecs.hpp"
#include "image/picture/picture_source.hpp"
#include "image/test_bytes.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

using Source = Result<std::unique_ptr<PictureSource>>;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::vector<std::byte> rows_of(PictureSource& source, std::uint32_t row, std::uint32_t rows, SampleKind kind) {
    const FilePart& part = source.parts()[0];
    const std::size_t size = size_of(kind), pixel = size * part.channels.size();
    std::vector<std::byte> out(pixel * part.width * rows);
    std::vector<SamplePlace> places;
    for (std::size_t c = 0; c < part.channels.size(); ++c)
        places.push_back({.channel = c,
                          .kind = kind,
                          .first = out.data() + c * size,
                          .pixel_bytes = static_cast<std::ptrdiff_t>(pixel),
                          .row_bytes = static_cast<std::ptrdiff_t>(pixel * part.width)});
    const auto done = source.read_rows(0, row, rows, places);
    EXPECT_TRUE(done) << done.error().text;
    return out;
}

void expect_same(PictureSource& ours, std::span<const std::byte> file, const std::string& what) {
    const auto library = codecs();
    ASSERT_TRUE(library) << library.error().text;
    // Anew for each reading: it goes back in no file that it has by no name.
    const auto reference = [&] { return (*library)->open(**format_of_file(file), file); };
    const Source described = reference();
    ASSERT_TRUE(described) << what << described.error().text;
    const FilePart &a = ours.parts()[0], &b = (*described)->parts()[0];
    ASSERT_EQ(a.channels, b.channels) << what;
    ASSERT_EQ(a.kinds, b.kinds) << what;
    ASSERT_EQ(std::pair(a.width, a.height), std::pair(b.width, b.height)) << what;
    const auto number = [](const PictureSource& source, const char* name) {
        const std::vector<double> numbers = source.numbers(0, name);
        return numbers.empty() ? 1.0 : numbers[0];
    };
    EXPECT_EQ(number(ours, "Orientation"), number(**described, "Orientation")) << what;
    // Of JPEG, OpenImageIO 2.4 has the inverse.
    if ((*format_of_file(file))->name != "JPEG") {
        EXPECT_EQ(number(ours, "PixelAspectRatio"), number(**described, "PixelAspectRatio")) << what;
    }
    for (const SampleKind sample : {a.kinds[0], SampleKind::Float}) {
        const auto expected = rows_of(**reference(), 0, b.height, sample);
        EXPECT_TRUE(rows_of(ours, 0, a.height, sample) == expected) << what << name_of(sample);
        // In any order, and some left out.
        const std::size_t row = expected.size() / a.height;
        for (const std::uint32_t first : {a.height / 2, a.height - 1, 0U}) {
            const auto one = rows_of(ours, first, 1, sample);
            EXPECT_TRUE(std::equal(one.begin(), one.end(), expected.begin() + static_cast<std::ptrdiff_t>(first * row)))
                << what << first;
        }
    }
}

TEST(DecodersPng, EveryKindIsAsOpenImageIoHasIt) {
    std::mt19937 random(1);
    constexpr std::uint32_t width = 37, height = 21;
    const std::map<int, std::pair<int, std::vector<int>>> kinds{
        {0, {1, {1, 2, 4, 8, 16}}}, {2, {3, {8, 16}}}, {3, {1, {1, 2, 4, 8}}}, {4, {2, {8, 16}}}, {6, {4, {8, 16}}}};
    for (const auto& [color, samples_and_depths] : kinds)
        for (const int bits : samples_and_depths.second)
            for (const bool is_interlaced : {false, true})
                for (const bool has_transparent : {false, true}) {
                    const auto samples = static_cast<std::uint32_t>(samples_and_depths.first);
                    std::string rows;
                    const auto pass = [&](std::uint32_t across, std::uint32_t down) {
                        for (std::uint32_t y = 0; across > 0 && y < down; ++y) {
                            rows += '\0';
                            for (std::uint32_t i = 0; i < (across * samples * static_cast<std::uint32_t>(bits) + 7) / 8;
                                 ++i)
                                rows += static_cast<char>(random());
                        }
                    };
                    // PNG, third edition, section 8.2: where the seven passes begin, and their steps.
                    const std::array<std::array<std::uint32_t, 4>, 7> passes{{{0, 0, 8, 8},
                                                                              {4, 0, 8, 8},
                                                                              {0, 4, 4, 8},
                                                                              {2, 0, 4, 4},
                                                                              {0, 2, 2, 4},
                                                                              {1, 0, 2, 2},
                                                                              {0, 1, 1, 2}}};
                    if (!is_interlaced) pass(width, height);
                    for (const auto& [x, y, right, down] : passes)
                        if (is_interlaced) pass((width - x + right - 1) / right, (height - y + down - 1) / down);
                    std::string between = png_chunk("gAMA", big_endian(45455, 4)) +
                                          png_chunk("pHYs", big_endian(2000, 4) + big_endian(1000, 4) + '\1');
                    if (color == 3) {
                        std::string palette;
                        for (int i = 0; i < 3 << bits; ++i) palette += static_cast<char>(random());
                        between += png_chunk("PLTE", palette);
                    }
                    if (has_transparent && color < 4)
                        between += png_chunk("tRNS", color == 3   ? std::string("\x10\x80", 2)
                                                     : color == 0 ? std::string("\0\1", 2)
                                                                  : std::string("\0\1\0\2\0\3", 6));
                    const std::string file =
                        png_start +
                        png_header(width, height, static_cast<char>(bits), static_cast<char>(color), is_interlaced) +
                        between + png_chunk("IDAT", stored(rows)) + png_chunk("IEND", "");
                    const std::string what =
                        fmt::format("color {} of {} bits, {} {}: ", color, bits, is_interlaced, has_transparent);
                    const auto checked = check_png(bytes_of(file));
                    ASSERT_TRUE(checked) << what << checked.error().text;
                    const std::span<const std::byte> seen = checked->empty() ? bytes_of(file) : *checked;
                    const Source ours = open_png(seen);
                    ASSERT_TRUE(ours) << what << ours.error().text;
                    expect_same(**ours, seen, what);
                }
}

struct TestJpeg {
    J_COLOR_SPACE from = JCS_RGB, to = JCS_YCbCr;
    int components = 3, sampling = 2;
    bool is_progressive = false;
    std::uint16_t x_density = 72;
    std::string exif;
};

std::string jpeg_file(const TestJpeg& desc, std::uint32_t width, std::uint32_t height) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = desc.components;
    jpeg.in_color_space = desc.from;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, desc.to);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = desc.sampling;
    if (desc.is_progressive) jpeg_simple_progression(&jpeg);
    jpeg.X_density = desc.x_density;
    jpeg.Y_density = 72;
    jpeg_start_compress(&jpeg, TRUE);
    if (!desc.exif.empty())
        jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(desc.exif.data()),
                          static_cast<unsigned>(desc.exif.size()));
    std::mt19937 random(2);
    std::vector<unsigned char> row(std::size_t{width} * static_cast<std::size_t>(desc.components));
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<unsigned char>(i * 3 + y * 2 + random() % 32);
        unsigned char* const at = row.data();
        jpeg_write_scanlines(&jpeg, const_cast<JSAMPARRAY>(&at), 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string out(reinterpret_cast<const char*>(memory), size);
    std::free(memory);
    return out;
}

std::string exif_file(std::uint16_t orientation) {
    const auto entry = [](std::uint16_t tag, std::uint16_t type, std::uint32_t value) {
        return little_endian(tag) + little_endian(type) + little_endian(1U) + little_endian(value);
    };
    return std::string("II*\0", 4) + little_endian(8U) + little_endian(std::uint16_t{2}) + entry(259, 3, 6) +
           entry(274, 3, orientation) + little_endian(0U);
}

TEST(DecodersJpeg, EveryKindIsAsOpenImageIoHasIt) {
    for (const TestJpeg& desc :
         std::vector<TestJpeg>{{},
                               {.sampling = 1},
                               {.is_progressive = true},
                               {.to = JCS_RGB, .sampling = 1},
                               {.from = JCS_GRAYSCALE, .to = JCS_GRAYSCALE, .components = 1, .sampling = 1},
                               {.from = JCS_CMYK, .to = JCS_CMYK, .components = 4, .sampling = 1},
                               {.from = JCS_CMYK, .to = JCS_YCCK, .components = 4},
                               {.exif = std::string("Exif\0\0", 6) + exif_file(6)},
                               {.x_density = 36}}) {
        const std::string file = jpeg_file(desc, 131, 75);
        const std::string what = fmt::format("{} as {}, {} {}: ", static_cast<int>(desc.from),
                                             static_cast<int>(desc.to), desc.sampling, desc.is_progressive);
        ASSERT_TRUE(check_jpeg(bytes_of(file))) << what;
        const Source ours = open_jpeg(bytes_of(file));
        ASSERT_TRUE(ours) << what << ours.error().text;
        expect_same(**ours, bytes_of(file), what);
        // JFIF 1.02: pixels for a length.
        EXPECT_EQ((*ours)->numbers(0, "PixelAspectRatio"),
                  desc.x_density == 36 ? std::vector{2.0} : std::vector<double>())
            << what;
    }
}

TEST(DecodersJpeg, DamageIsAnError) {
    for (const bool is_progressive : {false, true}) {
        const std::string whole = jpeg_file({.is_progressive = is_progressive}, 131, 75);
        std::size_t refused = 0;
        std::mt19937 random(4);
        for (std::size_t size = 4; size < whole.size(); size += 61) {
            const std::string cut = whole.substr(0, size) + "\xff\xd9";
            const Source source = open_jpeg(bytes_of(cut));
            if (source) {
                std::vector<std::byte> row(131);
                const SamplePlace place{
                    .kind = SampleKind::Integer8, .first = row.data(), .pixel_bytes = 1, .row_bytes = 0};
                const auto done = (*source)->read_rows(0, 0, 75, std::span(&place, 1));
                if (done) continue;
                EXPECT_TRUE(done.error().text.starts_with("damaged or truncated: rows 1 to 75 of 75: "))
                    << done.error().text;
            } else {
                EXPECT_TRUE(source.error().text.starts_with("cannot be read as JPEG: ")) << source.error().text;
            }
            ++refused;
        }
        EXPECT_GE(refused + 3, whole.size() / 61) << "but for what is cut at the last bytes";
    }
}

struct TestLayout {
    std::uint16_t samples = 3, bits = 8, format = SAMPLEFORMAT_UINT, alpha = 0;
    std::uint16_t planar = PLANARCONFIG_CONTIG, compression = COMPRESSION_NONE, orientation = 1;
    std::uint32_t tile = 0, rows = 7;
    bool is_big_endian = false;
};

void write_tiff(const std::filesystem::path& path, const TestLayout& layout, std::uint32_t width,
                std::uint32_t height) {
    const std::unique_ptr<TIFF, decltype(&TIFFClose)> file(TIFFOpen(path.c_str(), layout.is_big_endian ? "wb" : "wl"),
                                                           TIFFClose);
    ASSERT_NE(file, nullptr);
    TIFFSetField(file.get(), TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(file.get(), TIFFTAG_IMAGELENGTH, height);
    TIFFSetField(file.get(), TIFFTAG_SAMPLESPERPIXEL, layout.samples);
    TIFFSetField(file.get(), TIFFTAG_BITSPERSAMPLE, layout.bits);
    TIFFSetField(file.get(), TIFFTAG_SAMPLEFORMAT, layout.format);
    TIFFSetField(file.get(), TIFFTAG_PHOTOMETRIC, layout.samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(file.get(), TIFFTAG_PLANARCONFIG, layout.planar);
    TIFFSetField(file.get(), TIFFTAG_COMPRESSION, layout.compression);
    TIFFSetField(file.get(), TIFFTAG_ORIENTATION, layout.orientation);
    TIFFSetField(file.get(), TIFFTAG_XRESOLUTION, 72.0);
    TIFFSetField(file.get(), TIFFTAG_YRESOLUTION, 36.0);
    if (layout.alpha != 0) TIFFSetField(file.get(), TIFFTAG_EXTRASAMPLES, 1, &layout.alpha);
    if (layout.tile != 0) {
        TIFFSetField(file.get(), TIFFTAG_TILEWIDTH, layout.tile);
        TIFFSetField(file.get(), TIFFTAG_TILELENGTH, layout.tile);
    } else {
        TIFFSetField(file.get(), TIFFTAG_ROWSPERSTRIP, layout.rows);
    }
    std::mt19937 random(6);
    const bool is_tiled = layout.tile != 0;
    const auto count = is_tiled ? TIFFNumberOfTiles(file.get()) : TIFFNumberOfStrips(file.get());
    for (std::uint32_t i = 0; i < count; ++i) {
        std::vector<float> values(
            static_cast<std::size_t>(is_tiled ? TIFFTileSize(file.get()) : TIFFVStripSize(file.get(), layout.rows)) /
                4 +
            1);
        for (float& value : values) value = static_cast<float>(random() % 64) / 32;
        const std::uint32_t band = i % ((height + layout.rows - 1) / layout.rows);
        const tmsize_t size = is_tiled ? TIFFTileSize(file.get())
                                       : TIFFVStripSize(file.get(), std::min(layout.rows, height - band * layout.rows));
        ASSERT_EQ(is_tiled ? TIFFWriteEncodedTile(file.get(), i, values.data(), size)
                           : TIFFWriteEncodedStrip(file.get(), i, values.data(), size),
                  size);
    }
}

class DecodersTiff : public WithFolder {};

TEST_F(DecodersTiff, PlainOnesAreAsOpenImageIoHasThem) {
    std::vector<TestLayout> layouts;
    for (std::uint16_t samples = 1; samples <= 4; ++samples)
        for (const auto& [bits, format] : {std::pair(8, SAMPLEFORMAT_UINT), std::pair(16, SAMPLEFORMAT_UINT),
                                           std::pair(16, SAMPLEFORMAT_IEEEFP), std::pair(32, SAMPLEFORMAT_IEEEFP)})
            for (const auto planar : std::array<std::uint16_t, 2>{PLANARCONFIG_CONTIG, PLANARCONFIG_SEPARATE})
                for (const std::uint32_t tile : {0U, 16U})
                    layouts.push_back({.samples = samples,
                                       .bits = static_cast<std::uint16_t>(bits),
                                       .format = static_cast<std::uint16_t>(format),
                                       .alpha = static_cast<std::uint16_t>(samples % 2 == 1 ? 0
                                                                           : bits == 8      ? EXTRASAMPLE_ASSOCALPHA
                                                                                            : EXTRASAMPLE_UNASSALPHA),
                                       .planar = planar,
                                       .tile = tile});
    for (const auto compression :
         std::array<std::uint16_t, 3>{COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
        layouts.push_back({.bits = 16, .compression = compression, .is_big_endian = true});
    layouts.push_back({.rows = 1});
    layouts.push_back({.orientation = 6, .rows = 100});
    for (const TestLayout& layout : layouts) {
        const std::string what =
            fmt::format("{} of {} bits, format {}, {}, tiles {}, compression {}: ", layout.samples, layout.bits,
                        layout.format, layout.planar, layout.tile, layout.compression);
        write_tiff(file("a.tif"), layout, 37, 45);
        const auto bytes = read_file(file("a.tif"));
        ASSERT_TRUE(bytes) << what;
        const auto checked = check_tiff(*bytes);
        ASSERT_TRUE(checked) << what << checked.error().text;
        const Source ours = open_tiff(*checked);
        ASSERT_TRUE(ours) << what << ours.error().text;
        ASSERT_NE(*ours, nullptr) << what;
        expect_same(**ours, *checked, what);
    }
}

// Entries have 16 bits, and as many as the file gives them are read.
TEST_F(DecodersTiff, APaletteIsReadInAllItsBits) {
    constexpr std::uint32_t width = 37, height = 19;
    for (const std::uint16_t bits : std::array<std::uint16_t, 4>{1, 2, 4, 8})
        for (const bool is_big_endian : {false, true}) {
            const auto count = std::size_t{1} << bits;
            std::mt19937 random(bits);
            std::array<std::vector<std::uint16_t>, 3> map;
            for (auto& values : map)
                for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<std::uint16_t>(random()));
            const std::size_t row_bytes = (std::size_t{width} * bits + 7) / 8;
            std::vector<unsigned char> packed(row_bytes * height);
            for (unsigned char& value : packed) value = static_cast<unsigned char>(random());
            {
                const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(
                    TIFFOpen(file("a.tif").c_str(), is_big_endian ? "wb" : "wl"), TIFFClose);
                TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, width);
                TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, height);
                TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
                TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, bits);
                TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_PALETTE);
                TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
                TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 7);
                TIFFSetField(tiff.get(), TIFFTAG_COLORMAP, map[0].data(), map[1].data(), map[2].data());
                for (std::uint32_t y = 0; y < height; ++y)
                    ASSERT_EQ(TIFFWriteScanline(tiff.get(), &packed[row_bytes * y], y), 1);
            }
            const auto bytes = read_file(file("a.tif"));
            ASSERT_TRUE(bytes);
            const Source ours = open_tiff(*bytes);
            ASSERT_TRUE(ours && *ours != nullptr) << bits;
            std::vector<float> read(std::size_t{width} * height * 3);
            std::vector<SamplePlace> places;
            for (std::size_t i = 0; i < 3; ++i)
                places.push_back({.channel = i,
                                  .kind = SampleKind::Float,
                                  .first = reinterpret_cast<std::byte*>(read.data() + i),
                                  .pixel_bytes = 3 * sizeof(float),
                                  .row_bytes = 3 * sizeof(float) * width});
            ASSERT_TRUE((*ours)->read_rows(0, 0, height, places));
            for (std::size_t y = 0, at = 0; y < height; ++y)
                for (std::size_t x = 0; x < width; ++x)
                    for (std::size_t i = 0; i < 3; ++i, ++at) {
                        std::size_t color = 0;
                        for (std::size_t bit = x * bits; bit < (x + 1) * bits; ++bit)
                            color = color * 2 + (packed[row_bytes * y + bit / 8] >> (7 - bit % 8) & 1);
                        ASSERT_EQ(std::lround(read[at] * 65535), map[i][color]) << bits << ' ' << x << ' ' << y;
                    }
        }
}

TEST_F(DecodersTiff, OthersAreLeftToOpenImageIo) {
    for (const TestLayout& layout :
         std::vector<TestLayout>{{.samples = 5}, {.bits = 32}, {.samples = 4}, {.bits = 4}}) {
        write_tiff(file("a.tif"), layout, 37, 45);
        const auto bytes = read_file(file("a.tif"));
        const Source ours = open_tiff(*bytes);
        ASSERT_TRUE(ours) << ours.error().text;
        EXPECT_EQ(*ours, nullptr) << layout.samples << layout.bits;
    }
}

TEST_F(DecodersTiff, DamageIsAnError) {
    write_tiff(file("a.tif"), {.bits = 16, .compression = COMPRESSION_LZW}, 37, 45);
    const auto whole = read_file(file("a.tif"));
    ASSERT_TRUE(whole);
    std::mt19937 random(7);
    std::size_t refused = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::byte> damaged = *whole;
        for (int i = 0; i < 3; ++i) damaged[8 + random() % (damaged.size() - 8)] = static_cast<std::byte>(random());
        const auto checked = check_tiff(damaged);
        const Source source = checked ? open_tiff(*checked) : Source(failure(checked.error()));
        if (source && *source == nullptr) continue;
        if (source) {
            const FilePart& part = (*source)->parts()[0];
            std::vector<std::byte> row(std::size_t{2} * part.width);
            const SamplePlace place{.kind = part.kinds[0], .first = row.data(), .pixel_bytes = 2, .row_bytes = 0};
            if (size_of(place.kind) > 2 || (*source)->read_rows(0, 0, part.height, std::span(&place, 1))) continue;
        }
        ++refused;
    }
    EXPECT_GT(refused, 100U);
}

TEST(DecodersExif, WhatIsDamagedIsUpright) {
    const std::string whole = exif_file(6);
    EXPECT_EQ(orientation_of_exif(bytes_of(whole)), 6);
    EXPECT_EQ(orientation_of_exif(bytes_of(exif_file(9))), 1);
    for (std::size_t size = 0; size + 4 < whole.size(); ++size) {
        const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_EQ(orientation_of_exif(std::as_bytes(std::span(cut))), 1);
    }
    std::mt19937 random(5);
    for (int round = 0; round < 20000; ++round) {
        std::vector<std::byte> damaged(bytes_of(whole).begin(), bytes_of(whole).end());
        for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
        const int found = orientation_of_exif(damaged);
        EXPECT_TRUE(found >= 1 && found <= 8);
    }
}

}  // namespace
}  // namespace darkroom
