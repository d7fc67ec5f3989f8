// SPDX-License-Identifier: MIT
// OpenEXR files of all layouts, held against what OpenEXR itself makes of them.

#include "formats/exr/exr_source.hpp"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <random>

#include "core/files.hpp"
#include "formats/exr/exr_check.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

struct Stored {
    const char* name;
    Imf::PixelType type;
    std::vector<float> values;
};

class ImageExrSource : public WithFolder {
  protected:
    // Half of the rows are noise, which nothing packs, the others are smooth.
    static std::vector<float> numbers(std::size_t width, std::size_t height, unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> anything(-100, 100);
        std::vector<float> out(width * height);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = (i / width / 16) % 2 == 0 ? half(anything(random)) : half(static_cast<float>(i % width) / 8);
        return out;
    }

    static void insert(Imf::FrameBuffer& buffer, const Stored& channel, std::vector<std::uint32_t>& room,
                       const Imath::Box2i& window) {
        room.resize(channel.values.size());
        std::size_t size = 4;
        for (std::size_t i = 0; i < room.size(); ++i) {
            if (channel.type == Imf::HALF) {
                size = 2;
                reinterpret_cast<std::uint16_t*>(room.data())[i] = half(channel.values[i]).bits();
            } else if (channel.type == Imf::FLOAT) {
                std::memcpy(&room[i], &channel.values[i], sizeof(float));
            } else {
                room[i] = static_cast<std::uint32_t>(std::abs(channel.values[i]));
            }
        }
        const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
        buffer.insert(channel.name, Imf::Slice::Make(channel.type, room.data(), window, size, size * width));
    }

    void store(const Imf::Header& given, std::span<const Stored> channels) const {
        Imf::Header header = given;
        for (const Stored& channel : channels) header.channels().insert(channel.name, Imf::Channel(channel.type));
        const Imath::Box2i& window = header.dataWindow();
        Imf::FrameBuffer buffer;
        std::vector<std::vector<std::uint32_t>> rooms(channels.size());
        for (std::size_t i = 0; i < channels.size(); ++i) insert(buffer, channels[i], rooms[i], window);
        if (header.hasTileDescription()) {
            Imf::TiledOutputFile out(file("a.exr").c_str(), header);
            out.setFrameBuffer(buffer);
            out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
        } else {
            Imf::OutputFile out(file("a.exr").c_str(), header);
            out.setFrameBuffer(buffer);
            out.writePixels(window.max.y - window.min.y + 1);
        }
    }

    /// Whole channels, and the rows from `row` on.
    void expect_read(std::span<const Stored> channels, std::size_t width, std::uint32_t row,
                     const std::string& what) const {
        const auto bytes = read_file(file("a.exr"));
        ASSERT_TRUE(bytes);
        auto opened = open_source(*bytes);
        ASSERT_TRUE(opened) << opened.error().text << what;
        const FilePart& part = opened->source->parts().front();
        ASSERT_EQ(part.channels.size(), channels.size());
        const std::uint32_t rows = part.height - row;
        for (const Stored& channel : channels) {
            const auto found = std::ranges::find(part.channels, channel.name);
            ASSERT_NE(found, part.channels.end());
            std::vector<float> values(width * rows, -1);
            const SamplePlace place{.channel = static_cast<std::size_t>(found - part.channels.begin()),
                                    .first = reinterpret_cast<std::byte*>(values.data()),
                                    .pixel_bytes = sizeof(float),
                                    .row_bytes = static_cast<std::ptrdiff_t>(sizeof(float) * width)};
            ASSERT_TRUE(opened->source->read_rows(0, row, rows, {&place, 1})) << what;
            for (std::size_t i = 0; i < values.size(); ++i) {
                const float stored = channel.values[row * width + i];
                const float expected = channel.type == Imf::UINT ? std::floor(std::abs(stored)) : stored;
                ASSERT_EQ(values[i], expected) << what << " " << channel.name << " " << i;
            }
        }
    }
};

