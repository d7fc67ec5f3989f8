// SPDX-License-Identifier: MIT
// What frames of other programs mean: names, parts and eyes that come back, the colour among several, whose world the
// normals are of, and frames that are missing. Files are written here by OpenEXR's own writer, numbers are closed
// forms.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/layer_file.hpp"
#include "image/test_files.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

/// Samples of a channel over its part's data window, or over 24x16 pixels.
using Samples = std::vector<float>;

struct Part {
    std::string name, view;
    std::map<std::string, Samples> channels;
    Imath::Box2i window{{0, 0}, {23, 15}};
    std::map<std::string, std::string> texts;  // attributes
};

constexpr int frame_width = 24, frame_height = 16;

Samples ramp(float first, float step) {
    Samples out(std::size_t{frame_width} * frame_height);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = first + step * static_cast<float>(i % 97);
    return out;
}
Samples all(float value) { return Samples(std::size_t{frame_width} * frame_height, value); }

void store(const std::string& path, std::vector<Part> parts, const std::vector<std::string>& halves = {},
           const std::vector<std::string>& views = {}) {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) {
        Imf::Header& header = headers.emplace_back(frame_width, frame_height);
        header.dataWindow() = part.window;
        if (!part.view.empty()) header.setView(part.view);
        if (!part.name.empty()) header.setName(part.name);
        header.setType(Imf::SCANLINEIMAGE);
        for (const auto& [name, text] : part.texts) header.insert(name, Imf::StringAttribute(text));
        if (!views.empty()) Imf::addMultiView(header, views);
        for (const auto& [name, samples] : part.channels)
            header.channels().insert(name, Imf::Channel(std::ranges::count(halves, name) > 0 ? Imf::HALF : Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Imf::FrameBuffer buffer;
        const Imath::Box2i& window = parts[i].window;
        const int columns = window.max.x - window.min.x + 1, rows = window.max.y - window.min.y + 1;
        std::vector<std::vector<Imath::half>> packed;
        packed.reserve(parts[i].channels.size());
        for (auto& [name, samples] : parts[i].channels) {
            if (std::ranges::count(halves, name) > 0) {
                packed.emplace_back(samples.begin(), samples.end());
                buffer.insert(name, Imf::Slice::Make(Imf::HALF, packed.back().data(), window.min, columns, rows));
            } else {
                buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, samples.data(), window.min, columns, rows));
            }
        }
        Imf::OutputPart output(file, static_cast<int>(i));
        output.setFrameBuffer(buffer);
        output.writePixels(rows);
    }
}

/// By OpenEXR alone.
std::vector<Part> load(const std::string& path) {
    std::vector<Part> out;
    Imf::MultiPartInputFile file(path.c_str());
    for (int i = 0; i < file.parts(); ++i) {
        Imf::InputPart input(file, i);
        const Imf::Header& header = input.header();
        Part& part = out.emplace_back(Part{.name = header.hasName() ? header.name() : "",
                                           .view = header.hasView() ? header.view() : "",
                                           .window = header.dataWindow()});
        const int columns = part.window.max.x - part.window.min.x + 1, rows = part.window.max.y - part.window.min.y + 1;
        Imf::FrameBuffer buffer;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
            Samples& samples = part.channels[channel.name()];
            samples.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
            buffer.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, samples.data(), part.window.min, columns, rows));
        }
        for (auto found = header.begin(); found != header.end(); ++found)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&found.attribute()))
                part.texts[found.name()] = text->value();
        input.setFrameBuffer(buffer);
        input.readPixels(part.window.min.y, part.window.max.y);
    }
    return out;
}

