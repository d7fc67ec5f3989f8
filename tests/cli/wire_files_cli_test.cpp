// SPDX-License-Identifier: MIT
// Pictures that wires and parameters name by their files: masks, second pictures, displacements.
#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliWireFiles : public test::CliFixture {
  protected:
    static constexpr std::uint32_t side = 32;
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(side, side);
        Picture half(side / 2, side / 2);
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x)
                for (std::uint32_t i = 0; i < 4; ++i)
                    frame.color.at(x, y)[i] = i == 3 ? 1.0f : static_cast<float>(x) / (side - 1);
        // Black, and on the right half the code 128, or 188 which is one half in linear light.
        for (std::uint32_t y = 0; y < side / 2; ++y)
            for (std::uint32_t x = 0; x < side / 2; ++x)
                for (std::uint32_t i = 0; i < 4; ++i)
                    half.at(x, y)[i] = i == 3 ? 1.0f : x < side / 4 ? 0.0f : 128 / 255.0f;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        ASSERT_TRUE(write_picture(path("half.png"), half));
        write("look.toml", "[[stack]]\neffect = \"negative\"\n");
    }
    [[nodiscard]] Picture developed(std::vector<std::string> flags, const std::string& look = "look.toml") const {
        std::vector<std::string> arguments{"develop", path("frame.exr"), "--look", path(look), "-o", path("out.exr")};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture("out.exr");
    }
    static constexpr std::uint32_t left = 3, right = side - 4;
    static float ramp(std::uint32_t x) { return static_cast<float>(x) / (side - 1); }
};

TEST_F(CliWireFiles, AMaskIsItsNumbers) {
    write("masked.toml", "[[stack]]\neffect = \"negative\"\nmask = \"half.png\"\n");
    for (const Picture& out :
         {developed({}, "masked.toml"), developed({"--set", "negative.mask=" + path("half.png")})}) {
        EXPECT_NEAR(out.at(left, 5)[0], ramp(left), 1e-3);
        EXPECT_NEAR(out.at(right, 5)[0], ramp(right) + (1 - 2 * ramp(right)) * 128 / 255, 1e-3);
    }
}

TEST_F(CliWireFiles, ASecondPictureIsSceneLinear) {
    write("over.toml", "[[stack]]\neffect = \"blend\"\nmode = \"add\"\namount = 1\nsecond = \"half.png\"\n");
    const Picture out = developed({}, "over.toml");
    EXPECT_NEAR(out.at(left, 5)[0], ramp(left), 1e-3);
    EXPECT_NEAR(out.at(right, 5)[0], ramp(right) + 0.21586, 1e-3);
}

TEST_F(CliWireFiles, APictureMovesTheOther) {
    write("moved.toml",
          "[[stack]]\neffect = \"perturb\"\nstrength = [0, 0, 1, 1]\nspeed = [0, 0]\n"
          "distortion = \"white.png\"\ndistortion_strength = 4\nreach = \"pixels\"\n");
    Picture white(2, 2);
    white.pixels.assign(white.pixels.size(), 1.0f);
    ASSERT_TRUE(write_picture(path("white.png"), white));
    const Picture out = developed({}, "moved.toml");
    EXPECT_NEAR(out.at(10, 9)[0], ramp(14), 2e-3);
}

TEST_F(CliWireFiles, ErrorsAreOneLine) {
    write("damaged.png", "\x89PNG\r\n\x1a\nno picture");
    for (const std::string name : {"none.png", "damaged.png", "look.toml"}) {
        write("wrong.toml", "[[stack]]\neffect = \"negative\"\nmask = \"" + name + "\"\n");
        const Outcome outcome =
            run({"develop", path("frame.exr"), "--look", path("wrong.toml"), "-o", path("never.exr")});
        EXPECT_EQ(outcome.code, 1);
        EXPECT_NE(outcome.err.find("wrong.toml:3:8: mask = \"" + name + "\": "), std::string::npos) << outcome.err;
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("never.exr")));
    }
}

}  // namespace
}  // namespace darkroom
