// SPDX-License-Identifier: MIT
// The interface on the command line and in looks.
#include "cli_support.hpp"
#include "image/frame_file.hpp"
#include "image/write.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliUi : public test::CliFixture {
  protected:
    static constexpr std::uint32_t width = 48, height = 32;
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(width, height);
        frame.color.pixels.assign(frame.color.pixels.size(), 0.2f);
        for (std::size_t i = 3; i < frame.color.pixels.size(); i += 4) frame.color.pixels[i] = 1;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        // The left half opaque, then a half-transparent column; straight alpha, as PNG has it.
        Picture hud(width, height);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const float alpha = x < width / 2 ? 1.0f : x < width / 2 + 8 ? 128 / 255.0f : 0.0f;
                const std::array<float, 4> texel{200 / 255.0f, static_cast<float>(y) / 255.0f, 16 / 255.0f, alpha};
                std::ranges::copy(texel, hud.at(x, y));
            }
        ASSERT_TRUE(write_picture(path("hud.png"), hud, {.alpha = true}));
        write("plain.toml", "[[stack]]\neffect = \"encode\"\n");
        write("ui.toml", "[[stack]]\neffect = \"encode\"\n[ui]\ndocument = \"hud.png\"\n");
    }
    [[nodiscard]] Picture developed(std::vector<std::string> flags) const {
        std::vector<std::string> arguments{"develop", path("frame.exr"), "-o", path("out.png")};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return picture("out.png");
    }
    static int code(float value) { return static_cast<int>(std::lround(value * 255)); }
};

TEST_F(CliUi, AnInterfaceIsAnImageOfTheLookOrOfTheFlag) {
    const Picture plain = developed({"--look", path("plain.toml")}), look = developed({"--look", path("ui.toml")});
    EXPECT_EQ(developed({"--look", path("plain.toml"), "--ui", path("hud.png")}).pixels, look.pixels);
    for (std::uint32_t y = 0; y < height; ++y) {
        EXPECT_EQ(code(look.at(3, y)[0]), 200);
        EXPECT_EQ(code(look.at(3, y)[1]), static_cast<int>(y));
        EXPECT_EQ(look.at(width - 2, y)[0], plain.at(width - 2, y)[0]);
        const double under = plain.at(width / 2 + 4, y)[0] * (1 - 128 / 255.0);
        EXPECT_NEAR(look.at(width / 2 + 4, y)[0], under + 100 / 255.0, 1.01 / 255);
    }
    // The flat table has it, too, and the references agree.
    const Picture flat =
        developed({"--ui", path("hud.png"), "--ui-echo-strength", "0.3", "--ui-warp-strength", "-0.2"});
    const Picture reference =
        developed({"--ui", path("hud.png"), "--ui-echo-strength", "0.3", "--ui-warp-strength", "-0.2", "--reference"});
    double worst = 0;
    for (std::size_t i = 0; i < flat.pixels.size(); ++i)
        worst = std::max(worst, double{std::abs(flat.pixels[i] - reference.pixels[i])});
    EXPECT_LE(worst, 1.01 / 255);
    EXPECT_GT(code(flat.at(3, 5)[0]), code(look.at(3, 5)[0])) << "the echo adds to it";
}

TEST_F(CliUi, TheTableHasTheChainsParameters) {
    write("table.toml",
          "[[stack]]\neffect = \"encode\"\n[ui]\ndocument = \"hud.png\"\nui_composite_additive = 1\n"
          "contrast_gamma_contrast = 1.5\n");
    const Picture out = developed({"--look", path("table.toml")}), plain = developed({"--look", path("plain.toml")});
    EXPECT_NEAR(out.at(width - 2, 3)[0], std::min(1.0f, plain.at(width - 2, 3)[0] * 1.5f), 1.6 / 255);
    EXPECT_NEAR(out.at(3, 3)[2], 1.5 * (plain.at(3, 3)[2] + 0.7 * 16 / 255), 1.6 / 255);
    const Outcome info = run({"info", path("table.toml")});
    EXPECT_EQ(info.code, 0) << info.err;
    write("slip.toml", "[ui]\nui_wrap_strength = 1\n");
    const Outcome slip = run({"develop", path("frame.exr"), "--look", path("slip.toml"), "-o", path("never.png")});
    EXPECT_NE(slip.err.find("slip.toml:2:1: unknown key 'ui_wrap_strength' = 1, did you mean 'ui_warp_strength'"),
              std::string::npos)
        << slip.err;
}

TEST_F(CliUi, ErrorsAreOneLine) {
    for (const std::string name : {"none.png", "plain.toml", "frame.exr"}) {
        const Outcome outcome = run({"develop", path("frame.exr"), "--ui", path(name), "-o", path("never.png")});
        EXPECT_EQ(outcome.code, 1) << name;
        EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
        EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("never.png")));
    }
}

}  // namespace
}  // namespace darkroom
