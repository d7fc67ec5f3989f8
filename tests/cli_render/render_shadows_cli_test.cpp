// SPDX-License-Identifier: MIT
// Frames with their lights and shadows, from `darkroom render --frame` to `darkroom develop`: what is developed is the
// picture that was rendered, volumetric light included.
#include <darkroom/effects.hpp>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliRenderShadows : public test::CliFixture {
  protected:
    void SetUp() override {
        if (find_effect("volumetric") == nullptr) GTEST_SKIP() << "the effect volumetric is not in this build";
        CliFixture::SetUp();
    }
    /// Of a scene that is lit by its volumetric light.
    [[nodiscard]] Outcome render_dungeon(std::vector<std::string> flags, const std::string& out) const {
        flags.insert(flags.begin(),
                     {"render", dungeon, "-o", path(out), "--size", "80x45", "--shadow-resolution", "256"});
        return run(flags);
    }
    [[nodiscard]] Outcome develop(const std::string& name, const std::string& out,
                                  std::vector<std::string> flags = {}) const {
        flags.insert(flags.begin(), {"develop", path(name), "--look", dungeon, "-o", path(out)});
        return run(flags);
    }
    void expect_develops_alike(std::vector<std::string> flags) const {
        flags.insert(flags.end(), {"--frame", path("f.exr")});
        const Outcome rendered = render_dungeon(flags, "a.png");
        ASSERT_EQ(rendered.code, 0) << rendered.err;
        const Outcome developed = develop("f.exr", "b.png");
        ASSERT_EQ(developed.code, 0) << developed.err;
        EXPECT_EQ(developed.err, "");
        EXPECT_EQ(content(path("a.png")), content(path("b.png")));
    }
    [[nodiscard]] FrameFile frame(const std::string& name) const {
        Result<FrameFile> read = read_frame(path(name));
        EXPECT_TRUE(read) << read.error().text;
        return read ? std::move(*read) : FrameFile{};
    }
    inline static const std::string dungeon = std::string(test::source_folder) + "/scenes/dungeon.scene.toml";
};

TEST_F(CliRenderShadows, VolumetricLightIsDevelopedBitForBit) {
    expect_develops_alike({});
    // The light is in the picture, and the depths stay in the file for who does not need them.
    const Outcome off = develop("f.exr", "off.png", {"--volumetric-enabled", "off"});
    EXPECT_EQ(off.code, 0) << off.err;
    EXPECT_EQ(off.err, "");
    const Result<Comparison> lit = compare(picture("a.png"), picture("off.png"));
    ASSERT_TRUE(lit);
    EXPECT_GT(lit->mean_error, 0.02);
    const FrameFile file = frame("f.exr");
    ASSERT_EQ(file.lights.size(), 1U);
    ASSERT_EQ(file.lights[0].cascades.size(), 3U);
    EXPECT_EQ(file.lights[0].volumetric_intensity, 4);
    EXPECT_EQ(file.lights[0].cascades[2].depth.width, 256U);
    EXPECT_LT(*std::ranges::min_element(file.lights[0].cascades[2].depth.values), 1);
}

TEST_F(CliRenderShadows, TheFilterIsChosen) {
    for (const std::string filter : {"plain", "soft"})
        ASSERT_EQ(
            run({"render", dungeon, "-o", path(filter + ".png"), "--size", "160x90", "--shadow-filter", filter}).code,
            0);
    EXPECT_NE(content(path("plain.png")), content(path("soft.png")));
}

TEST_F(CliRenderShadows, EveryFrameAndSampleIsDevelopedBitForBit) {
    expect_develops_alike({"--msaa", "4", "--frames", "2"});
}

// Pictures, layers, lights and cascades alike, whichever process made them.
TEST_F(CliRenderShadows, EveryProcessMakesTheSameBytes) {
    std::string picture_bytes, frame_bytes;
    for (int i = 0; i < 6; ++i) {
        ASSERT_EQ(render_dungeon({"--frame", path("f.exr")}, "a.png").code, 0);
        if (i == 0) {
            picture_bytes = content(path("a.png"));
            frame_bytes = content(path("f.exr"));
        }
        EXPECT_TRUE(content(path("a.png")) == picture_bytes) << i;
        EXPECT_TRUE(content(path("f.exr")) == frame_bytes) << i;
    }
}