TEST_F(ImageExrSource, ReadsEveryLosslessCompressionAndKindInBandsToo) {
    constexpr int width = 67, height = 53;
    const std::vector<Stored> channels{{"Z", Imf::FLOAT, numbers(width, height, 1)},
                                       {"R", Imf::HALF, numbers(width, height, 2)},
                                       {"id", Imf::UINT, numbers(width, height, 3)},
                                       {"N.X", Imf::HALF, numbers(width, height, 4)}};
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        for (const bool is_tiled : {false, true}) {
            const Imath::Box2i window({-5, 7}, {-5 + width - 1, 7 + height - 1});
            Imf::Header header(window, window, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
            if (is_tiled) header.setTileDescription({32, 16, Imf::ONE_LEVEL});
            store(header, channels);
            for (const std::uint32_t row : {0u, 5u, 48u})
                expect_read(channels, width, row,
                            fmt::format(" compression {}, tiled {}", static_cast<int>(compression), is_tiled));
        }
}

TEST_F(ImageExrSource, DamagedZipIsAnErrorWithItsChunk) {
    constexpr int width = 64, height = 64;
    const std::vector<Stored> channels{{"R", Imf::HALF, numbers(width, height, 1)}};
    store(Imf::Header(width, height, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION), channels);
    std::string bytes = content(file("a.exr"));
    const std::string intact = bytes;
    bytes[bytes.size() - 300] = static_cast<char>(~bytes[bytes.size() - 300]);
    put(file("a.exr"), bytes);
    const auto frame = read_frame(file("a.exr"));
    ASSERT_FALSE(frame);
    EXPECT_NE(frame.error().text.find("chunk 3 cannot be unpacked"), std::string::npos) << frame.error().text;
}

TEST_F(ImageExrSource, WindowsThatAreEmptyOrTooLargeAreRefused) {
    const std::vector<Stored> channels{{"R", Imf::HALF, numbers(4, 4, 1)}};
    store(Imf::Header(4, 4), channels);
    const std::string intact = content(file("a.exr"));
    struct Case {
        std::array<std::int32_t, 4> window;  ///< left, top, right, bottom: the last pixels
        std::string error;
    };
    for (const Case& tried :
         {Case{{0, 0, -1, 3}, "is empty"}, Case{{0, 0, 3, -1}, "is empty"}, Case{{0, 0, -9, -9}, "is empty"},
          Case{{0, 0, 65536, 3}, "at most 65536 a side"}, Case{{0, 0, 3, 65536}, "at most 65536 a side"},
          Case{{1 << 30, 0, (1 << 30) + 1, 3}, "coordinates in"},
          Case{{0, -(1 << 30) - 1, 3, -(1 << 30)}, "coordinates in"}})
        for (const std::string name : {"dataWindow", "displayWindow"}) {
            std::string bytes = intact;
            const std::string head = name + std::string("\0box2i\0\x10\0\0\0", 11);
            const std::size_t at = bytes.find(head);
            ASSERT_NE(at, std::string::npos);
            std::memcpy(&bytes[at + head.size()], tried.window.data(), sizeof(tried.window));
            const auto checked = check_exr(std::as_bytes(std::span(bytes)));
            ASSERT_FALSE(checked) << name << tried.error;
            EXPECT_NE(checked.error().text.find(tried.error), std::string::npos) << checked.error().text;
        }
}

TEST_F(ImageExrSource, LuminanceAndChromaAreColor) {
    constexpr int width = 40, height = 30;
    const std::vector<Imf::Rgba> pixels(width * height, Imf::Rgba(half(0.5f), half(0.25f), half(2.0f), half(0.5f)));
    for (const bool is_tall : {false, true}) {
        const Imath::Box2i window({0, 0}, {width - 1, height - 1});
        {
            Imf::RgbaOutputFile out(file("yc.exr").c_str(), window, window, Imf::WRITE_YCA);
            out.setFrameBuffer(pixels.data(), 1, width);
            out.writePixels(height);
        }
        const auto frame = read_frame(file("yc.exr"), {.keeps_halves = is_tall});
        ASSERT_TRUE(frame) << frame.error().text;
        FrameFile wide = *frame;
        widen(wide);
        for (const std::uint32_t x : {0u, 20u, 39u}) {
            const float* const pixel = wide.color.at(x, 17);
            EXPECT_NEAR(pixel[0], 0.5, 0.01);
            EXPECT_NEAR(pixel[1], 0.25, 0.01);
            EXPECT_NEAR(pixel[2], 2.0, 0.02);
            EXPECT_EQ(pixel[3], 0.5f);
        }
    }
}

// OpenEXR would make a grey picture of it.
TEST_F(ImageExrSource, ChromaOfAnotherSizeIsRefused) {
    constexpr int side = 8;
    for (const int step : {1, 4}) {
        Imf::Header header(side, side);
        std::vector<half> values(side * side, half(0.5f));
        Imf::FrameBuffer buffer;
        for (const char* const name : {"Y", "RY", "BY"}) {
            const int own = name == std::string_view("Y") ? 1 : step;
            header.channels().insert(name, Imf::Channel(Imf::HALF, own, own));
            buffer.insert(name,
                          Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()), 2, 2 * side / own, own, own));
        }
        {
            Imf::OutputFile out(file("yc.exr").c_str(), header);
            out.setFrameBuffer(buffer);
            out.writePixels(side);
        }
        const auto frame = read_frame(file("yc.exr"));
        ASSERT_FALSE(frame);
        EXPECT_NE(frame.error().text.find(fmt::format("sampled every {} x {} pixels: allowed is 2 x 2", step, step)),
                  std::string::npos)
            << frame.error().text;
    }
}

