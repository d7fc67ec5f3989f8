// SPDX-License-Identifier: MIT
// What the numbers of a frame mean, which size it gets and what is done to it by itself, as flags say it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/effects.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliColor : public test::CliFixture {
  protected:
    static constexpr float grey = 0.25F;

    void make_files() override {
        FrameFile frame;
        frame.color = Picture(32, 18);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = i % 4 == 3 ? 1.0F : grey;
        frame.samples = SampleKind::Float;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        write("plain.toml", "[[stack]]\neffect = \"exposure\"\n");
        // lin_rec709 is the reference of this configuration; a view takes the root.
        write("config.ocio", R"(ocio_profile_version: 2
roles: {default: lin_rec709, scene_linear: lin_rec709}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: root, colorspace: rooted}
    - !<View> {name: half, colorspace: doubled}
    - !<View> {name: numbers, colorspace: raw}
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace>
    name: rooted
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: doubled
    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
)");
    }
    [[nodiscard]] Outcome develop(std::vector<std::string> flags, const std::string& out = "out.exr") const {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "--look", path("plain.toml"), "-o", path(out)});
        return run(flags);
    }
    /// Of a pixel in the middle.
    [[nodiscard]] std::array<float, 3> color_after(const std::vector<std::string>& flags,
                                                   const std::string& out = "out.exr") const {
        const Outcome outcome = develop(flags, out);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const Picture made = picture(out);
        const float* const pixel = made.at(made.width / 2, made.height / 2);
        return {pixel[0], pixel[1], pixel[2]};
    }
    void expect_error(const std::vector<std::string>& flags, const std::string& text) const {
        const Outcome outcome = develop(flags, "none.png");
        EXPECT_EQ(outcome.code, 1);
        EXPECT_EQ(outcome.err, "darkroom: " + text + "\n");
        EXPECT_FALSE(std::filesystem::exists(path("none.png")));
    }
};

TEST_F(CliColor, InputSpaceSaysWhatTheNumbersMean) {
    EXPECT_NEAR(color_after({})[0], grey, 1e-3);
    EXPECT_NEAR(color_after({"--input-space", "srgb"})[0], 0.0508761, 1e-4);
    for (const char* const space : {"acescg", "aces2065-1", "rec2020", "p3", "rec709"})
        EXPECT_NEAR(color_after({"--input-space", space})[1], grey, 1e-3) << space << ": grey is grey";
    expect_error(
        {"--input-space", "p33"},
        "--input-space: 'p33' is not a known color space, did you mean 'p3'? allowed is srgb, rec709, rec2020, "
        "p3, acescg or aces2065-1");
}

TEST_F(CliColor, SpacesOfAConfigurationAreRead) {
    const std::string config = path("config.ocio");
    EXPECT_NEAR(color_after({"--ocio", config, "--input-space", "doubled"})[2], 2 * grey, 1e-3);
    EXPECT_NEAR(color_after({"--ocio", config, "--input-space", "rooted"})[2], grey * grey, 1e-3);
    expect_error(
        {"--ocio", config, "--input-space", "dubled"},
        config +
            ": has no color space 'dubled', did you mean 'doubled'? there are raw, lin_rec709, rooted and doubled");
    expect_error({"--ocio", path("none.ocio"), "--input-space", "rooted"},
                 path("none.ocio") + ": there is no such file");
    write("bad.ocio", "ocio_profile_version: 2\n");
    const Outcome bad = develop({"--ocio", path("bad.ocio"), "--input-space", "rooted"}, "none.png");
    EXPECT_EQ(bad.code, 1);
    EXPECT_TRUE(bad.err.starts_with("darkroom: " + path("bad.ocio") + ": ")) << bad.err;
    EXPECT_EQ(std::ranges::count(bad.err, '\n'), 1) << bad.err;
}

