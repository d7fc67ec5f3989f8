// SPDX-License-Identifier: MIT
// Layers of a frame that go into the picture's file as they are: every bit, finite or not, and what cannot go.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/layer_file.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliKeepLayers : public test::CliFixture {
  protected:
    static constexpr std::size_t width = 12, height = 8;
    inline static const std::vector<std::string> channels{"R", "G", "B", "Z", "matte00.R", "matte00.G", "note"};

    void make_files() override {
        using Limits = std::numeric_limits<float>;
        for (std::size_t i = 0; i < width * height; ++i) {
            const auto step = static_cast<float>(i);
            const float odd = i % 3 == 0 ? Limits::infinity() : i % 3 == 1 ? -1e30f : Limits::quiet_NaN();
            values.insert(values.end(), {step / 40, 0.5f, 0.25f, 1 + step, step * 1e20f, odd, 0.1f + step});
        }
        test::store_floats(path("frame.exr"), channels, width, values);
    }
    [[nodiscard]] std::vector<float> read(const std::string& file, const std::string& channel) const {
        Result<LayerFile> opened = LayerFile::open(path(file));
        EXPECT_TRUE(opened);
        const Result<FileLayer> layer = opened->find(channel);
        EXPECT_TRUE(layer) << layer.error().text;
        Result<LayerSamples> samples = layer ? opened->read(*layer) : Result<LayerSamples>(failure(layer.error()));
        return samples ? samples->values : std::vector<float>{};
    }

    std::vector<float> values;
};

TEST_F(CliKeepLayers, AreTheSameBitForBit) {
    const Outcome outcome = run({"develop", path("frame.exr"), "--no-ssao", "--keep-layers", "-o", path("out.exr")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (std::size_t c = 3; c < channels.size(); ++c) {
        const std::vector<float> kept = read("out.exr", channels[c]);
        ASSERT_EQ(kept.size(), width * height) << channels[c];
        for (std::size_t i = 0; i < kept.size(); ++i)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(kept[i]),
                      std::bit_cast<std::uint32_t>(values[i * channels.size() + c]))
                << channels[c] << " " << i;
    }
    EXPECT_NE(read("out.exr", "R"), read("frame.exr", "R")) << "the colour is the picture's";
    ASSERT_EQ(run({"develop", path("frame.exr"), "--no-ssao", "-o", path("plain.exr")}).code, 0);
    EXPECT_EQ(read("out.exr", "R"), read("plain.exr", "R"));
    EXPECT_EQ(read_frame(path("plain.exr"))->channels.size(), 3U) << "without the flag none go along";
}

/// Two parts of one size, of which only the first is the colour's.
void store_two_parts(const fs::path& path, std::span<const float> values, std::span<const float> mattes,
                     const std::vector<std::string>& names) {
    std::vector<Imf::Header> headers;
    for (const char* const name : {"beauty", "mattes"}) {
        Imf::Header& header = headers.emplace_back(12, 8);
        header.setName(name);
        header.setType(Imf::SCANLINEIMAGE);
        header.compression() = Imf::ZIP_COMPRESSION;
        const std::vector<std::string> own{"B", "G", "R"};
        for (const std::string& channel : headers.size() == 1 ? own : names)
            header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    for (int number = 0; number < 2; ++number) {
        Imf::FrameBuffer buffer;
        const std::span<const float> from = number == 0 ? values : mattes;
        std::size_t place = 0;
        for (auto channel = headers[static_cast<std::size_t>(number)].channels().begin();
             channel != headers[static_cast<std::size_t>(number)].channels().end(); ++channel, ++place)
            buffer.insert(channel.name(),
                          Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(&from[place])),
                                     3 * sizeof(float), 12 * 3 * sizeof(float)));
        Imf::OutputPart part(file, number);
        part.setFrameBuffer(buffer);
        part.writePixels(8);
    }
}