class CliFrameMeaning : public test::CliFixture {
  protected:
    void make_files() override {
        write("plain.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n");
        write("trail.toml", "format = 1\n[[stack]]\neffect = \"recursive_blend\"\n");
    }
    /// With a stack that changes nothing.
    [[nodiscard]] Outcome develop(const std::string& frame, const std::string& out,
                                  std::vector<std::string> flags = {}) const {
        flags.insert(flags.begin(), {"develop", path(frame), "--look", path("plain.toml"), "-o", path(out), "-q"});
        return run(flags);
    }
    /// Of the colour, at the first pixel.
    [[nodiscard]] float red(const std::string& frame, std::vector<std::string> flags = {}) const {
        flags.insert(flags.end(), {"--bits", "float"});
        const Outcome outcome = develop(frame, "red.exr", flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.code == 0 ? load(path("red.exr")).front().channels["R"].front() : -1;
    }
    static std::map<std::string, Samples> rgb(float value, const std::string& prefix = "") {
        return {{prefix + "R", all(value)}, {prefix + "G", all(value)}, {prefix + "B", all(value)}};
    }
};

TEST_F(CliFrameMeaning, PartsComeBackWithTheirNamesAndAttributes) {
    const Part color{.name = "rgba", .channels = rgb(0.5f)};
    const Part depth{.name = "depth", .channels = {{"depth.Z", ramp(1, 0.5f)}}, .texts = {{"comment", "of depth"}}};
    const Part matte{.name = "uCryptoAsset00",
                     .channels = {{"uCryptoAsset00.R", ramp(1e20f, 3e20f)}, {"uCryptoAsset00.G", ramp(0, 0.01f)}},
                     .texts = {{"cryptomatte/ae5b1f3/name", "uCryptoAsset"}, {"cryptomatte/ae5b1f3/manifest", "{}"}}};
    const Part cut{.name = "cut", .channels = {{"R", Samples(12, 7)}}, .window = {{-2, 3}, {1, 5}}};
    store(path("in.exr"), {depth, color, matte, cut});
    ASSERT_EQ(develop("in.exr", "out.exr", {"--keep-layers"}).code, 0);
    std::vector<Part> out = load(path("out.exr"));
    ASSERT_EQ(out.size(), 4U);
    EXPECT_EQ(out[1].name, "rgba") << "the picture stands where the colour did";
    for (const auto& [i, part] : {std::pair(0, &depth), std::pair(2, &matte), std::pair(3, &cut)}) {
        Part& back = out[static_cast<std::size_t>(i)];
        EXPECT_EQ(back.name, part->name);
        EXPECT_EQ(back.window, part->window);
        EXPECT_EQ(back.channels, part->channels) << part->name;
        for (const auto& [name, text] : part->texts) EXPECT_EQ(back.texts[name], text);
    }
    ASSERT_EQ(develop("out.exr", "again.exr", {"--keep-layers"}).code, 0);
    EXPECT_EQ(load(path("again.exr"))[2].channels, matte.channels);
}

// ACEScg to Rec. 709 by the matrix that the Academy publishes: 0.8 0.2 0.1 is 1.23136 0.12290 0.07030.
TEST_F(CliFrameMeaning, ColorInteropIdSaysTheSpaceAndGoesBeforeChromaticities) {
    const auto light = [&](const std::map<std::string, std::string>& texts) {
        store(path("in.exr"), {{.channels = {{"R", all(0.8F)}, {"G", all(0.2F)}, {"B", all(0.1F)}}, .texts = texts}});
        const Result<FrameFile> frame = read_frame(path("in.exr"));
        EXPECT_TRUE(frame);
        const float* const pixel = frame->color.at(3, 3);
        return std::pair(std::array{pixel[0], pixel[1], pixel[2]}, frame->warnings);
    };
    const auto near = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
        return std::ranges::equal(a, b, [](float x, float y) { return std::abs(x - y) < 1e-4F; });
    };
    for (const char* const id : {"lin_ap1_scene", "studio:lin_ap1_scene"}) {
        const auto [pixel, warnings] = light({{"colorInteropID", id}});
        EXPECT_TRUE(near(pixel, {1.23136F, 0.12290F, 0.07030F})) << fmt::format("{}", fmt::join(pixel, " "));
        EXPECT_TRUE(warnings.empty()) << warnings.front();
    }
    // IEC 61966-2-1 at 0.8, 0.2 and 0.1.
    EXPECT_TRUE(near(light({{"colorInteropID", "srgb_rec709_scene"}}).first, {0.603827F, 0.033105F, 0.010023F}));
    for (const auto& [id, word] : {std::pair("data", "is data"), std::pair("lin_mine_scene", "lin_mine_scene")}) {
        const auto [pixel, warnings] = light({{"colorInteropID", id}});
        EXPECT_TRUE(near(pixel, {0.8F, 0.2F, 0.1F})) << id;
        ASSERT_EQ(warnings.size(), 1U) << id;
        EXPECT_NE(warnings.front().find(word), std::string::npos) << warnings.front();
    }
    EXPECT_TRUE(light({{"colorInteropID", "unknown"}}).second.empty());
    const Outcome info = run({"info", path("in.exr"), "--json"});
    EXPECT_NE(info.out.find("says nothing that is known"), std::string::npos) << info.out;
}

