// SPDX-License-Identifier: MIT
// The examples of effects in one file, named by looks and by the command line, and files that are wrong.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;
using test::content;
using test::Outcome;

const fs::path shipped_examples = fs::path(test::source_folder) / "examples";

class CliCustomEffects : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"tonemap", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
    void make_files() override {
        for (const char* const name : {"duotone.glsl", "two_pass_blur.glsl", "feedback_trail.glsl"})
            fs::copy_file(shipped_examples / name, path(name));
        for (int number = 0; number < frames; ++number) make_frame(number);
        write("all.toml",
              "[[stack]]\neffect = \"two_pass_blur.glsl\"\nradius = 2\n[[stack]]\neffect = \"tonemap\"\n"
              "[[stack]]\neffect = \"duotone.glsl\"\n[[stack]]\neffect = \"feedback_trail.glsl\"\n"
              "[[stack]]\neffect = \"encode\"\n");
    }
    /// A bright bar that moves.
    void make_frame(int number) const {
        FrameFile frame;
        frame.color = Picture(48, 32);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3                                                    ? 1.0f
                                    : i / 4 % 48 / 4 == static_cast<std::size_t>(number * 2) % 12 ? 4.0f
                                                                                                  : 0.02f;
        ASSERT_TRUE(write_frame(path(in(number)), frame));
    }
    static std::string in(int number) { return fmt::format("f.{:04}.exr", number); }
    [[nodiscard]] std::string developed(const std::vector<std::string>& flags) const {
        std::vector<std::string> arguments{"develop", path(in(0)), "-o", path("out.png")};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return content(path("out.png"));
    }
    void expect_file_refused(const std::string& text, const std::string& part) const {
        expect_refused({"plan", "--effect", write("wrong.glsl", text)}, 1, part);
    }

    static constexpr int frames = 6;
};

TEST_F(CliCustomEffects, TheExamplesRunThroughALook) {
    const std::string all = developed({"--look", path("all.toml")});
    EXPECT_NE(all, developed({"--look", path("all.toml"), "--two-pass-blur-radius", "4"}));
    EXPECT_NE(all, developed({"--look", path("all.toml"), "--set", "duotone.amount=0.5"}));
    EXPECT_EQ(all, developed({"--look", path("all.toml"), "--duotone-weight", "luminance"}));
    EXPECT_NE(all, developed({"--look", path("all.toml"), "--duotone-enabled", "off"}));
}