// They stand where red, green and blue do in the colour's own part.
TEST_F(CliKeepLayers, ChannelsOfAnotherPartAreNotTakenForTheColours) {
    std::vector<float> colors(width * height * 3), mattes(width * height * 3);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        colors[i] = static_cast<float>(i % 7) / 7;
        mattes[i] = static_cast<float>(i);
    }
    const std::vector<std::string> names{"head", "legs", "tail"};
    store_two_parts(path("parts.exr"), colors, mattes, names);
    const Outcome outcome =
        run({"develop", path("parts.exr"), "--keep-layers", "--bits", "float", "-o", path("out.exr")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (std::size_t c = 0; c < names.size(); ++c) {
        const std::vector<float> kept = read("out.exr", "mattes." + names[c]);
        ASSERT_EQ(kept.size(), width * height) << names[c];
        for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i], mattes[i * 3 + c]) << names[c] << " " << i;
    }
}

TEST_F(CliKeepLayers, HalvesStayHalvesAndShadowsStayBehind) {
    write("sun.scene.toml",
          "[entities.sun.light]\ndirection = [1, 1, 0]\n[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] "
          "}\n");
    ASSERT_EQ(run({"render", path("sun.scene.toml"), "--size", "24x16", "--shadow-resolution", "16", "--save-frame",
                   path("sun.exr"), "-o", path("sun.png")})
                  .code,
              0);
    const Outcome outcome =
        run({"develop", path("sun.exr"), "--keep-layers", "--bits", "float", "-o", path("out.exr")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const Outcome same =
        run({"compare", path("sun.exr"), path("out.exr"), "--layers", "depth,normals,velocity", "--fail-max", "0"});
    EXPECT_EQ(same.code, 0) << same.err << same.out;
    Result<LayerFile> file = LayerFile::open(path("out.exr"));
    ASSERT_TRUE(file);
    ASSERT_EQ(file->decoder().parts().size(), 1U);
    const FilePart& part = file->decoder().parts().front();
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
        EXPECT_EQ(part.channels[c].find("cascade"), std::string::npos);
        const bool is_normal = part.channels[c].find("N.") != std::string::npos;
        EXPECT_EQ(part.kinds[c], is_normal ? SampleKind::Half : SampleKind::Float) << part.channels[c];
    }
}

// ACEScg: the picture is of Rec. 709, and what is kept beside it keeps its numbers.
TEST_F(CliKeepLayers, PrimariesThatAreNotThePicturesAreTold) {
    const auto store = [&](const std::string& layer, const Imf::Chromaticities& primaries) {
        test::store_floats(path("ap1.exr"), {"R", "G", "B", layer}, width, std::vector<float>(width * height * 4, 0.5f),
                           [&](Imf::Header& header) { Imf::addChromaticities(header, primaries); });
        return run({"develop", path("ap1.exr"), "--keep-layers", "-o", path("out.exr")});
    };
    const Imf::Chromaticities ap1({0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
    const Outcome told = store("diffuse.R", ap1);
    EXPECT_EQ(told.code, 0);
    EXPECT_NE(told.err.find("kept layers in color have the frame's primaries, and the file says the picture's"),
              std::string::npos)
        << told.err;
    EXPECT_EQ(store("id", ap1).err, "") << "no colour";
    EXPECT_EQ(store("diffuse.R", Imf::Chromaticities()).err, "") << "the picture's own";
}

TEST_F(CliKeepLayers, WhereThereIsNoPlaceTheyAreRefused) {
    const std::string frame = path("frame.exr");
    expect_refused({"develop", frame, "--keep-layers", "-o", path("a.png")}, 1, "a.png holds no layers; .exr does");
    expect_refused({"develop", frame, "--keep-layers", "-o", "-", "--format", "y4m"}, 1, "a stream holds no layers");
    expect_refused({"develop", frame, "--no-ssao", "--keep-layers", "--size", "6x4", "-o", path("a.exr")}, 1,
                   "the layers of the frame are 12x8, the picture 6x4");
    // A layer cannot have the name of the picture's own channels.
    test::store_floats(path("two.exr"), {"Combined.R", "Combined.G", "Combined.B", "R"}, width,
                       std::vector<float>(width * height * 4, 0.5f));
    const Outcome mapped =
        run({"develop", path("two.exr"), "--map", "color=Combined", "--keep-layers", "-o", path("b.exr")});
    EXPECT_EQ(mapped.code, 0) << mapped.err;
    EXPECT_NE(mapped.err.find("R is not kept: the picture has a channel of this name"), std::string::npos)
        << mapped.err;
}

}  // namespace
}  // namespace darkroom
