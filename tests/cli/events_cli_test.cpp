// SPDX-License-Identifier: MIT
// Timelines on the command line: what a file of events does to a sequence.

#include <fmt/format.h>

#include <darkroom/effects.hpp>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliEvents : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "vignette", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(8, 6);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = i % 4 == 3 ? 1.0f : 0.125f;
        for (int i = 0; i < 13; ++i) ASSERT_TRUE(write_frame(path(fmt::format("in.{:04}.exr", i)), frame));
        write("look.toml",
              "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"vignette\"\nenabled = false\n"
              "[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\namount = 1\nduration = 0.5\n"
              "[[layer]]\nname = \"night\"\nvalues = { exposure = 0.5 }\n");
        write("events.toml",
              "[[event]]\ntime = 0.2\nfire = \"hit\"\n"
              "[[event]]\ntime = 0.6\nset = { \"exposure.exposure\" = \"2ev\" }\n"
              "[[event]]\ntime = 0.8\nlayer = { night = 1 }\nover = 0.4\n"
              "[[event]]\ntime = 0.9\nset = { exposure = 2, \"vignette.intensity\" = 1 }\n");
    }
    /// Ten frames a second into a folder; of the frames that are asked for, what became of 0.125 in the middle.
    [[nodiscard]] std::vector<double> develop(const std::string& folder, const std::string& range,
                                              const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"develop",  path("in.####.exr"),
                                           "-o",       path(folder + "/out.####.exr"),
                                           "--look",   path("look.toml"),
                                           "--events", path("events.toml"),
                                           "--fps",    "10",
                                           "--bits",   "float"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (!range.empty()) arguments.insert(arguments.end(), {"--frames", range});
        std::filesystem::create_directory(path(folder));
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        std::vector<double> out;
        for (int i = 0; i < 13; ++i) {
            const std::string name = fmt::format("{}/out.{:04}.exr", folder, i);
            if (!std::filesystem::exists(path(name))) continue;
            const Picture made = picture(name);
            EXPECT_FALSE(made.empty());
            if (!made.empty()) out.push_back(made.at(4, 3)[1] / 0.125);
        }
        return out;
    }
};

TEST_F(CliEvents, SetFireAndBlendAtTheirTimes) {
    const std::vector<double> seen = develop("all", "");
    ASSERT_EQ(seen.size(), 13u);
    const auto pulse = [](double time) { return std::max(0.0, 1 - (time - 0.2) / 0.5); };
    for (int i = 0; i < 13; ++i) {
        const double time = i / 10.0;
        // What the timeline sets replaces what the pulse and the layer made of the base.
        const double expected = i < 2 ? 1 : i < 6 ? 1 + pulse(time) : i < 9 ? 4 : 2;
        EXPECT_NEAR(seen[static_cast<std::size_t>(i)], expected, i < 9 ? 2e-3 : 0.1) << i;
    }
}