// The stack leaves light; a look's table encodes and dithers no more.
TEST_F(CliColor, PicturesAreWrittenForAnotherSpaceAndComeBack) {
    constexpr std::array<float, 3> light{0.25F, 0.5F, 0.125F};
    FrameFile colorful;
    colorful.color = Picture(32, 18);
    for (std::size_t i = 0; i < colorful.color.pixels.size(); ++i)
        colorful.color.pixels[i] = i % 4 == 3 ? 1.0F : light[i % 4];
    colorful.samples = SampleKind::Float;
    ASSERT_TRUE(write_frame(path("frame.exr"), colorful));
    /// Everywhere the light of the frame, `scale` times as bright.
    const auto expect_light = [&](const Outcome& outcome, const std::string& out, float scale, float bound) {
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Result<FrameFile> frame = read_frame(path(out));
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_TRUE(frame->warnings.empty());
        for (std::size_t i = 0; i < frame->color.pixels.size(); ++i)
            if (i % 4 != 3) {
                ASSERT_NEAR(frame->color.pixels[i], scale * light[i % 4], bound) << out << " " << i;
            }
    };
    for (const char* const space : {"srgb", "p3", "pq"}) {
        expect_light(develop({"--output-space", space, "--bits", "16"}, "s.png"), "s.png", 1, 2e-4F);
        expect_light(develop({"--output-space", space, "--bits", "16", "--reference"}, "r.png"), "r.png", 1, 2e-4F);
    }
    EXPECT_NE(content(path("s.png")).find("cICP"), std::string::npos);
    for (const char* const space : {"p3", "rec2020"})
        expect_light(develop({"--output-space", space}, "s.exr"), "s.exr", 1, 2e-4F);
    expect_light(develop({"--exposure", "8", "--output-space", "pq"}, "b.png"), "b.png", 8, 0.01F);
    EXPECT_EQ(develop({"--exposure", "8", "--output-space", "pq", "--output-peak", "406"}, "d.png").code, 0);
    // Of channels of Rec. 2020, each up to 406 cd/m2.
    EXPECT_NEAR(read_frame(path("d.png"))->color.at(16, 9)[1], 2.006, 0.01);
    // Beyond the white of sRGB, where its curve ends, and without noise.
    expect_light(run({"develop", path("frame.exr"), "-o", path("t.png"), "--output-space", "pq", "--tonemap-curve",
                      "bt2390", "--tonemap-peak-nits", "1000", "--exposure", "4", "--no-bloom"}),
                 "t.png", 4, 3e-3F);
    expect_error({"--output-space", "pq2"},
                 "--output-space: 'pq2' is not a color space that pictures can be written in, did you mean 'pq'? "
                 "allowed is srgb, p3, rec2020, "
                 "pq or hlg");
    expect_error({"--output-peak", "500"}, "--output-peak: needs --output-space pq or hlg");
    expect_error({"--output-space", "p3", "--output-peak", "500"},
                 "--output-peak: works for pq and hlg, and not for p3");
}

// PNG files without cICP say that they are sRGB.
TEST_F(CliColor, CodesOfAnotherDisplayAreNotWrittenAsThoughTheyWereOfSrgb) {
    const std::string frame = path("frame.exr"), out = path("none.png");
    for (const char* const transfer : {"pq", "hlg", "scrgb", "p3"}) {
        const Outcome refused = run({"develop", frame, "-o", out, "--encode-transfer", transfer});
        EXPECT_EQ(refused.code, 1) << transfer;
        EXPECT_EQ(
            refused.err,
            "darkroom: encode: makes code values other than sRGB, and the file would be marked as sRGB: allowed is "
            "--output-space srgb, p3, pq, hlg, which encodes the picture and marks the file\n");
        EXPECT_FALSE(std::filesystem::exists(out));
    }
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{"--encode-transfer", "gamma22"}, {"--encode-transfer", "pq", "--no-encode"}}) {
        std::vector<std::string> all{"develop", frame, "-o", path("plain.png")};
        all.insert(all.end(), flags.begin(), flags.end());
        const Outcome outcome = run(all);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
    const Outcome said =
        run({"develop", frame, "-o", path("said.png"), "--encode-transfer", "pq", "--output-space", "pq"});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_NE(content(path("said.png")).find("cICP"), std::string::npos);
}

