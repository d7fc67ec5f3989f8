// SPDX-License-Identifier: MIT
// The interface on the command line and in looks.
#include "cli_support.hpp"
#include "core/srgb.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"

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

// The game says that there is little health, the controller fires, and the pulse doubles the light.
TEST_F(CliUi, EventsControllersAndPulsesMeet) {
    write("c.lua", "engine.on_frame('low', function() if game.health < 50 then engine.fire('hit') end end)\n");
    write("game.toml",
          "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"encode\"\n"
          "[[pulse]]\nevent = \"hit\"\nparameter = \"exposure.exposure\"\namount = 1\nduration = 1\n"
          "[ui]\ncontrollers = [\"c.lua\"]\ngame = { health = 100 }\n");
    write("events.toml", "[[event]]\ntime = 2\ngame = { health = 20 }\n");
    const auto at = [&](const std::string& time) {
        return developed({"--look", path("game.toml"), "--events", path("events.toml"), "--time", time}).at(9, 9)[0];
    };
    const auto encoded = [](double light) { return 1.055 * std::pow(light, 1 / 2.4) - 0.055; };
    EXPECT_NEAR(at("1"), encoded(0.2), 1.01 / 255);
    EXPECT_NEAR(at("2"), encoded(0.4), 1.01 / 255);
    write("c.lua", "engine.on_frame('low', function() error('no such luck') end)\n");
    const Outcome outcome = run({"develop", path("frame.exr"), "--look", path("game.toml"), "-o", path("out.png")});
    EXPECT_EQ(outcome.code, 0) << "a script's fault is told, and the picture made";
    EXPECT_NE(outcome.err.find("no such luck"), std::string::npos) << outcome.err;
    write("c.lua", "this is no Lua\n");
    EXPECT_EQ(run({"develop", path("frame.exr"), "--look", path("game.toml"), "-o", path("never.png")}).code, 1);
}

// A script that counts frames: whatever is asked for, frame n is the n-th that it sees.
TEST_F(CliUi, ControllersSeeTheFramesBeforeThatMakeNoPicture) {
    write("count.lua",
          "local n = 0\n"
          "engine.on_frame('count', function() n = n + 1 engine.cvar_set('exposure.exposure', n / 4) end)\n");
    write("count.toml",
          "[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"encode\"\n[ui]\ncontrollers = [\"count.lua\"]\n");
    for (int i = 0; i < 6; ++i) {
        FrameFile frame;
        frame.color = Picture(width, height);
        frame.color.pixels.assign(frame.color.pixels.size(), 0.1f);
        frame.time = i;
        ASSERT_TRUE(write_frame(path("in." + std::to_string(i) + ".exr"), frame));
    }
    const auto codes = [&](const std::string& out, const std::vector<std::string>& flags) {
        std::vector<std::string> words{"develop", path("in.%d.exr"),    "--look", path("count.toml"),
                                       "-o",      path(out + ".%d.png")};
        words.insert(words.end(), flags.begin(), flags.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        std::vector<int> all;
        for (int i = 0; i < 6; ++i) {
            const std::string name = out + "." + std::to_string(i) + ".png";
            all.push_back(std::filesystem::exists(path(name)) ? code(picture(name).at(9, 9)[0]) : -1);
        }
        return all;
    };
    const std::vector<int> whole = codes("whole", {});
    ASSERT_LT(whole[4], whole[5]);
    EXPECT_EQ(codes("last", {"--frames", "5"}), (std::vector{-1, -1, -1, -1, -1, whole[5]}));
    EXPECT_EQ(codes("last", {"--frames", "5", "--fps", "24"})[5], whole[5]) << "times of names";
    EXPECT_EQ(codes("some", {"--frames", "1,4"}), (std::vector{-1, whole[1], -1, -1, whole[4], -1})) << "a gap";
    EXPECT_EQ(codes("some", {"--skip-existing"}), whole);

    const std::string counting = test::content(path("count.lua"));
    write("count.lua", counting + "engine.pre_roll(2)\n");
    EXPECT_EQ(codes("two", {"--frames", "5"})[5], whole[2]) << "the two seconds before it";
    write("count.lua", counting + "engine.pre_roll(-1)\n");
    const Outcome outcome = run({"develop", path("frame.exr"), "--look", path("count.toml"), "-o", path("never.png")});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("[0, 86400] seconds are allowed"), std::string::npos) << outcome.err;
}