TEST_F(CliEvents, ALayerGoesToItsWeightInItsTime) {
    write("events.toml",
          "[[event]]\ntime = 0.2\nlayer = { night = 1 }\nover = 0.4\n[[event]]\ntime = 0.5\nlayer = { night = 0 }\n"
          "over = 0.2\n[[event]]\ntime = 1\nlayer = { night = 0.5 }\n");
    const std::vector<double> seen = develop("layers", "");
    constexpr std::array weights{0.0, 0.0, 0.0, 0.25, 0.5, 0.75, 0.375, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5};
    ASSERT_EQ(seen.size(), weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(seen[i], 1 - 0.5 * weights[i], 1e-3) << i;
}

TEST_F(CliEvents, APieceIsTheWhole) {
    const std::vector<double> all = develop("whole", ""), piece = develop("piece", "4-11"),
                              exact = develop("exact", "", {"--reference"});
    ASSERT_EQ(all.size(), 13u);
    ASSERT_EQ(piece.size(), 8u);
    ASSERT_EQ(exact.size(), 13u);
    for (std::size_t i = 0; i < piece.size(); ++i) EXPECT_EQ(piece[i], all[i + 4]) << i;
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(exact[i], all[i], 2e-3) << i;
}

// A trail that an event switches on needs frames before those that are asked for.
TEST_F(CliEvents, WhatEventsSwitchOnIsGivenItsHistory) {
    if (find_effect("recursive_blend") == nullptr) GTEST_SKIP() << "the effect recursive_blend is not in this build";
    write("look.toml",
          "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"recursive_blend\"\nweight = 0.9\nenabled = false\n");
    write("events.toml",
          "[[event]]\ntime = 0.3\nset = { \"recursive_blend.enabled\" = true }\n[[event]]\ntime = 0.6\n"
          "set = { exposure = 4 }\n");
    const std::vector<double> all = develop("whole", ""), piece = develop("piece", "6-8");
    ASSERT_EQ(all.size(), 13u);
    ASSERT_EQ(piece.size(), 3u);
    EXPECT_LT(all[6], 3) << "a trail";
    for (std::size_t i = 0; i < piece.size(); ++i) EXPECT_NEAR(piece[i], all[i + 6], 2e-3) << i;
}

// What a flat table has off, or on without an effect, is there to be moved all the same.
TEST_F(CliEvents, FlatTablesKeepWhatMoves) {
    write("look.toml",
          "[post_process]\nbloom_enabled = false\nssao_enabled = false\ntonemap_curve = \"linear\"\n"
          "vignette_enabled = false\n[[pulse]]\nevent = \"hit\"\nparameter = \"exposure\"\namount = 1\n"
          "duration = 0.5\n[[layer]]\nname = \"night\"\nvalues = { vignette_intensity = 1 }\n");
    write(
        "events.toml",
        "[[event]]\ntime = 0.2\nfire = \"hit\"\n[[event]]\ntime = 0.8\nset = { fog_enabled = false, exposure = 4 }\n");
    const std::vector<double> all = develop("all", "");
    ASSERT_EQ(all.size(), 13u);
    EXPECT_NEAR(all[2] / all[0], 2, 0.01);
    EXPECT_NEAR(all[9] / all[0], 4, 0.02);
    write("events.toml", "[[event]]\ntime = 0\nlayer = { night = 1 }\n");
    EXPECT_LT(develop("night", "1").at(0), 0.99 * all[0]) << "the middle of so small a picture is near its corners";
    // Without a timeline a layer's own weight counts.
    write("look.toml", test::content(path("look.toml")) + "weight = 1\n");
    const Outcome outcome =
        run({"develop", path("in.0000.exr"), "-o", path("alone.exr"), "--look", path("look.toml"), "--bits", "float"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Picture alone = picture("alone.exr");
    ASSERT_FALSE(alone.empty());
    EXPECT_LT(alone.at(4, 3)[1] / 0.125, 0.99 * all[0]);
}

TEST_F(CliEvents, TimeMayGoBack) {
    const std::vector<double> all = develop("all", "");
    write("events.toml", test::content(path("events.toml")) +
                             "[[event]]\ntime = 1\nset = { \"exposure.enabled\" = false }\nlayer = { night = 0.5 }\n");
    std::filesystem::create_directory(path("back"));
    const Outcome outcome =
        run({"develop", path("in.0012.exr"), path("in.0004.exr"), path("in.0001.exr"), "-o", path("back/out.####.exr"),
             "--look", path("look.toml"), "--events", path("events.toml"), "--fps", "10", "--bits", "float"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const std::size_t i : {1u, 4u}) {
        const Picture made = picture(fmt::format("back/out.{:04}.exr", i));
        ASSERT_FALSE(made.empty());
        EXPECT_EQ(made.at(4, 3)[1] / 0.125, all.at(i)) << i;
    }
}

TEST_F(CliEvents, RenderHasThemToo) {
    write("empty.scene.toml", "[scene]\nname = \"Nothing\"\n[[stack]]\neffect = \"exposure\"\n");
    write("events.toml", "[[event]]\ntime = 0.2\nset = { exposure = 4 }\n");
    const Outcome outcome =
        run({"render", path("empty.scene.toml"), "--size", "16x16", "--fps", "10", "--frames", "1-2", "--events",
             path("events.toml"), "-o", path("shot.####.exr"), "--bits", "float"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Picture before = picture("shot.0001.exr"), after = picture("shot.0002.exr");
    ASSERT_EQ(before.pixels.size(), after.pixels.size());
    ASSERT_GT(before.at(8, 2)[2], 0.001f);
    EXPECT_NEAR(after.at(8, 2)[2] / before.at(8, 2)[2], 4, 0.01);
}

TEST_F(CliEvents, SlipsAreOneLineWithTheirPlace) {
    const auto refused = [&](const std::string& text, const std::string& expected) {
        write("wrong.toml", text);
        expect_refused({"develop", path("in.0000.exr"), "-o", path("out.png"), "--look", path("look.toml"), "--events",
                        path("wrong.toml")},
                       1, expected);
    };
    const std::string event = "[[event]]\ntime = 1\n";
    refused("", "wrong.toml: expected [[event]] entries");
    refused("[[events]]\ntime = 1\n", "wrong.toml:1:3: unknown key 'events'");
    refused("[[event]]\nfire = \"hit\"\n", "wrong.toml:1:1: an event has no key 'time'");
    refused(event, "wrong.toml:1:1: the event does nothing");
    refused("[[event]]\ntime = -1\nfire = \"hit\"\n", "wrong.toml:2:8: time = -1");
    refused(event + "leap = 3\n", "wrong.toml:3:1: unknown key 'leap': allowed are time, set, fire, layer, over");
    refused(event + "fire = \"hti\"\n", "did you mean 'hit'? known are hit");
    refused(event + "set = { exposur = 1 }\n", "wrong.toml:3:19: exposur: no effect has this parameter");
    refused(event + "set = { exposure = 5000 }\n", "wrong.toml:3:20: exposure = 5000: ");
    refused(event + "set = { exposure = \"2eV!\" }\n", "exposure = \"2eV!\": '2eV!' is not a number, allowed is");
    refused(event + "set = { \"exposure.scale\" = 2 }\n", "it is fixed when the stack is compiled");
    refused(event + "layer = { nigth = 1 }\n", "did you mean 'night'? known are night");
    refused(event + "layer = { night = 2 }\n", "night = 2");
    refused(event + "set = 3\n", "set = 3: expected a table of values");
    refused("[[event]\n", "wrong.toml:1:");
    expect_refused({"develop", path("in.0000.exr"), "-o", path("out.png"), "--events", path("none.toml")}, 1,
                   "none.toml");
}

}  // namespace
}  // namespace darkroom
