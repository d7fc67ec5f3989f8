// SPDX-License-Identifier: MIT
// `darkroom probe`: its codes are those of the file that develop writes, and what is not finite has a birthplace.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using nlohmann::json;
using test::Outcome;

class CliProbe : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "exposure", "tonemap", "encode", "vignette", "dither", "ssao"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(width, height);
        frame.depth.emplace();
        frame.depth->width = width;
        frame.depth->height = height;
        for (int i = 0; i < width * height; ++i) {
            float* const pixel =
                frame.color.at(static_cast<std::uint32_t>(i % width), static_cast<std::uint32_t>(i / width));
            for (int c = 0; c < 3; ++c)
                pixel[c] = 0.04F * static_cast<float>((i * 7 + c * 13) % 61) * (i % 11 == 0 ? 9.0F : 1.0F);
            pixel[3] = 1;
            frame.depth->values.push_back(2 + 0.1F * static_cast<float>(i % width));
        }
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        write("breaker.glsl",
              "// @effect breaker: Makes a value that is not a number.\n"
              "// @param int column = 20 in [0, 100]: Where.\n\n"
              "vec4 breaker(vec4 color, Pixel pixel, Breaker parameters) {\n"
              "    if (pixel.texel == ivec2(parameters.column, 12)) color.g = sqrt(-1.0 - abs(color.g));\n"
              "    return color;\n}\n");
        write("mover.glsl",
              "// @effect mover: Moves the picture.\n// @touch warp\n\n"
              "vec4 mover(Pixel pixel, Mover parameters) { return load_clamped(picture, pixel.texel - ivec2(2, 1)); "
              "}\n");
        write("broken.toml",
              "[[stack]]\neffect = \"breaker.glsl\"\n[[stack]]\neffect = \"mover.glsl\"\n"
              "[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    }
    [[nodiscard]] Outcome probe(std::vector<std::string> flags, const std::vector<std::string>& at) const {
        flags.insert(flags.begin(), {"probe", path("frame.exr")});
        for (const std::string& place : at) flags.insert(flags.end(), {"--at", place});
        return run(flags);
    }
    [[nodiscard]] json document(std::vector<std::string> flags, const std::vector<std::string>& at) const {
        flags.emplace_back("--json");
        const Outcome outcome = probe(flags, at);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out, nullptr, false);
    }
    static constexpr int width = 48, height = 30;
};

TEST_F(CliProbe, CodesAreThoseOfTheDevelopedFile) {
    std::vector<std::string> at;
    for (int i = 0; i < 24; ++i) at.push_back(fmt::format("{},{}", i * 17 % width, i * 7 % height));
    at.push_back(fmt::format("{},{}", width - 1, height - 1));
    std::vector<std::vector<std::string>> all{{},
                                              {"--dither-enabled", "on", "--exposure", "2.5"},
                                              {"--no-fuse", "--vignette-intensity", "0.7"},
                                              {"--no-postprocess"}};
    const std::string looks = std::string(test::source_folder) + "/looks/";
    for (const char* const name : {"bright", "documented_full", "daze"}) {
        if (!std::filesystem::exists(looks + name + ".toml")) continue;
        all.push_back({"--look", looks + name + ".toml"});
    }
    for (std::vector<std::string>& flags : all) {
        const json seen = document(flags, at);
        ASSERT_EQ(seen.at("pixels").size(), at.size());
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-o", path("out.png")});
        ASSERT_EQ(run(flags).code, 0);
        const Picture made = picture("out.png");
        for (const json& pixel : seen.at("pixels"))
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t i = pixel.at("y").get<std::size_t>() * width + pixel.at("x").get<std::size_t>();
                EXPECT_EQ(pixel.at("codes")[c].get<int>(), std::lround(made.pixels[i * 4 + c] * 255.0F))
                    << fmt::format("{}", fmt::join(flags, " ")) << " at " << i;
            }
    }
}

TEST_F(CliProbe, EveryEntryHasItsValues) {
    const json seen = document({"--exposure", "2", "--dither-enabled", "on", "--ssao"}, {"5,6"});
    const json& pixel = seen.at("pixels")[0];
    const json& entries = pixel.at("entries");
    const auto entry = [&](const std::string& name) -> const json& {
        for (const json& one : entries)
            if (one.at("name") == name) return one;
        ADD_FAILURE() << "no entry " << name;
        return entries[0];
    };
    EXPECT_EQ(entry("ssao").at("presence"), "on") << entry("ssao").dump(2);
    EXPECT_EQ(entry("exposure").at("domain"), "scene_linear");
    EXPECT_EQ(entry("encode").at("domain"), "encoded");
    EXPECT_TRUE(entry("bloom").at("reads_around").get<bool>());
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(entry("exposure").at("after")[c].get<double>(), 2 * entry("exposure").at("before")[c].get<double>(),
                    1e-5);
    EXPECT_NEAR(entry("exposure").at("relative_change").get<double>(), 1, 1e-6);
    // The codes are those of the last value, but for the rounding of pictures in between.
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(entries.back().at("after")[c].get<double>() * 255, pixel.at("codes")[c].get<double>(), 1.01);

    const Outcome text = probe({"--exposure", "2"}, {"5,6", "0,0"});
    EXPECT_EQ(text.code, 0) << text.err;
    for (const char* const part :
         {"frame.exr: 48x30\npixel 5,6\n", "\npixel 0,0\n", "  exposure", "codes of 8 bits", "100 %"})
        EXPECT_NE(text.out.find(part), std::string::npos) << part << " is not in " << text.out;
}