TEST_F(ImageExrSource, SubsampledChannelsFillTheirPixels) {
    constexpr int width = 10, height = 8;
    Imf::Header header(width, height);
    std::vector<half> color(width * height, half(1.0f));
    std::vector<float> depth;
    for (int i = 0; i < width / 2 * height / 2; ++i) depth.push_back(static_cast<float>(i));
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(color.data()), 2, 2 * width));
    }
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT, 2, 2));
    buffer.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(depth.data()), 4, 4 * width / 2, 2, 2));
    {
        Imf::OutputFile out(file("z.exr").c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(height);
    }
    const auto frame = read_frame(file("z.exr"));
    ASSERT_TRUE(frame && frame->depth) << (frame ? "" : frame.error().text);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            ASSERT_EQ(*frame->depth->at(x, y), static_cast<float>(y / 2 * (width / 2) + x / 2)) << x << " " << y;
}

TEST_F(ImageExrSource, HalvesStayHalvesBitForBit) {
    constexpr int width = 33, height = 21;
    const std::vector<Stored> channels{
        {"R", Imf::HALF, numbers(width, height, 1)},          {"G", Imf::HALF, numbers(width, height, 2)},
        {"B", Imf::HALF, numbers(width, height, 3)},          {"N.X", Imf::HALF, numbers(width, height, 4)},
        {"N.Y", Imf::HALF, numbers(width, height, 5)},        {"N.Z", Imf::HALF, numbers(width, height, 6)},
        {"velocity.X", Imf::HALF, numbers(width, height, 7)}, {"velocity.Y", Imf::FLOAT, numbers(width, height, 8)}};
    const Imath::Box2i data({4, -3}, {4 + width - 1, -3 + height - 1}), display({0, 0}, {35, 35});
    store(Imf::Header(display, data), channels);
    // They are of no world that a camera would have to place.
    const FrameOptions of_view{.normals_space = NormalsSpace::View};
    FrameOptions with_halves = of_view;
    with_halves.keeps_halves = true;
    Result<FrameFile> narrow = read_frame(file("a.exr"), with_halves);
    const Result<FrameFile> wide = read_frame(file("a.exr"), of_view);
    ASSERT_TRUE(narrow && wide);
    EXPECT_EQ(narrow->halves.color.size(), 36u * 36 * 4);
    EXPECT_EQ(narrow->halves.normals.size(), 36u * 36 * 4);
    EXPECT_TRUE(narrow->color.empty());
    EXPECT_TRUE(narrow->halves.velocity.empty()) << "one of its channels is a float";
    widen(*narrow);
    EXPECT_EQ(narrow->color, wide->color);
    EXPECT_EQ(narrow->normals, wide->normals);
    EXPECT_EQ(narrow->velocity, wide->velocity);
}

TEST_F(ImageExrSource, WhatIsNotFiniteIsMendedInHalvesAsInFloats) {
    constexpr int side = 8;
    std::vector<Stored> channels;
    for (const char* name : {"R", "G", "B", "A", "N.X", "N.Y", "N.Z"})
        channels.push_back({name, Imf::HALF, numbers(side, side, static_cast<unsigned>(channels.size()))});
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    channels[0].values[3] = nan;
    channels[1].values[4] = -infinity;
    channels[2].values[4] = nan;
    channels[3].values[9] = infinity;
    channels[3].values[10] = nan;
    channels[5].values[11] = nan;
    store(Imf::Header(side, side), channels);
    Result<FrameFile> narrow = read_frame(file("a.exr"), {.keeps_halves = true});
    const Result<FrameFile> wide = read_frame(file("a.exr"));
    ASSERT_TRUE(narrow && wide);
    EXPECT_EQ(narrow->counts, wide->counts);
    EXPECT_EQ(wide->counts, (PixelCounts{2, 1, 1, 1, 1}));
    EXPECT_EQ(narrow->warnings, wide->warnings);
    widen(*narrow);
    EXPECT_EQ(narrow->color, wide->color);
    EXPECT_EQ(narrow->normals, wide->normals);
}

TEST_F(ImageExrSource, PicturesCarryWhatTheirFrameSays) {
    Imf::Header header(4, 4);
    header.insert("comments", Imf::StringAttribute("take 3"));
    header.insert("darkroom:lights", Imf::IntAttribute(0));
    const std::vector<Stored> channels{{"Y", Imf::HALF, numbers(4, 4, 1)}};
    store(header, channels);
    const Result<FrameFile> frame = read_frame(file("a.exr"));
    ASSERT_TRUE(frame);
    ASSERT_TRUE(write_picture(file("b.exr"), frame->color, {.compression = "piz", .attributes = frame->attributes}));
    const Imf::InputFile written(file("b.exr").c_str());
    EXPECT_EQ(written.header().compression(), Imf::PIZ_COMPRESSION);
    ASSERT_NE(written.header().findTypedAttribute<Imf::StringAttribute>("comments"), nullptr);
    EXPECT_EQ(written.header().typedAttribute<Imf::StringAttribute>("comments").value(), "take 3");
    EXPECT_EQ(written.header().findTypedAttribute<Imf::IntAttribute>("darkroom:lights"), nullptr)
        << "the picture has no shadows";
    EXPECT_TRUE(Imf::hasChromaticities(written.header()));
    EXPECT_NE(written.header().channels().findChannel("B"), nullptr);
}

}  // namespace
}  // namespace darkroom