TEST_F(CliUi, DocumentsShowWhatTheGameSays) {
    write("hud.svg",
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100%\" height=\"100%\" viewBox=\"0 0 48 32\">"
          "<rect width=\"{{width}}\" height=\"32\" fill=\"#00ff00\"/></svg>");
    write("svg.toml", "[[stack]]\neffect = \"encode\"\n[ui]\ndocument = \"hud.svg\"\ngame = { width = 12 }\n");
    write("events.toml", "[[event]]\ntime = 1\njump = true\ngame = { width = 36 }\n");
    const auto green = [&](const std::vector<std::string>& more, std::uint32_t x) {
        std::vector<std::string> flags{"--look", path("svg.toml")};
        flags.insert(flags.end(), more.begin(), more.end());
        return code(developed(flags).at(x, 9)[1]) == 255;
    };
    EXPECT_TRUE(green({}, 6));
    EXPECT_FALSE(green({}, 20));
    EXPECT_TRUE(green({"--game", "width=24"}, 20));
    EXPECT_TRUE(green({"--events", path("events.toml"), "--time", "1"}, 30));
    const Outcome none = run(
        {"develop", path("frame.exr"), "--look", path("plain.toml"), "--ui", path("hud.svg"), "-o", path("never.png")});
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("hud.svg:1: "), std::string::npos) << none.err;
}

// Opaque pixels keep their codes behind a dither of either kind of look, and where post-processing is off.
TEST_F(CliUi, OpaquePixelsKeepTheirCodes) {
    write("dithered.toml", "[[stack]]\neffect = \"encode\"\n[[stack]]\neffect = \"dither\"\nintensity = 0.03\n");
    const auto expect_codes = [&](const Picture& with, const std::string& what) {
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width / 2 - 1; ++x) {
                EXPECT_EQ(code(with.at(x, y)[0]), 200) << what;
                EXPECT_EQ(code(with.at(x, y)[1]), static_cast<int>(y)) << what;
                EXPECT_EQ(code(with.at(x, y)[2]), 16) << what;
            }
    };
    const std::vector<std::string> ui{"--ui", path("hud.png")}, off{"--ui", path("hud.png"), "--no-postprocess"};
    for (const std::string order : {"documented", "scene_linear"}) {
        std::vector<std::string> flags = ui;
        flags.insert(flags.end(), {"--order", order, "--dither-intensity", "0.03"});
        expect_codes(developed(flags), order);
    }
    expect_codes(developed({"--ui", path("hud.png"), "--look", path("dithered.toml")}), "a stack");
    expect_codes(developed(off), "no post-processing");

    // A scene's own curves stay behind it.
    std::vector<std::string> plain{"render", std::string(test::source_folder) + "/scenes/courtyard.scene.toml",
                                   "--size", "48x32",
                                   "-o",     path("scene.png")};
    plain.emplace_back("--no-postprocess");
    ASSERT_EQ(run(plain).code, 0);
    const Picture without = picture("scene.png");
    plain.insert(plain.end(), {"--ui", path("hud.png")});
    const Outcome outcome = run(plain);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Picture with = picture("scene.png");
    expect_codes(with, "a scene without post-processing");
    for (std::uint32_t y = 0; y < height; ++y)
        EXPECT_NEAR(with.at(width - 3, y)[0], without.at(width - 3, y)[0], 40 / 255.0) << "another sampling of edges";
}