TEST_F(CliProbe, WhatIsNotFiniteIsFoundWhereItIsBorn) {
    const json seen = document({"--look", path("broken.toml")}, {"20,12", "22,13", "4,4"});
    const json& pixels = seen.at("pixels");
    // What was made here moved away.
    EXPECT_EQ(pixels[0].at("not_finite_since"), "breaker");
    EXPECT_EQ(pixels[0].at("entries")[0].at("after")[1], "nan");
    EXPECT_EQ(pixels[0].at("entries")[0].at("change"), "inf");
    EXPECT_EQ(pixels[1].at("not_finite_since"), "mover");
    for (const json& pixel : {pixels[0], pixels[1]}) {
        const json& first = pixel.at("first_not_finite");
        EXPECT_EQ(first.at("entry"), "breaker");
        EXPECT_EQ(first.at("x"), 20);
        EXPECT_EQ(first.at("y"), 12);
        EXPECT_EQ(first.at("pixels"), 1);
    }
    EXPECT_FALSE(pixels[2].contains("first_not_finite"));
    const Outcome text = probe({"--look", path("broken.toml")}, {"22,13"});
    EXPECT_NE(text.out.find("  not finite first behind breaker, nearest at 20,12 (1 pixel); mover brought it here\n"),
              std::string::npos)
        << text.out;
}

TEST_F(CliProbe, WrongPlacesAreRefused) {
    const auto refused = [&](const std::string& at, const std::string& part) {
        expect_refused({"probe", path("frame.exr"), "--at", at}, 1, part);
    };
    refused("48,0", "--at 48,0: the picture is 48x30, allowed is 0,0 to 47,29");
    refused("-1,0", "--at -1,0: the picture is 48x30");
    for (const char* const wrong : {"5", "5,", ",5", "5,6,7", "a,b", "1.5,2", "99999999999,0"})
        refused(wrong, fmt::format("--at: '{}' is not a pixel, allowed is X,Y: two whole numbers", wrong));
    expect_refused({"probe", path("frame.exr")}, 1, "--at");
    expect_refused({"probe", path("none.exr"), "--at", "0,0"}, 1, "none.exr");
    std::vector<std::string> many{"probe", path("frame.exr"), "--look", path("broken.toml")};
    for (int i = 0; i < 300; ++i) many.insert(many.end(), {"--at", "1,1"});
    expect_refused(many, 1, "--at: 300 pixels of a stack of 4 entries: allowed are at most 203");
}

TEST_F(CliProbe, ANumberedCameraIsThatOfTheFrame) {
    std::filesystem::copy(path("frame.exr"), path("f.0007.exr"));
    write("camera.0007.toml", "fov = 20\n");
    const auto probe = [&](const std::string& camera) {
        return run({"probe", path("f.0007.exr"), "--camera", path(camera), "--ssao-intensity", "1", "--at", "12,4"});
    };
    const Outcome numbered = probe("camera.####.toml"), named = probe("camera.0007.toml");
    EXPECT_EQ(numbered.code, 0) << numbered.err;
    EXPECT_EQ(numbered.out, named.out);
}

// What is wrong with one is told before any picture is made.
TEST_F(CliProbe, AllNumberedCamerasAreReadBeforeAnyWork) {
    for (const char* const name : {"f.0001.exr", "f.0002.exr"}) std::filesystem::copy(path("frame.exr"), path(name));
    write("camera.0001.toml", "fov = 20\n");
    const std::vector<std::string> command{"develop", path("f.####.exr"),  "--camera", path("camera.####.toml"), "-q",
                                           "-o",      path("out.####.png")};
    expect_refused(command, 1, "camera.0002.toml");
    write("camera.0002.toml", "fov = 1000\n");
    expect_refused(command, 1, "camera.0002.toml");
    write("camera.0002.toml", "fov = 30\n");
    EXPECT_EQ(run(command).code, 0);
    EXPECT_TRUE(std::filesystem::exists(path("out.0002.png")));
}

}  // namespace
}  // namespace darkroom