TEST_F(CliColor, CodesOfTwoSpacesAreComparedWithAWord) {
    for (const char* const space : {"srgb", "p3"})
        ASSERT_EQ(run({"develop", path("frame.exr"), "-o", path(std::string(space) + ".png"), "--bits", "8",
                       "--output-space", space})
                      .code,
                  0);
    EXPECT_EQ(run({"compare", path("srgb.png"), path("srgb.png")}).err, "");
    const Outcome two = run({"compare", path("srgb.png"), path("p3.png")});
    EXPECT_NE(two.err.find("two color spaces (sRGB; cICP 12 13 0 1)"), std::string::npos) << two.err;
}

// OpenEXR has colours multiplied by alpha, PNG has them straight.
TEST_F(CliColor, AnEdgeHasTheColourOfWhatItIsTheEdgeOf) {
    if (find_effect("tonemap") == nullptr) GTEST_SKIP() << "this build has no tonemap";
    FrameFile frame;
    frame.color = Picture(32, 18);
    for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) {
        const float alpha = i / 4 % 32 < 16 ? 1.0F : 0.5F;
        frame.color.pixels[i] = i % 4 == 3 ? alpha : alpha * 3;
    }
    frame.has_alpha = true;
    frame.samples = SampleKind::Float;
    ASSERT_TRUE(write_frame(path("edge.exr"), frame));
    write("curve.toml", "[[stack]]\neffect = \"tonemap\"\ncurve = \"reinhard_extended\"\nwhite = 8.0\n");
    const auto made = [&](const std::string& out, const char* flag) {
        const Outcome outcome = run({"develop", path("edge.exr"), "--look", path("curve.toml"), "--alpha", "-o",
                                     path(out), "--bits", out.ends_with("png") ? "16" : "float", flag});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Picture picture = this->picture(out);
        return std::array{*picture.at(4, 9), *picture.at(24, 9), picture.at(24, 9)[3]};
    };
    for (const char* const flag : {"--quiet", "--reference"}) {
        const auto straight = made("edge.png", flag);
        EXPECT_NEAR(straight[1], straight[0], 2.0 / 65535) << flag;
        EXPECT_NEAR(straight[2], 0.5, 1.0 / 65535);
        const auto multiplied = made("edge.exr.exr", flag);
        EXPECT_NEAR(multiplied[1], 0.5 * multiplied[0], 1e-5) << flag;
        EXPECT_EQ(multiplied[2], 0.5);
    }
}

