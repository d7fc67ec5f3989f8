// SPDX-License-Identifier: MIT
// What the hands of people who know other command lines type: the same outcome, whichever way they say it.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame_file.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliHabits : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(24, 16);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 40.0f;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        write("empty.scene.toml", "[scene]\nname = \"empty\"\n");
    }
    /// The bytes of the picture that these flags make of the frame.
    [[nodiscard]] std::string developed(std::vector<std::string> flags) const {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-o", path("out.png")});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return content(path("out.png"));
    }
};

TEST_F(CliHabits, AnOutputHasALongName) {
    for (const char* const name : {"-o", "--output", "--out"}) {
        const std::string file = path(fmt::format("{}.png", name)), cube = path(fmt::format("{}.cube", name));
        EXPECT_EQ(run({"develop", path("frame.exr"), name, file}).code, 0) << name;
        EXPECT_EQ(run({"render", path("empty.scene.toml"), "--size", "8x8", name, file}).code, 0) << name;
        EXPECT_EQ(run({"lut", "export", name, cube}).code, 0) << name;
        EXPECT_EQ(run({"lut", "convert", cube, name, path("b.cube")}).code, 0) << name;
    }
}

TEST_F(CliHabits, AFrameIsSavedUnderBothNames) {
    for (const char* const name : {"--save-frame", "--frame"}) {
        const std::string file = path(fmt::format("{}.exr", name));
        const Outcome outcome =
            run({"render", path("empty.scene.toml"), "--size", "8x8", "-o", path("a.png"), name, file});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_TRUE(read_frame(file)) << name;
    }
}

}  // namespace
}  // namespace darkroom
