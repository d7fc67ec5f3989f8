// SPDX-License-Identifier: MIT
// Frames of another size than their picture, captures of what temporal filters are given, and judgements of theirs.
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/lab_support.hpp"
#include "tests/cli_render/render_cli_support.hpp"

namespace darkroom {
namespace {

using nlohmann::json;
using test::content;
using test::Outcome;

class CliTemporal : public test::WithLab<test::CliRender> {
  protected:
    /// Two frames at two sizes, of the yard at 48x32.
    [[nodiscard]] Outcome capture(const std::string& folder, std::vector<std::string> flags = {}) const {
        flags.insert(flags.begin(),
                     {"capture", path("yard.scene.toml"), "-o", path(folder), "--size", "48x32", "--samples", "4",
                      "--frames", "5-7", "--scales", "1,1.5", "--shadow-resolution", "64"});
        return run(flags);
    }
    [[nodiscard]] json judged(const std::string& test, std::vector<std::string> flags = {}) const {
        flags.insert(flags.begin(), {"judge", "--truth", path("captured"), "--test", path(test), "--json"});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out, nullptr, false);
    }
    [[nodiscard]] std::vector<std::string> files_below(const std::string& folder) const {
        std::vector<std::string> out;
        for (const auto& file : std::filesystem::recursive_directory_iterator(path(folder)))
            if (file.is_regular_file())
                out.push_back(std::filesystem::relative(file.path(), path(folder)).generic_string());
        std::ranges::sort(out);
        return out;
    }
};

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
    expect_render_refused({"--render-scale", "0"}, "--render-scale = 0: allowed is [0.1, 1]");
    expect_render_refused({"--render-scale", "0.5", "--no-postprocess"},
                          "--render-scale: no effect runs that could enlarge the picture");
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
                   "--output-size: works without --keep-layers");
}

