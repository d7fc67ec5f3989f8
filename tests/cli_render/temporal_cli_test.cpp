// SPDX-License-Identifier: MIT
// Frames of another size than their picture.
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>

#include "tests/cli_render/render_cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliTemporal : public test::CliRender {};

TEST_F(CliTemporal, ARenderScaleDrawsFewerLinesOfThePicture) {
    ASSERT_EQ(render({}, "whole.png").code, 0);
    const Outcome outcome = render({"--render-scale", "0.5", "--save-frame", path("half.exr")}, "half.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(frame("half.exr").color.width, 24U);
    EXPECT_EQ(frame("half.exr").color.height, 16U);
    EXPECT_FALSE(frame("half.exr").camera.jitter) << "nothing gathers frames";
    const Picture whole = picture("whole.png"), half = picture("half.png");
    ASSERT_EQ(half.width, 48U);
    ASSERT_EQ(half.height, 32U);
    double apart = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) apart += std::abs(whole.pixels[i] - half.pixels[i]);
    apart /= static_cast<double>(whole.pixels.size());
    EXPECT_GT(apart, 1e-3);
    EXPECT_LT(apart, 0.1);
    ASSERT_EQ(render({"--render-scale", "1"}, "again.png").code, 0);
    EXPECT_EQ(content(path("again.png")), content(path("whole.png")));
    ASSERT_EQ(render({"--render-scale", "0.1", "--size", "7x3"}, "tiny.png").code, 0);
    EXPECT_EQ(picture("tiny.png").width, 7U);
    expect_render_refused({"--render-scale", "0"}, "--render-scale 0: [0.1, 1] is allowed");
    expect_render_refused({"--render-scale", "0.5", "--no-postprocess"}, "--render-scale: nothing is post-processed");
}

TEST_F(CliTemporal, StoredFramesAreDevelopedIntoLargerPictures) {
    ASSERT_EQ(render({"--size", "24x16", "--save-frame", path("half.exr")}).code, 0);
    const auto develop = [&](std::vector<std::string> flags, const std::string& out) {
        flags.insert(flags.begin(), {"develop", path("half.exr"), "-o", path(out)});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture(out);
    };
    const Picture large = develop({"--output-size", "49x33"}, "large.png");
    EXPECT_EQ(large.width, 49U);
    EXPECT_EQ(large.height, 33U);
    const Picture reference = develop({"--output-size", "49x33", "--reference"}, "reference.png");
    double worst = 0;
    for (std::size_t i = 0; i < large.pixels.size(); ++i)
        worst = std::max(worst, double(std::abs(large.pixels[i] - reference.pixels[i])));
    EXPECT_LT(worst, 4.0 / 255);
    expect_refused({"develop", path("half.exr"), "--output-size", "0x2", "-o", path("x.png")}, 1,
                   "--output-size 0x2: expected WIDTHxHEIGHT");
    expect_refused({"develop", path("half.exr"), "--output-size", "9x9", "--keep-layers", "-o", path("x.exr")}, 1,
                   "--output-size: --keep-layers keeps");
}

TEST_F(CliTemporal, SequencesOfLooksThatGatherFramesAreJittered) {
    const auto all = all_effects();
    const auto found = std::ranges::find_if(all, [](const EffectInfo* effect) { return effect->makes_output; });
    if (found == all.end()) GTEST_SKIP() << "this build has no effect that makes the output";
    const std::string name((*found)->name);
    write("gathers.toml", "format = 1\n[[stack]]\neffect = \"" + name + "\"\n");
    const Outcome outcome = render({"--look", path("gathers.toml"), "--frames", "3-4", "--render-scale", "0.5",
                                    "--save-frame", path("f.####.exr")},
                                   "p.####.png");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(frame("f.0004.exr").camera.jitter, Composer::jitter(4, 2));
    EXPECT_EQ(frame("f.0004.exr").camera.previous_jitter, Composer::jitter(3, 2));
    EXPECT_EQ(picture("p.0004.png").width, 48U);
    // A picture by itself has all its places at once.
    ASSERT_EQ(render({"--look", path("gathers.toml"), "--save-frame", path("one.exr")}).code, 0);
    EXPECT_FALSE(frame("one.exr").camera.jitter);
}

}  // namespace
}  // namespace darkroom