TEST_F(CliColor, PicturesAreMadeForAViewOfADisplay) {
    const std::string config = path("config.ocio");
    for (const char* const out : {"a.png", "a.tif", "a.jpg"})
        EXPECT_NEAR(color_after({"--ocio", config, "--display", "screen"}, out)[0], 0.5, 0.51 / 255) << out;
    EXPECT_NEAR(color_after({"--ocio", config, "--display", "screen", "--bits", "16"}, "b.png")[0], 0.5, 1.0 / 65535);
    EXPECT_NEAR(color_after({"--ocio", config, "--display", "screen", "--view", "half"}, "c.png")[0], grey / 2,
                0.5 / 255);
    EXPECT_EQ(content(path("a.png")).find("sRGB"), std::string::npos) << "the display need not be one";
    // OpenColorIO does nothing to numbers on the way to a view of data.
    for (const char* const space : {"lin_rec709", "doubled", "rooted"})
        EXPECT_NEAR(color_after({"--ocio", config, "--input-space", space, "--display", "screen", "--view", "numbers",
                                 "--bits", "16"},
                                "n.png")[0],
                    grey, 1e-4)
            << space;
    // The look's own curve gives way to the view's.
    const Outcome outcome =
        run({"develop", path("frame.exr"), "-o", path("d.png"), "--ocio", config, "--display", "screen"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(*picture("d.png").at(9, 9), 0.5, 1.0 / 255);
    expect_error({"--ocio", config, "--display", "scren"},
                 config + ": has no display 'scren', did you mean 'screen'? there are screen");
    expect_error({"--ocio", config, "--display", "screen", "--view", "x"},
                 config + ": has no view 'x': there are root, half and numbers");
    expect_error({"--display", "screen"}, "--display: needs --ocio FILE, which defines it");
    expect_error({"--ocio", config}, "--ocio: needs --input-space or --display, which use it");
    expect_error({"--view", "root"}, "--view: needs --display NAME");
    expect_error({"--ocio", config, "--display", "screen", "--bits", "half"},
                 path("none.png") + ": half samples hold light, not a view of a display; .jpg .png .tif hold one");
}

TEST_F(CliColor, AViewOfWhatIsTransparentIsThatOfItsColorAndGlowsAsBrightAsItLooks) {
    FrameFile frame;
    frame.color = Picture(32, 18);
    frame.has_alpha = true;
    frame.samples = SampleKind::Float;
    const auto made_of = [&](const std::array<float, 4>& color, const char* alpha) {
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = color[i % 4];
        EXPECT_TRUE(write_frame(path("frame.exr"), frame));
        EXPECT_EQ(develop({"--ocio", path("config.ocio"), "--display", "screen", "--bits", "16", alpha}, "a.png").code,
                  0);
        return picture("a.png");
    };
    const Picture plain = made_of({0.2F, 0.1F, 0.05F, 0.5F}, "--alpha");
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(plain.pixels[c], c < 3 ? std::sqrt(0.4 / std::pow(2.0, c)) : 0.5, 2.0 / 65535) << c;
    EXPECT_EQ(made_of({0.2F, 0.1F, 0.05F, 0.5F}, "--alpha=glow").pixels, plain.pixels) << "nothing glows";
    const Picture glow = made_of({0.16F, 0.04F, 0, 0}, "--alpha=glow");
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(glow.pixels[c], (std::array{1.0, 0.5, 0.0, 0.4})[c], 2.0 / 65535) << c;
}

TEST_F(CliColor, AnotherRatioIsFittedInUnlessItIsSaid) {
    const auto size_of = [&](const std::string& size) {
        EXPECT_EQ(develop({"--size", size}, "out.png").code, 0);
        const Picture made = picture("out.png");
        return fmt::format("{}x{}", made.width, made.height);
    };
    EXPECT_EQ(size_of("64x64"), "64x36");
    EXPECT_EQ(size_of("64x64:fit"), "64x36");
    EXPECT_EQ(size_of("64x64:fill"), "64x64");
    EXPECT_EQ(size_of("64x64:stretch"), "64x64");
    expect_error(
        {"--size", "64x64:stretsh"},
        "--size 64x64:stretsh: 'stretsh' is not a way to resize, did you mean 'stretch'? allowed is fit, fill or "
        "stretch");
}

// A path tracer's picture is as dark in its corners as it should be.
TEST_F(CliColor, FramesOfFilesGetNoOcclusionByThemselves) {
    if (find_effect("ssao") == nullptr) GTEST_SKIP() << "this build has no ssao";
    FrameFile frame;
    frame.color = Picture(64, 36);
    std::ranges::fill(frame.color.pixels, 0.5F);
    frame.depth = Plane<1>(64, 36);
    for (std::uint32_t y = 0; y < 36; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            *frame.depth->at(x, y) = 3 - 0.06F * std::abs(static_cast<float>(x) - 31.5F);
    ASSERT_TRUE(write_frame(path("corner.exr"), frame));
    const auto made = [&](const std::vector<std::string>& flags) {
        std::vector<std::string> all{"develop", path("corner.exr"), "--fov", "60", "-o", path("out.png"), "-q"};
        all.insert(all.end(), flags.begin(), flags.end());
        EXPECT_EQ(run(all).code, 0);
        return content(path("out.png"));
    };
    write("empty.toml", "[post_process]\norder = \"scene_linear\"\n");
    const std::string plain = made({});
    EXPECT_EQ(plain, made({"--no-ssao"}));
    EXPECT_NE(plain, made({"--ssao"}));
    EXPECT_EQ(made({"--ssao"}), made({"--look", path("empty.toml")})) << "a look that is named is as it is";
}

}  // namespace
}  // namespace darkroom