TEST_F(CliCustomEffects, AFlagIsAnEntryBeforeTheEncoding) {
    write("same.toml",
          "[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"duotone.glsl\"\namount = 0.75\n"
          "[[stack]]\neffect = \"encode\"\n");
    write("plain.toml", "[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    const std::string expected = developed({"--look", path("same.toml")});
    EXPECT_EQ(developed({"--look", path("plain.toml"), "--effect", path("duotone.glsl"), "--duotone-amount", "0.75"}),
              expected);
    EXPECT_EQ(
        developed({"--look", path("plain.toml"), "--effect=" + path("duotone.glsl"), "--set", "duotone.amount=0.75"}),
        expected);
    EXPECT_NE(developed({"--effect", path("duotone.glsl")}), developed({})) << "the flat table";
    EXPECT_EQ(developed({"--effect", path("duotone.glsl"), "--duotone-amount", "0"}), developed({}));
    EXPECT_EQ(developed({"--effect", path("duotone.glsl"), "--no-postprocess"}), developed({"--no-postprocess"}));
}

TEST_F(CliCustomEffects, ATrailIsTheSameInPiecesAndAsAWhole) {
    const auto run_to = [&](const std::string& folder, std::vector<std::string> more) {
        fs::create_directories(path(folder));
        more.insert(more.begin(), {"develop", path("f.%04d.exr"), "-o", path(folder) + "/", "--fps", "60", "--look",
                                   path("all.toml")});
        const Outcome outcome = run(more);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture(folder + "/f.0004.png");
    };
    const Picture whole = run_to("whole", {}), piece = run_to("piece", {"--frames", "4"});
    EXPECT_FALSE(fs::exists(path("piece/f.0003.png")));
    EXPECT_EQ(piece.pixels, whole.pixels);
    const Picture without = run_to("without", {"--feedback-trail-enabled", "off"});
    EXPECT_NE(without.pixels, whole.pixels);
}

TEST_F(CliCustomEffects, AFileHasAPageAndFlags) {
    const Outcome page = run({"effects", path("two_pass_blur.glsl")});
    EXPECT_EQ(page.code, 0) << page.err;
    EXPECT_NE(page.out.find("# two_pass_blur\n\nBlurs along the rows"), std::string::npos) << page.out;
    EXPECT_NE(page.out.find("`two_pass_blur_radius` | `6.0` | [0.5, 32] px"), std::string::npos) << page.out;
    EXPECT_NE(run({"effects", path("duotone.glsl"), "--json"}).out.find("\"flag\": \"--duotone-amount\""),
              std::string::npos);
    EXPECT_NE(run({"develop", "--effect", path("duotone.glsl"), "--help", "duotone"}).out.find("--duotone-amount"),
              std::string::npos);
    EXPECT_NE(run({"info", path("all.toml")}).out.find("feedback_trail.glsl"), std::string::npos);
    expect_refused({"plan", path("all.toml"), "--duotone-amont", "1"}, 1,
                   "unknown argument '--duotone-amont', did you mean '--duotone-amount'?");
    expect_refused({"plan", path("all.toml"), "--duotone-amount", "2"}, 1, "--duotone-amount = 2: allowed is [0, 1]");
    expect_refused({"plan", "--duotone-amount", "1"}, 1, "unknown argument '--duotone-amount'");
}

TEST_F(CliCustomEffects, AreRefusedWhereTheyAreNotWanted) {
    const std::string no = "--no-custom-effects", part = "the effect of a file is code, which is not allowed";
    expect_refused({"develop", path(in(0)), "-o", path("x.png"), "--look", path("all.toml"), no}, 1, part);
    expect_refused({"plan", path("all.toml"), no}, 1, part);
    expect_refused({"info", path("all.toml"), no}, 1, part);
    const std::string scene = write("a.scene.toml", "[scene]\n[[stack]]\neffect = \"duotone.glsl\"\n");
    expect_refused({"render", scene, "-o", path("x.png"), no}, 1, part);
    expect_refused({"plan", "--effect", path("duotone.glsl"), no}, 1, "duotone.glsl: --no-custom-effects refuses it");
}

TEST_F(CliCustomEffects, WhatIsWrongIsOneLine) {
    expect_refused({"plan", "--effect", path("absent.glsl")}, 1, "absent.glsl: there is no such file");
    fs::create_directories(path("folder.glsl"));
    expect_refused({"plan", "--effect", path("folder.glsl")}, 1, "folder.glsl: is a folder, a file is needed");
    ASSERT_EQ(mkfifo(path("pipe.glsl").c_str(), 0600), 0);
    expect_refused({"plan", "--effect", path("pipe.glsl")}, 1, "pipe.glsl: is a pipe, a regular file is needed");
    expect_refused({"effects", path("pipe.glsl")}, 1, "pipe.glsl: is a pipe, a regular file is needed");
    expect_file_refused(std::string(1 << 20, '\n'), "wrong.glsl: 1048576 bytes, at most 65536 are read");
    expect_file_refused("", "wrong.glsl:1: no line `// @effect NAME: SENTENCE.` before the code");
    expect_file_refused("// @effect bloom: Mine.\nbloom(",
                        "wrong.glsl:1: bloom: the name of an effect that is built in");
    expect_file_refused("// @effect mine: Mine.\n", "wrong.glsl:1: no function mine");
    expect_file_refused("// @effect mine: Mine.\n// @image a: 1 r8\n// @pass a: a -> a\nmine_a(",
                        "wrong.glsl:3: pass a reads 'a', which no pass before it writes");
    expect_refused({"develop", path(in(0)), "-o", path("x.png"), "--effect",
                    write("wrong.glsl", "// @effect mine: Mine.\nvec4 mine(vec4 c, Pixel p, Mine m) { return d; }\n")},
                   1, "wrong.glsl:2");
    expect_refused(
        {"develop", path(in(0)), "-o", path("x.png"), "--effect",
         write("wrong.glsl", "// @effect mine: Mine.\nvec4 mine(vec4 c, Pixel p, Mine m) { \x1b[31m\xff }\n")},
        1, "wrong.glsl:2");
}

}  // namespace
}  // namespace darkroom