TEST_F(CliUi, ADocumentBringsItsControllers) {
    std::filesystem::create_directory(path("hud"));
    const auto bends = [](const std::string& slot, const std::string& value) {
        return "engine.pre_roll(0)\nengine.on_frame('" + slot + "', function() engine.cvar_set('r_ui_warp', " + value +
               ") end)\n";
    };
    const auto document = [&](const std::string& script) {
        write("hud/hud.svg",
              "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100%\" height=\"100%\" viewBox=\"0 0 48 32\">" +
                  script + "<rect width=\"12\" height=\"32\" fill=\"#00ff00\"/></svg>");
    };
    write("hud/bend.lua", bends("bend", "-0.3"));
    write("bend.lua", bends("bend", "-0.3"));
    const std::vector<std::string> flags{"--look", path("plain.toml"), "--ui", path("hud/hud.svg")};
    document("");
    const std::vector<float> straight = developed(flags).pixels;
    write("look.toml",
          "[[stack]]\neffect = \"encode\"\n[ui]\ndocument = \"hud/hud.svg\"\ncontrollers = [\"bend.lua\"]\n");
    const std::vector<float> bent = developed({"--look", path("look.toml")}).pixels;
    EXPECT_NE(bent, straight);
    for (const std::string attribute : {"src", "href"}) {
        document("<script " + attribute + "=\"bend.lua\"/>");
        EXPECT_EQ(developed(flags).pixels, bent) << attribute;
    }
    document("<script src=\"none.lua\"/>");
    std::vector<std::string> arguments{"develop", path("frame.exr"), "-o", path("never.png")};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    expect_refused(arguments, 1, "none.lua");
}

TEST_F(CliUi, ControllersSetClassesOfTheDocument) {
    write("hud.svg",
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100%\" height=\"100%\" viewBox=\"0 0 48 32\">"
          "<style>.low { fill: #ff0000; }</style><script src=\"low.lua\"/>"
          "<rect id=\"bar\" width=\"48\" height=\"32\" fill=\"#00ff00\"/></svg>");
    write("low.lua",
          "engine.pre_roll(0)\nengine.on_frame('low', function() engine.set_class('bar', 'low', game.health < 25) "
          "end)\n");
    const auto red = [&](const std::string& health) {
        return code(developed({"--look", path("plain.toml"), "--ui", path("hud.svg"), "--game", "health=" + health})
                        .at(5, 5)[0]);
    };
    EXPECT_EQ(red("80"), 0);
    EXPECT_EQ(red("20"), 255);
}

TEST_F(CliUi, ControllersMoveWhatIsAtRest) {
    write("bend.lua",
          "engine.pre_roll(0)\nengine.on_frame('bend', function() engine.cvar_set('r_ui_warp', -0.3) end)\n");
    const std::string ui = "[ui]\ndocument = \"hud.png\"\n";
    write("none.toml", ui);
    write("left_out.toml", ui + "controllers = [\"bend.lua\"]\n");
    write("zero.toml", ui + "controllers = [\"bend.lua\"]\nui_warp_strength = 0\n");
    write("bent.toml", ui + "ui_warp_strength = -0.3\n");
    const std::vector<float> bent = developed({"--look", path("bent.toml")}).pixels;
    EXPECT_NE(developed({"--look", path("none.toml")}).pixels, bent);
    for (const std::string look : {"left_out.toml", "zero.toml"})
        EXPECT_EQ(developed({"--look", path(look)}).pixels, bent) << look;
    EXPECT_EQ(developed({"--look", path("left_out.toml"), "--ui-warp-strength", "0"}).pixels, bent) << "a flag";
}