TEST_F(CliTemporal, SequencesOfLooksThatGatherFramesAreJittered) {
    const auto all = all_effects();
    const auto found =
        std::ranges::find_if(all, [](const EffectInfo* effect) { return effect->output_scale.is_of_output; });
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

TEST_F(CliTemporal, ACaptureIsInputsAndTruth) {
    const Outcome outcome = capture("captured", {"--truth-frames", "6-7"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(files_below("captured"),
              (std::vector<std::string>{"1.5x/input.0005.exr", "1.5x/input.0006.exr", "1.5x/input.0007.exr",
                                        "1x/input.0005.exr", "1x/input.0006.exr", "1x/input.0007.exr", "capture.json",
                                        "truth/truth.0006.exr", "truth/truth.0007.exr"}));
    const FrameFile input = frame("captured/1.5x/input.0006.exr"), truth = frame("captured/truth/truth.0006.exr");
    EXPECT_EQ(input.color.width, 32U);
    EXPECT_EQ(input.color.height, 21U);
    EXPECT_EQ(truth.color.width, 48U);
    EXPECT_EQ(input.camera.jitter, Composer::jitter(6, 32.0F / 21));
    EXPECT_EQ(input.camera.previous_jitter, Composer::jitter(5, 32.0F / 21));
    EXPECT_FALSE(truth.camera.jitter);
    EXPECT_EQ(input.time, 6 / 24.0);
    EXPECT_EQ(input.frame_index, 6U);
    EXPECT_EQ(input.exposure, 1.0F);
    ASSERT_TRUE(input.reactive && input.transparency && input.depth && input.velocity);
    EXPECT_GT(*std::ranges::max_element(input.reactive->values), 0.85F) << "sparks";
    EXPECT_EQ(*std::ranges::min_element(input.reactive->values), 0);
    const json found = json::parse(content(path("captured/capture.json")), nullptr, false);
    EXPECT_EQ(found.at("scene"), "yard.scene.toml");
    EXPECT_EQ(found.at("frames"), "5-7");
    EXPECT_EQ(found.at("inputs").at(1).at("size"), json({32, 21}));
    EXPECT_EQ(found.at("truth"),
              json({{"files", "truth/truth.####.exr"}, {"frames", "6-7"}, {"samples", 4}, {"mean", "tone_mapped"}}));
}

TEST_F(CliTemporal, TheSameCaptureIsTheSameBytes) {
    ASSERT_EQ(capture("a").code, 0);
    ASSERT_EQ(capture("b").code, 0);
    ASSERT_EQ(files_below("a"), files_below("b"));
    for (const std::string& file : files_below("a"))
        EXPECT_EQ(content(path("a/" + file)), content(path("b/" + file))) << file;
    ASSERT_EQ(capture("b", {"--mean", "linear", "--fps", "12"}).code, 0);
    EXPECT_NE(content(path("a/truth/truth.0006.exr")), content(path("b/truth/truth.0006.exr")));
    EXPECT_EQ(json::parse(content(path("b/capture.json"))).at("truth").at("mean"), "linear");
}

TEST_F(CliTemporal, ACaptureThatCannotBeIsRefused) {
    const std::vector<std::string> base{"capture", path("yard.scene.toml"), "-o", path("c"), "--frames", "5-7"};
    for (const auto& [flags, part] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--scales", "1,0.5"}, "--scales 1,0.5: allowed are 1 to 8 numbers in [1, 10], each once"},
             {{"--scales", "2,2"}, "--scales 2,2: allowed"},
             {{"--samples", "1"}, "--samples = 1: allowed is [2, 1024]"},
             {{"--mean", "rms"}, "--mean rms: allowed is tone-mapped or linear"},
             {{"--truth-frames", "4-6"}, "--truth-frames 4-6: are not all among --frames 5-7"},
             {{"--msaa", "4"}, "colour before transparency: with 4 samples"}}) {
        std::vector<std::string> all = base;
        all.insert(all.end(), flags.begin(), flags.end());
        expect_refused(all, 1, part);
    }
    expect_refused({"capture", path("yard.scene.toml"), "-o", path("c"), "--frames", "-2-1"}, 1,
                   "a scene begins at frame 0");
    expect_refused({"capture", path("none.toml"), "-o", path("c"), "--frames", "1"}, 1, "none.toml");
}

TEST_F(CliTemporal, AJudgementHoldsPicturesAgainstTheTruth) {
    ASSERT_EQ(capture("captured").code, 0);
    const json perfect = judged("captured/truth");
    EXPECT_EQ(perfect.at("psnr"), "inf");
    EXPECT_EQ(perfect.at("flicker"), "inf");
    EXPECT_EQ(perfect.at("flip_mean"), 0.0);
    EXPECT_EQ(perfect.at("frames").size(), 3U);
    const json rough = judged("captured/1x", {"-o", path("page"), "--frames", "6-7"});
    EXPECT_GT(rough.at("psnr").get<double>(), 15);
    EXPECT_LT(rough.at("psnr").get<double>(), 60);
    EXPECT_LT(rough.at("regions").at("edges").at("psnr").get<double>(), rough.at("psnr").get<double>());
    EXPECT_EQ(rough.at("recovery").size(), 8U);
    EXPECT_EQ(rough.at("frames").size(), 2U);
    EXPECT_TRUE(rough.at("edge").is_null());
    EXPECT_EQ(files_below("page"),
              (std::vector<std::string>{"error.0006.png", "error.0007.png", "index.html", "judge.json", "test.0006.png",
                                        "test.0007.png", "truth.0006.png", "truth.0007.png"}));
    EXPECT_EQ(json::parse(content(path("page/judge.json")), nullptr, false), rough);
    // What a page shows can be judged as well: codes are codes.
    std::filesystem::create_directory(path("codes"));
    for (const char* const number : {"0006", "0007"})
        std::filesystem::copy(path(std::string("page/test.") + number + ".png"),
                              path(std::string("codes/") + number + ".png"));
    EXPECT_EQ(judged("codes", {"--frames", "6-7"}).at("psnr"), rough.at("psnr"));
    const Outcome text = run({"judge", "--truth", path("captured"), "--test", path("captured/1x")});
    EXPECT_NE(text.out.find("PSNR dB"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("disoccluded"), std::string::npos) << text.out;
}

TEST_F(CliTemporal, AJudgementThatCannotBeIsRefused) {
    ASSERT_EQ(capture("captured").code, 0);
    std::filesystem::create_directory(path("empty"));
    const auto judge = [&](const std::string& truth, const std::string& test, std::vector<std::string> flags = {}) {
        flags.insert(flags.begin(), {"judge", "--truth", path(truth), "--test", path(test)});
        return flags;
    };
    expect_refused(judge("empty", "captured/1x"), 1, "capture.json");
    expect_refused(judge("captured", "empty"), 1, "has no picture of frame 5, which the truth has");
    expect_refused(judge("captured", "captured/1.5x"), 1, "is 32x21, its truth is 48x32");
    expect_refused(judge("captured", "none"), 1, "none: cannot list the folder");
    expect_refused(judge("captured", "captured/1x", {"--frames", "9"}), 1, "--frames 9: the truth has none of them");
    expect_refused(judge("captured", "captured/1x", {"--edge", "9"}), 1, "--edge 9: expected X,Y,WIDTHxHEIGHT");
    expect_refused(judge("captured", "captured/1x", {"--edge", "40,0,16x16"}), 1,
                   "reaches beyond the picture of 48x32");
    write("captured/capture.json", "{\"format\": 1, \"truth\": {\"files\": \"../x.####.exr\", \"frames\": \"5\"}}");
    expect_refused(judge("captured", "captured/1x"), 1, "allowed is a name within the folder");
    write("captured/capture.json", "[]");
    expect_refused(judge("captured", "captured/1x"), 1, "is not a description of a capture");
}

}  // namespace
}  // namespace darkroom