// Without fxaa, which decides by comparing neighbours: where rounding turns a comparison, a pixel is another.
TEST_F(CliRenderShadows, TheReferencesHaveVolumetricLightToo) {
    ASSERT_EQ(render_dungeon({"--frame", path("f.exr"), "--fxaa-enabled", "off"}, "a.png").code, 0);
    const Outcome outcome = develop("f.exr", "reference.png", {"--reference", "--fxaa-enabled", "off"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const Result<Comparison> same = compare(picture("a.png"), picture("reference.png"));
    ASSERT_TRUE(same);
    EXPECT_LE(same->max_error, 1.001 / 255);
    EXPECT_LE(same->mean_error, 0.25 / 255);
}

TEST_F(CliRenderShadows, WithoutShadowsItIsLeftOutAndSaidSo) {
    ASSERT_EQ(render_dungeon({"--no-shadows", "--frame", path("f.exr")}, "a.png").code, 0);
    const FrameFile file = frame("f.exr");
    ASSERT_EQ(file.lights.size(), 1U) << "other effects read it";
    EXPECT_TRUE(file.lights[0].cascades.empty());
    const std::string reason = "left out: volumetric: needs shadows, which the frame does not have\n";
    for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{{}, {"--reference"}}) {
        const Outcome developed = develop("f.exr", "b.png", flags);
        ASSERT_EQ(developed.code, 0) << developed.err;
        EXPECT_EQ(developed.err, "darkroom: warning: " + reason);
        if (!flags.empty()) continue;  // references may differ by a code
        EXPECT_EQ(content(path("a.png")), content(path("b.png")));
    }
}

TEST_F(CliRenderShadows, APlanForAFrameKnowsWhetherItHasShadows) {
    FrameFile file;
    file.color = Picture(2, 2);
    file.depth = Plane<1>(2, 2);
    const auto plan = [&] {
        EXPECT_TRUE(write_frame(path("f.exr"), file));
        const Outcome outcome = run({"plan", dungeon, "--input", path("f.exr")});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    };
    EXPECT_NE(plan().find("left out: volumetric: needs shadows, which the frame does not have\n"), std::string::npos);
    file.lights = {{.cascades = {{.split = 1, .depth = Plane<1>(1, 1)}}}};
    EXPECT_NE(plan().find("volumetric.march 0"), std::string::npos);
}

TEST_F(CliRenderShadows, LightsWithoutShadowsAreDevelopedToo) {
    if (find_effect("god_rays") == nullptr) GTEST_SKIP() << "the effect god_rays is not in this build";
    const auto look = [&](const std::string& name, const std::string& follows_light) {
        return write(name, "[[stack]]\neffect = \"god_rays\"\nthreshold = 0.0\nintensity = 2.0\nfollows_light = " +
                               follows_light + "\n[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"encode\"\n");
    };
    const std::string follows = look("follows.toml", "true"), stays = look("stays.toml", "false");
    ASSERT_EQ(render_dungeon({"--no-shadows", "--frame", path("f.exr"), "--look", follows}, "a.png").code, 0);
    ASSERT_EQ(run({"develop", path("f.exr"), "--look", follows, "-o", path("b.png")}).code, 0);
    ASSERT_EQ(run({"develop", path("f.exr"), "--look", stays, "-o", path("c.png")}).code, 0);
    EXPECT_EQ(content(path("a.png")), content(path("b.png")));
    EXPECT_NE(content(path("a.png")), content(path("c.png"))) << "the light is seen, and is not where it is by itself";
}

TEST_F(CliRenderShadows, DamagedLightsAreRefusedInOneLine) {
    ASSERT_EQ(render_dungeon({"--frame", path("f.exr")}, "a.png").code, 0);
    std::string bytes = content(path("f.exr"));
    const std::string name = "darkroom:light0.splits";
    ASSERT_NE(bytes.find(name), std::string::npos);
    bytes.replace(bytes.find(name), name.size(), "darkroom:light0.splitz");
    write("bad.exr", bytes);
    const std::string refusal = "bad.exr: darkroom:light0.splits is missing or damaged; it has 3 finite numbers";
    expect_refused({"develop", path("bad.exr"), "-o", path("x.png")}, 1, refusal);
    expect_refused({"plan", "--input", path("bad.exr")}, 1, refusal);
}

}  // namespace
}  // namespace darkroom