// 55.6 ms after a jump the interface is read 0.0041 of the height further up, which is nothing a second later.
TEST_F(CliUi, AJumpMovesTheInterface) {
    write("events.toml", "[[event]]\ntime = 1\njump = true\n");
    Picture step(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            std::ranges::copy(std::array{0.0f, y < height / 2 ? 0.0f : 1.0f, 0.0f, 1.0f}, step.at(x, y));
    ASSERT_TRUE(write_picture(path("hud.png"), step, {.alpha = true}));
    const auto at = [&](const std::string& time) {
        return developed({"--look", path("ui.toml"), "--events", path("events.toml"), "--time", time, "--bits", "16"});
    };
    const Picture before = at("0.9"), in_the_air = at("1.0556"), after = at("3");
    EXPECT_EQ(before.pixels, after.pixels);
    EXPECT_NEAR(in_the_air.at(3, height / 2)[1], 1 - 0.004088 * height, 1.5 / 255);
}

// 71.4 ms after a turn by 90 degrees the interface lags by 0.0047 of the width; put there, it does not.
TEST_F(CliUi, ATeleportSetsTheHeadingWithoutAPush) {
    write("turn.toml", "[[event]]\ntime = 1\nyaw = 90.0\n");
    write("teleport.toml", "[[event]]\ntime = 1\nteleport = true\nyaw = 90.0\n");
    Picture step(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            std::ranges::copy(std::array{0.0f, x < width / 2 ? 0.0f : 1.0f, 0.0f, 1.0f}, step.at(x, y));
    ASSERT_TRUE(write_picture(path("hud.png"), step, {.alpha = true}));
    const auto at = [&](const std::string& events, const std::string& time) {
        return developed({"--look", path("ui.toml"), "--events", path(events), "--time", time, "--bits", "16"}).pixels;
    };
    const std::vector<float> still = at("turn.toml", "0.9");
    EXPECT_NE(at("turn.toml", "1.0714"), still);
    EXPECT_EQ(at("teleport.toml", "1.0714"), still);
}

TEST_F(CliUi, IsNotOverwritten) {
    const Outcome outcome = run({"develop", path("frame.exr"), "--ui", path("hud.png"), "-o", path("hud.png")});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("hud.png: is also an input, and would be overwritten"), std::string::npos)
        << outcome.err;
}

// Where the look has moved it, inertia comes on top.
TEST_F(CliUi, InertiaKeepsTheLooksOffset) {
    write("events.toml", "[[event]]\ntime = 1\njump = true\n");
    const std::vector<std::string> moved{"--look", path("ui.toml"), "--set", "ui_warp.offset=0.25,0"};
    std::vector<std::string> with_events = moved;
    with_events.insert(with_events.end(), {"--events", path("events.toml"), "--time", "9"});
    EXPECT_EQ(developed(with_events).pixels, developed(moved).pixels);
    EXPECT_NE(developed(moved).pixels, developed({"--look", path("ui.toml")}).pixels);
}

// An interface is a picture like any other: what its file says counts, and what is not taken is told.
TEST_F(CliUi, WhatThePictureSaysIsBelievedAndTold) {
    const std::string plain = test::content(path("hud.png"));
    const std::size_t head = 8 + 25;  // signature, IHDR
    const auto with_chunk = [&](const std::string& chunk) {
        std::string out = plain;
        // An sRGB of its own is gone.
        if (const std::size_t at = out.find("sRGB"); at != std::string::npos) out.erase(at - 4, 13);
        return write("other.png", out.insert(head, chunk));
    };
    const std::string frames("\0\0\0\3\0\0\0\0", 8);
    const std::vector<std::string> typed{"develop", path("frame.exr"), "--look", path("plain.toml"),
                                         "--ui",    path("other.png"), "-o",     path("out.png")};
    with_chunk(png_chunk("acTL", frames));
    const Outcome animated = run(typed);
    EXPECT_EQ(animated.code, 0);
    EXPECT_NE(animated.err.find("other.png: "), std::string::npos) << animated.err;
    EXPECT_NE(animated.err.find("3 frames"), std::string::npos) << animated.err;
    EXPECT_EQ(std::ranges::count(animated.err, '\n'), 1) << animated.err;
    // Display P3: 200, 7, 16 by the primaries of the standard.
    with_chunk(png_chunk("cICP", std::string("\14\15\0\1", 4)));
    const Outcome wide = run(typed);
    EXPECT_EQ(wide.code, 0) << wide.err;
    EXPECT_EQ(wide.err, "");
    constexpr std::array<std::array<double, 3>, 3> p3_to_rec709{{{1.2249401763, -0.2249401763, 0},
                                                                 {-0.0420569547, 1.0420569547, 0},
                                                                 {-0.0196375546, -0.0786360456, 1.0982736}}};
    const std::array<float, 3> codes{200 / 255.0F, 7 / 255.0F, 16 / 255.0F};
    const Picture made = picture("out.png");
    for (std::size_t row = 0; row < 3; ++row) {
        double light = 0;
        for (std::size_t i = 0; i < 3; ++i) light += p3_to_rec709[row][i] * srgb_decode(codes[i]);
        const auto expected = std::lround(srgb_encode(std::clamp(static_cast<float>(light), 0.0F, 1.0F)) * 255);
        EXPECT_EQ(code(made.at(3, 7)[row]), expected) << row;
    }
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