// By OpenImageIO 3.2: colorconvert(unpremult=True).
TEST_F(CliFrameMeaning, CurvesAreOfStraightColor) {
    store(path("in.exr"), {{.channels = {{"R", all(0.25F)}, {"G", all(0.1F)}, {"B", all(0.4F)}, {"A", all(0.5F)}},
                            .texts = {{"colorInteropID", "srgb_rec709_scene"}}}});
    const Result<FrameFile> frame = read_frame(path("in.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    ASSERT_TRUE(frame->is_associated);
    const float* const pixel = frame->color.at(1, 1);
    EXPECT_NEAR(pixel[0], 0.10702, 1e-5);
    EXPECT_NEAR(pixel[1], 0.01655, 1e-5);
    EXPECT_NEAR(pixel[2], 0.30192, 1e-5);
}

// The frame's projection is not that of a part of it.
TEST_F(CliFrameMeaning, APartOfAFrameSaysNoProjection) {
    FrameFile made;
    made.color = Picture(32, 16);
    made.camera.projection = Matrix{1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0};
    ASSERT_TRUE(write_frame(path("in.exr"), made));
    for (const auto& [size, is_kept] : {std::pair("16x8", true), {"16x16:stretch", true}, {"16x16:fill", false}}) {
        ASSERT_EQ(develop("in.exr", "out.exr", {"--size", size}).code, 0);
        const Result<FrameFile> out = read_frame(path("out.exr"));
        ASSERT_TRUE(out) << out.error().text;
        EXPECT_EQ(out->camera.projection.has_value(), is_kept) << size;
    }
    EXPECT_NE(develop("in.exr", "out.exr", {"--overscan", "--size", "16x8"}).err.find("works without --size"),
              std::string::npos);
}

TEST_F(CliFrameMeaning, TristimulusValuesThatSayTheirPrimariesAreAPicture) {
    // White of D65, by CIE 15.
    store(path("in.exr"), {{.channels = {{"X", all(0.95047F)}, {"Y", all(1)}, {"Z", all(1.08883F)}},
                            .texts = {{"colorInteropID", "lin_ciexyzd65_scene"}}}});
    const Result<FrameFile> frame = read_frame(path("in.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(frame->color.at(1, 1)[c], 1, 2e-3) << c;
    store(path("points.exr"), {{.channels = {{"X", all(1)}, {"Y", all(1)}, {"Z", all(1)}}}});
    EXPECT_FALSE(read_frame(path("points.exr"))) << "they may be places";
}

TEST_F(CliFrameMeaning, LayersOfAnotherViewLayerAreLeftOutAndNamed) {
    std::map<std::string, Samples> channels = rgb(0.5F, "bg.Combined.");
    channels.merge(rgb(0.25F, "fg.Albedo."));
    channels["bg.Depth.Z"] = all(4);
    for (const char* const axis : {"X", "Y", "Z"}) channels[fmt::format("fg.Normal.{}", axis)] = all(0.5F);
    store(path("in.exr"), {{.channels = channels}});
    const Result<FrameFile> frame = read_frame(path("in.exr"));
    ASSERT_TRUE(frame && frame->depth);
    EXPECT_FALSE(frame->normals);
    const std::string warnings = fmt::format("{}", fmt::join(frame->warnings, " / "));
    EXPECT_NE(warnings.find("normals fg.Normal are of another view layer than the color bg.Combined"),
              std::string::npos)
        << warnings;
    EXPECT_TRUE(read_frame(path("in.exr"), {.names = {{"normals", "fg.Normal"}}, .normals_space = NormalsSpace::View})
                    ->normals);
}

TEST_F(CliFrameMeaning, TheLengthOfARayIsMadeDepthWhereTheCameraIsKnown) {
    // A plane at 5 across the axis, seen by 60 degrees from Mitsuba's near clip on: closed form, pixel by pixel; behind
    // its last row is nothing.
    const double slope = std::tan(std::numbers::pi / 6);
    const auto rays = [&](double near, double opening) {
        Samples out = all(0);
        for (int y = 0; y + 1 < frame_height; ++y)
            for (int x = 0; x < frame_width; ++x) {
                const double up = (1 - (y + 0.5) / (frame_height / 2.0)) * opening;
                const double right = ((x + 0.5) / (frame_width / 2.0) - 1) * opening * frame_width / frame_height;
                out[static_cast<std::size_t>(y * frame_width + x)] =
                    static_cast<float>((5 - near) * std::sqrt(1 + right * right + up * up));
            }
        return out;
    };
    const auto expect_plane = [&](const FrameOptions& options, const std::string& what) {
        const Result<FrameFile> frame = read_frame(path("in.exr"), options);
        ASSERT_TRUE(frame && frame->depth) << what;
        const std::size_t seen = std::size_t{frame_width} * (frame_height - 1);
        for (std::size_t i = 0; i < seen; ++i) ASSERT_NEAR(frame->depth->values[i], 5, 1e-5) << what << ' ' << i;
        EXPECT_EQ(frame->depth->values[seen], sky_depth) << what;
    };
    for (const std::string layer : {"depth", "dd.y"}) {
        std::map<std::string, Samples> channels = rgb(0.5F);
        channels[layer + ".T"] = rays(0.01, slope);
        store(path("in.exr"), {{.channels = channels}});
        const Result<FrameFile> blind = read_frame(path("in.exr"));
        ASSERT_TRUE(blind);
        EXPECT_FALSE(blind->depth);
        EXPECT_NE(fmt::format("{}", fmt::join(blind->warnings, " ")).find(layer + ".T is the length of a ray"),
                  std::string::npos);
        expect_plane({.vertical_field_of_view = 60}, layer);
        for (const std::string& name : {layer, layer + ".T"})
            expect_plane({.names = {{"depth", name}}, .vertical_field_of_view = 60}, "mapped " + name);
    }
    // The near clip is what the projection says: 0.5, by depth 0 and, where it is reversed, by 1.
    std::map<std::string, Samples> channels = rgb(0.5F);
    channels["dd.y.T"] = rays(0.5, slope);
    store(path("in.exr"), {{.channels = channels}});
    const double wide = frame_height / slope / frame_width, high = -1 / slope;
    const auto matrix = [&](double x, double y, const std::string& others) {
        return fmt::format("projection = [{}, 0, 0, 0,  0, {}, 0, 0,  {}]\n", x, y, others);
    };
    write(path("camera.toml"), matrix(wide, high, "0, 0, -2, -1,  0, 0, -1, 0"));  // far at 1
    expect_plane({.camera_file = path("camera.toml")}, "near 0.5");
    write(path("camera.toml"), matrix(wide, high, "0, 0, 0, 0.5,  0, 0, -1, 0"));
    expect_plane({.camera_file = path("camera.toml")}, "near 0.5, reversed");
    // Rays of a parallel camera are as long as they are deep.
    channels["dd.y.T"] = rays(0.5, 0);
    store(path("in.exr"), {{.channels = channels}});
    write(path("camera.toml"), matrix(0.5, -0.5, "0, 0, -0.01, -0.005,  0, 0, 0, 1"));
    expect_plane({.camera_file = path("camera.toml")}, "parallel");
}

TEST_F(CliFrameMeaning, BlendersDenoisingDepthIsLeftOut) {
    std::map<std::string, Samples> channels = rgb(0.5F);
    channels["ViewLayer.Denoising Depth.Z"] = all(5);
    store(path("in.exr"), {{.channels = channels}});
    const Result<FrameFile> denoising = read_frame(path("in.exr"));
    ASSERT_TRUE(denoising);
    EXPECT_FALSE(denoising->depth);
    EXPECT_NE(fmt::format("{}", fmt::join(denoising->warnings, " ")).find("Denoising Depth"), std::string::npos);
}

TEST_F(CliFrameMeaning, BlendersMotionOfThreeNumbersGoesUpToo) {
    for (const bool has_fourth : {false, true}) {
        std::map<std::string, Samples> channels = rgb(0.5F);
        channels["Vector.X"] = all(3);
        channels["Vector.Y"] = all(2);
        channels["Vector.Z"] = all(-3);
        if (has_fourth) channels["Vector.W"] = all(-2);
        store(path("in.exr"), {{.channels = channels}});
        const Result<FrameFile> frame = read_frame(path("in.exr"), {.names = {{"velocity", "Vector"}}});
        ASSERT_TRUE(frame && frame->velocity);
        EXPECT_EQ(frame->velocity->values[0], 3);
        EXPECT_EQ(frame->velocity->values[1], -2) << has_fourth;
    }
}

TEST_F(CliFrameMeaning, APackingThatIsNewerThanTheLibraryIsNamed) {
    store(path("in.exr"), {{.channels = rgb(0.5F)}});
    const std::string whole = content(path("in.exr"));
    constexpr std::string_view attribute("compression\0compression\0\1\0\0\0", 28);
    const std::size_t at = whole.find(attribute);
    ASSERT_NE(at, std::string::npos);
    for (const auto& [number, word] :
         {std::pair(12, "LJ2K, which OpenEXR 3.5 brought"), std::pair(13, "ZSTD, which OpenEXR 3.5 brought"),
          std::pair(14, "compression 14")}) {
        std::string changed = whole;
        changed[at + attribute.size()] = static_cast<char>(number);
        write("in.exr", changed);
        const Result<FrameFile> frame = read_frame(path("in.exr"));
        ASSERT_FALSE(frame);
        EXPECT_NE(frame.error().text.find(word), std::string::npos) << frame.error().text;
    }
}

TEST_F(CliFrameMeaning, APictureSaysItsOwnSpaceAndNothingThatItsFrameClaimed) {
    const std::map<std::string, std::string> texts{{"colorInteropID", "lin_ap1_scene"},
                                                   {"ColorSpace", "ACES - ACEScg"},
                                                   {"cryptomatte/ae5b1f3/name", "object"},
                                                   {"madeOf", "clay"},
                                                   {"owner", "the studio"},
                                                   {"Scene", "street"}};
    store(path("in.exr"), {{.name = "main", .channels = rgb(0.5F), .texts = texts},
                           {.name = "albedo", .channels = rgb(0.25F, "albedo."), .texts = texts}});
    const Outcome alone = develop("in.exr", "out.exr");
    ASSERT_EQ(alone.code, 0) << alone.err;
    const auto kept = [&](std::size_t part) {
        std::map<std::string, std::string> out = load(path("out.exr")).at(part).texts;
        std::erase_if(out, [&](const auto& text) { return !texts.contains(text.first); });
        return out;
    };
    const std::map<std::string, std::string> of_a_picture{
        {"colorInteropID", "lin_rec709_scene"}, {"owner", "the studio"}, {"Scene", "street"}};
    EXPECT_EQ(kept(0), of_a_picture);
    EXPECT_NE(run({"develop", path("in.exr"), "--look", path("plain.toml"), "-o", path("out.exr")}).err.find("madeOf"),
              std::string::npos);
    ASSERT_EQ(develop("in.exr", "out.exr", {"--keep-layers"}).code, 0);
    EXPECT_EQ(kept(0), of_a_picture);
    EXPECT_EQ(kept(1), texts) << "its colours are what they were";
    for (const auto& [space, id] : {std::pair("p3", "lin_p3d65_scene"), std::pair("rec2020", "lin_rec2020_scene")}) {
        ASSERT_EQ(develop("in.exr", "out.exr", {"--output-space", space}).code, 0);
        EXPECT_EQ(kept(0)["colorInteropID"], id);
    }
}

TEST_F(CliFrameMeaning, KeptLayersStayAsTheyAreUnderEveryCompression) {
    std::map<std::string, Samples> channels = rgb(0.5f);
    for (const char* const name : {"Z", "N.X", "N.Y", "N.Z", "velocity.X", "velocity.Y", "DiffCol.R", "DiffCol.G",
                                   "DiffCol.B", "matte.R", "matte.G", "matte.Y"})
        channels[name] = ramp(0.1f * static_cast<float>(channels.size()), 0.123f);
    channels["matte.R"] = ramp(1e30f, 1e28f);
    const std::vector<std::string> halves{"DiffCol.R", "DiffCol.G", "DiffCol.B"};
    store(path("in.exr"), {{.channels = channels}}, halves);
    const std::map<std::string, Samples> before = load(path("in.exr")).front().channels;
    for (const char* const compression :
         {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
        ASSERT_EQ(develop("in.exr", "out.exr", {"--keep-layers", "--compression", compression}).code, 0);
        std::map<std::string, Samples> after;
        for (const Part& part : load(path("out.exr"))) after.insert(part.channels.begin(), part.channels.end());
        for (const auto& [name, samples] : before)
            if (name.size() > 1 || name == "Z") {
                EXPECT_EQ(after[name], samples) << compression << " " << name;
            }
        const Result<FrameFile> frame = read_frame(path("out.exr"));
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_TRUE(frame->depth && frame->velocity) << compression << ": they are still found";
    }
}

TEST_F(CliFrameMeaning, EachEyeStaysUnderItsName) {
    std::map<std::string, Samples> channels = rgb(0.25f);
    channels.merge(rgb(0.75f, "right."));
    channels["Z"] = all(3);
    channels["right.Z"] = all(7);
    store(path("channels.exr"), {{.channels = channels}}, {}, {"left", "right"});
    store(path("parts.exr"), {{.name = "rgba_left", .view = "left", .channels = rgb(0.25f)},
                              {.name = "rgba_right", .view = "right", .channels = rgb(0.75f)},
                              {.name = "depth_right", .view = "right", .channels = {{"Z", all(7)}}}});
    for (const char* const file : {"channels.exr", "parts.exr"}) {
        const std::string in = file;
        EXPECT_EQ(read_frame(path(in))->warnings,
                  (std::vector<std::string>{"has the views left, right: left is developed, --eye says which"}))
            << "one thing is said once";
        ASSERT_EQ(develop(in, "out.exr", {"--eye", "right", "--keep-layers", "--exposure", "2"}).code, 0);
        const Result<FrameFile> left = read_frame(path("out.exr"), {.view = "left"});
        const Result<FrameFile> right = read_frame(path("out.exr"), {.view = "right"});
        ASSERT_TRUE(left && right) << in;
        EXPECT_EQ(left->color.pixels[0], 0.25f) << in << ": is as it was";
        EXPECT_NE(right->color.pixels[0], 0.25f) << in;
        EXPECT_EQ(right->depth->values[0], 7) << in;
        if (in == "channels.exr") {
            EXPECT_EQ(left->depth->values[0], 3);
        }
        const std::vector<Part> parts = load(path("out.exr")), before = load(path(file));
        ASSERT_EQ(parts.size(), before.size());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            EXPECT_EQ(parts[i].view, before[i].view);
            for (const auto& [name, samples] : before[i].channels)
                EXPECT_TRUE(parts[i].channels.contains(name)) << name;
            EXPECT_EQ(parts[i].channels.size(), before[i].channels.size());
        }
    }
}

TEST_F(CliFrameMeaning, TheColourIsTheFirstOfAStatedOrder) {
    // Each goes before those behind it, whatever the order in the file; OpenEXR sorts channels by name.
    const std::vector<std::string> order{
        "Composite.Combined", "ViewLayer.Combined", "RGBA", "rgb", "C", "beauty", "default"};
    for (std::size_t first = 0; first < order.size(); ++first) {
        std::map<std::string, Samples> channels = rgb(100, "BG");
        channels.merge(rgb(100, "AO."));
        for (std::size_t i = first; i < order.size(); ++i) channels.merge(rgb(static_cast<float>(i), order[i] + "."));
        store(path("one.exr"), {{.channels = channels}});
        EXPECT_EQ(red("one.exr"), static_cast<float>(first)) << order[first];
    }
    store(path("layers.exr"), {{.channels = [] {
              std::map<std::string, Samples> out = rgb(1, "BG.Combined.");
              out.merge(rgb(2, "ViewLayer.Combined."));
              return out;
          }()}});
    const Outcome two = develop("layers.exr", "two.exr");
    EXPECT_NE(two.err.find("the color is BG.Combined, although ViewLayer.Combined might be it as well"),
              std::string::npos)
        << two.err;
    EXPECT_EQ(red("layers.exr", {"--map", "color=ViewLayer.Combined"}), 2);
    store(path("crypto.exr"), {{.name = "N", .channels = rgb(9)},
                               {.name = "uCrypto00", .channels = rgb(8, "uCrypto00.")},
                               {.name = "albedo", .channels = rgb(7, "albedo.")}});
    EXPECT_EQ(red("crypto.exr"), 9) << "a part of plain channels goes before layers";
}

TEST_F(CliFrameMeaning, NamesInFullAreColoursAndMapTakesWhatInfoPrints) {
    store(path("long.exr"), {{.name = "depth_main", .channels = {{"Z", all(4)}}},
                             {.name = "main", .channels = {{"red", all(1)}, {"green", all(2)}, {"blue", all(3)}}},
                             {.name = "main2", .channels = {{"n.X", all(0)}, {"n.Y", all(1)}, {"n.Z", all(0)}}}});
    const Result<FrameFile> frame = read_frame(path("long.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(std::vector(frame->color.pixels.begin(), frame->color.pixels.begin() + 4),
              (std::vector<float>{1, 2, 3, 1}));
    ASSERT_EQ(red("long.exr", {"--map", "color=main"}), 1);
    EXPECT_EQ(load(path("red.exr")).front().channels["B"].front(), 3);
    ASSERT_EQ(red("long.exr", {"--map", "color=red"}), 1);
    EXPECT_EQ(load(path("red.exr")).front().channels["B"].front(), 3);
    const Outcome told = run({"info", path("long.exr"), "--json"});
    ASSERT_EQ(told.code, 0) << told.err;
    const nlohmann::json found = nlohmann::json::parse(told.out);
    for (const auto& layer : found.at("layers")) {
        const std::string name = layer.at("layer");
        const std::string what = name == "color" || name == "depth" || name == "normals" ? name : "normals";
        EXPECT_EQ(develop("long.exr", "mapped.exr", {"--map", what + "=" + name}).code, 0) << name;
        if (what != "normals") continue;
        for (const auto& channel : layer.at("channels"))
            EXPECT_EQ(develop("long.exr", "mapped.exr", {"--map", "normals=" + channel.get<std::string>()}).code, 0)
                << channel;
    }
    const Outcome wrong = develop("long.exr", "x.exr", {"--map", "normals=mian"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.err.find("did you mean 'main'?"), std::string::npos) << wrong.err;
}

TEST_F(CliFrameMeaning, DepthOutsideOfItsWindowIsSkyAndDepthOfNothingIsTold) {
    std::map<std::string, Samples> channels;
    for (const char* const name : {"R", "G", "B", "Z", "other.Z"}) channels[name] = Samples(12, 2);
    store(path("in.exr"), {{.channels = channels, .window = {{4, 4}, {7, 6}}}});
    ASSERT_EQ(develop("in.exr", "out.exr", {"--keep-layers"}).code, 0);
    std::vector<Part> out = load(path("out.exr"));
    EXPECT_EQ(out[0].channels["Z"].front(), sky_depth);
    EXPECT_EQ(out[0].channels["other.Z"].front(), sky_depth);
    EXPECT_EQ(out[0].channels["Z"][4 * frame_width + 4], 2);
    EXPECT_EQ(read_frame(path("out.exr"))->depth->values, read_frame(path("in.exr"))->depth->values);
    std::map<std::string, Samples> zeros = rgb(0.5f);
    zeros["Z"] = all(5);
    std::fill_n(zeros["Z"].begin(), frame_width * frame_height / 4, 0.0f);
    store(path("zeros.exr"), {{.channels = zeros}});
    const Result<FrameFile> frame = read_frame(path("zeros.exr"));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->warnings.size(), 1U);
    EXPECT_NE(frame->warnings[0].find("depth is 0 in 25 % of the pixels"), std::string::npos) << frame->warnings[0];
}

TEST_F(CliFrameMeaning, FramesThatAreMissingAreNoStepOfAHistory) {
    for (const auto& [number, value] :
         {std::pair(0, 0.05f), std::pair(1, 0.05f), std::pair(2, 0.05f), std::pair(26, 0.8f)})
        store(path(fmt::format("b.{:04}.exr", number)), {{.channels = rgb(value)}});
    const auto trail = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"develop", path("b.####.exr"), "--look", path("trail.toml"), "--fps", "24", "-q"});
        return run(flags);
    };
    ASSERT_EQ(trail({"--bits", "float", "-o", path("o.####.exr")}).code, 0);
    EXPECT_NEAR(load(path("o.0026.exr")).front().channels["R"].front(), 0.8f, 1e-6f) << "of the past nothing is left";
    for (const int number : {10, 12, 14})
        store(path(fmt::format("two.{:04}.exr", number)), {{.channels = rgb(number == 14 ? 0.8f : 0.05f)}});
    ASSERT_EQ(run({"develop", path("two.####.exr"), "--look", path("trail.toml"), "--fps", "24", "-q", "--bits",
                   "float", "-o", path("t.####.exr")})
                  .code,
              0);
    EXPECT_LT(load(path("t.0014.exr")).front().channels["R"].front(), 0.79f) << "on twos a step is two frames";

    const std::size_t one = std::size_t{3} * frame_width * frame_height;
    const Outcome held = trail({"--format", "rgb24", "-o", "-"});
    EXPECT_EQ(held.code, 0) << held.err;
    EXPECT_EQ(held.out.size(), 27 * one);
    EXPECT_EQ(held.out.substr(2 * one, one), held.out.substr(25 * one, one)) << "the one before is held";
    EXPECT_NE(held.err.find("23 frames are missing before"), std::string::npos) << held.err;
    const Outcome stopped = trail({"--format", "rgb24", "-o", "-", "--gaps", "stop"});
    EXPECT_EQ(stopped.code, 1);
    EXPECT_EQ(stopped.out, "");
    EXPECT_NE(stopped.err.find("--gaps stop: 23 frames are missing before"), std::string::npos) << stopped.err;
    EXPECT_EQ(trail({"--format", "rgb24", "-o", "-", "--frames", "0,26"}).out.size(), 2 * one)
        << "nobody asked for those between";
}

TEST_F(CliFrameMeaning, ASunThatDwaCannotHoldIsClampedAndCounted) {
    Samples sun(std::size_t{64} * 64 * 3);
    for (std::size_t i = 0; i < sun.size(); ++i) sun[i] = 0.2f + 0.001f * static_cast<float>(i / 3 % 64);
    for (std::size_t y = 20; y < 28; ++y)
        for (std::size_t x = 20; x < 28; ++x)
            std::fill_n(&sun[(y * 64 + x) * 3], 3, y == 24 && x == 24 ? 1e6f : 65504.0f);
    test::store_floats(path("sun.exr"), {"B", "G", "R"}, 64, sun);
    for (const char* const bits : {"half", "float"}) {
        const Outcome outcome = develop("sun.exr", "out.exr", {"--compression", "dwaa", "--bits", bits});
        ASSERT_EQ(outcome.code, 0);
        EXPECT_NE(outcome.err.find("64 pixels are brighter than dwaa can hold"), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find("--bits float") != std::string::npos, std::string(bits) == "float") << outcome.err;
        std::map<std::string, Samples> channels = load(path("out.exr")).front().channels;
        for (const auto& [name, samples] : channels)
            for (const float value : samples) ASSERT_TRUE(std::isfinite(value)) << bits;
        EXPECT_GT(channels["R"][24 * 64 + 24], 50000);
    }
    EXPECT_EQ(develop("sun.exr", "out.exr", {"--compression", "piz"}).err, "");
}

class CliFrameMeaningOfNormals : public CliFrameMeaning {
  protected:
    /// A plane 5 metres ahead that leans back by `angle`, seen at 45 degrees; its normals turned by `signs`.
    void store_plane(const std::string& name, double angle, const std::array<float, 3>& signs) const {
        constexpr int side = 64;
        const double tangent = std::tan(45 * 3.14159265358979 / 360);
        Samples values;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const double up = -((y + 0.5) / side * 2 - 1) * tangent;
                // n = (0, sin, cos), n * (p - (0, 0, -5)) = 0 on the ray (.., up, -1) * depth
                const double depth = 5 * std::cos(angle) / (std::cos(angle) - up * std::sin(angle));
                for (const double value : {0.5, 0.5, 0.5, 0.0, std::sin(angle), std::cos(angle), depth})
                    values.push_back(static_cast<float>(value));
                for (std::size_t i = 0; i < 3; ++i) values[values.size() - 4 + i] *= signs[i];
            }
        test::store_floats(path(name), {"R", "G", "B", "N.X", "N.Y", "N.Z", "Z"}, side, values);
    }
};

TEST_F(CliFrameMeaningOfNormals, WithoutACameraTheyAreKeptWhereTheDepthSaysWhatTheyAre) {
    const double angle = 0.5;
    for (const std::array<float, 3> signs : {std::array<float, 3>{1, 1, 1}, {1, -1, -1}, {1, 1, -1}}) {
        store_plane("plane.exr", angle, signs);
        const Result<FrameFile> frame = read_frame(path("plane.exr"));
        ASSERT_TRUE(frame && frame->normals) << frame->warnings[0];
        const float* const normal = frame->normals->at(30, 30);
        EXPECT_NEAR(normal[1], std::sin(angle), 1e-6);
        EXPECT_NEAR(normal[2], std::cos(angle), 1e-6);
        EXPECT_NE(frame->warnings.at(0).find("normals are taken as those of the camera"), std::string::npos);
    }
    // z up: the floor's normal is (0, 0, 1), and here it would lean.
    store_plane("world.exr", angle, {1, 1, 1});
    const Result<FrameFile> told = read_frame(path("world.exr"), {.normals_space = NormalsSpace::World});
    ASSERT_TRUE(told);
    EXPECT_FALSE(told->normals) << "of a world that nobody placed";
    const Outcome none = develop("world.exr", "out.png", {"--map", "normals=none", "--fov", "45"});
    EXPECT_EQ(none.code, 0);
    EXPECT_EQ(none.err, "");
    const auto said = [&](const std::string& flag, const std::string& value) {
        return develop("world.exr", "out.png", {flag, value, "--fov", "45"}).err;
    };
    EXPECT_EQ(said("--normals-space", "view"), "") << "nothing is left to be measured";
    EXPECT_NE(said("--normals-space", "eye").find("--normals-space eye: allowed is world, view"), std::string::npos);
    EXPECT_NE(said("--up", "x").find("--up x: allowed is y, z"), std::string::npos);
    EXPECT_EQ(said("--up", "z"), said("--up", "y")) << "without a camera there is no world to turn";
}

TEST_F(CliFrameMeaningOfNormals, BlendersAreOfAWorldWhoseZIsUp) {
    const std::optional<std::filesystem::path> data = test_data();
    if (!data) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const std::filesystem::path folder = *data / "exr/render_interior";
    const nlohmann::json camera = nlohmann::json::parse(content(folder / "cameras.json")).at("frames").at("22");
    std::string matrix;
    for (const nlohmann::json& value : camera.at("camera_to_world_rowmajor")) matrix += value.dump() + ",";
    const double across = camera.at("fov_x_deg").get<double>() * 3.14159265358979 / 360;
    write("camera.toml", fmt::format("up = \"z\"\ncamera_to_world = [{}]\nfov = {}\n", matrix,
                                     2 * std::atan(std::tan(across) * 216 / 384) * 180 / 3.14159265358979));
    const std::filesystem::path file = folder / "interior.0022.exr";
    const Result<FrameFile> alone = read_frame(file);
    ASSERT_TRUE(alone);
    EXPECT_FALSE(alone->normals);
    ASSERT_EQ(alone->warnings.size(), 1U);
    EXPECT_NE(alone->warnings[0].find("normals are left out: they are of a world, and no camera comes with them"),
              std::string::npos);
    const Result<FrameFile> placed = read_frame(file, {.camera_file = path("camera.toml")});
    ASSERT_TRUE(placed && placed->normals);
    EXPECT_TRUE(placed->warnings.empty()) << placed->warnings[0];
    // The floor, near the lower edge, looks up, and up is y; so it is in the camera's matrix.
    const Result<FrameFile> raw = read_frame(file, {.normals_space = NormalsSpace::View});
    ASSERT_TRUE(raw && raw->normals);
    std::size_t floors = 0;
    for (std::uint32_t y = 0; y < 216; ++y)
        for (std::uint32_t x = 0; x < 384; ++x) {
            const float *const in = raw->normals->at(x, y), *const out = placed->normals->at(x, y);
            ASSERT_NEAR(out[0], in[0], 1e-5f);
            ASSERT_NEAR(out[1], in[2], 1e-5f);
            ASSERT_NEAR(out[2], -in[1], 1e-5f);
            floors += out[1] > 0.99f;
        }
    EXPECT_GT(floors, 1000U);
    const Matrix& view = *placed->camera.world_to_camera;
    EXPECT_NEAR(view[4 + 1], camera.at("camera_to_world_rowmajor")[9].get<float>(), 1e-4) << "up in the camera";
    // A camera that was turned to y up beside normals that were not: measured, and told.
    write("turned.toml", [&] {
        std::vector<double> m = camera.at("camera_to_world_rowmajor");
        for (std::size_t i = 0; i < 4; ++i) {
            const double y = m[4 + i];
            m[4 + i] = m[8 + i];
            m[8 + i] = -y;
        }
        return fmt::format("camera_to_world = [{}]\nfov = 42.55\n", fmt::join(m, ","));
    }());
    const Result<FrameFile> turned = read_frame(file, {.camera_file = path("turned.toml")});
    ASSERT_TRUE(turned && turned->normals);
    EXPECT_NE(turned->warnings.at(0).find("of a world whose z is up"), std::string::npos);
    EXPECT_NEAR(turned->normals->at(200, 200)[1], placed->normals->at(200, 200)[1], 1e-3f);
    EXPECT_NEAR((*turned->camera.world_to_camera)[5], view[5], 1e-3f);
}

}  // namespace
}  // namespace darkroom
