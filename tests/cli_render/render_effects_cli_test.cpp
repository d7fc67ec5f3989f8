// SPDX-License-Identifier: MIT
// What effects do to a scene that was rendered, by pixels whose values arithmetic gives.
#include <darkroom/effects.hpp>

#include <algorithm>
#include <cmath>

#include "effects/shared/srgb_reference.hpp"
#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

constexpr std::uint32_t width = 96, height = 60;

/// A square of 2 x 2 m, 5 m before the camera: at 10 pixels a metre, columns 38 to 57 and rows 20 to 39. Light comes
/// from `light` alone.
std::string square_scene(const std::string& tables, const std::string& material,
                         const std::string& light = "intensity = 0") {
    return "[scene]\ngrid = false\n[camera]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 61.9275130641\n"
           "[environment]\nambient_color = [0, 0, 0]\nbackground = [0, 0, 0]\n" +
           tables + "[entities.sun.light]\ndirection = [0, 1, 0.2]\n" + light +
           "\n[entities.square]\nbounds = { min = [-1, -1, -1], max = [1, 1, 0] }\nmaterial = { " + material + " }\n";
}

class CliRenderEffects : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "fog", "ssao", "volumetric"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
    /// The picture of a scene's text. `said`: what the program says of it.
    [[nodiscard]] Picture rendered(const std::string& scene, std::vector<std::string> flags = {},
                                   const std::string& out = "out.png", const std::string& said = "") const {
        flags.insert(flags.begin(), {"render", write("a.scene.toml", scene), "-o", path(out), "--size", "96x60",
                                     "--shadow-resolution", "256"});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, said);
        return picture(out);
    }
};

int code_of(const Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t channel = 0) {
    return static_cast<int>(std::lround(picture.at(x, y)[channel] * 255));
}
std::array<int, 3> codes_of(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    return {code_of(picture, x, y, 0), code_of(picture, x, y, 1), code_of(picture, x, y, 2)};
}

TEST_F(CliRenderEffects, AnEmissiveBoxHasAHalo) {
    const std::string bloom = "[post_process]\nssao_enabled = false\nbloom_intensity = 0.5\n";
    const std::string emissive = "color = [0, 0, 0], emissive = [1, 0.5, 0.25], emissive_strength = ";
    const Picture off = rendered(square_scene(bloom, emissive + "8"), {"--bloom-enabled", "off"});
    const Picture on = rendered(square_scene(bloom, emissive + "8"));
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            EXPECT_EQ(code_of(off, x, y) > 0, x >= 38 && x < 58 && y >= 20 && y < 40) << x << ", " << y;
    EXPECT_GT(code_of(off, 48, 30), 230);
    // It surrounds the box, falls off and has its colour.
    for (std::uint32_t away = 1; away < 8; ++away) {
        const std::array<int, 3> right = codes_of(on, 57 + away, 30);
        EXPECT_GT(right[0], 0) << away;
        EXPECT_GT(right[0], right[1]) << away;
        EXPECT_GT(right[1], right[2]) << away;
        EXPECT_GE(right[0], code_of(on, 58 + away, 30)) << away;
        for (const int other : {code_of(on, 38 - away, 30), code_of(on, 48, 20 - away), code_of(on, 48, 39 + away)})
            EXPECT_NEAR(other, right[0], 0.15 * right[0] + 3) << away;
    }
    EXPECT_GT(code_of(on, 58, 30), 2 * code_of(on, 65, 30));
    // What emits nothing above the threshold has none.
    const Picture dull =
        rendered(square_scene(bloom, emissive + "0.4"), {}, "out.png",
                 "darkroom: bloom: nothing is brighter than its threshold 1; the brightest value is 0.4\n");
    EXPECT_GT(code_of(dull, 48, 30), 0);
    EXPECT_EQ(codes_of(dull, 59, 30), (std::array{0, 0, 0}));
}

TEST_F(CliRenderEffects, BloomThatWasAskedForAndFindsNothingIsSaid) {
    const std::string dim = "color = [0, 0, 0], emissive = [1, 0.5, 0.25], emissive_strength = 0.5";
    const std::string scene = write("dim.scene.toml", square_scene("[post_process]\nssao_enabled = false\n", dim));
    const auto said = [&](std::vector<std::string> flags) {
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.err;
    };
    const auto render = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"render", scene, "--size", "96x60"});
        return said(flags);
    };
    const auto line = [](const std::string& threshold, const std::string& brightest) {
        return "darkroom: bloom: nothing is brighter than its threshold " + threshold + "; the brightest value is " +
               brightest + "\n";
    };
    const std::string out = path("out.png"), asked = "--bloom-intensity=0.3";
    EXPECT_EQ(render({"-o", out, asked}), line("1", "0.5"));
    EXPECT_EQ(render({"-o", out, asked, "--bloom-threshold", "0.75"}), line("0.75", "0.5"));
    EXPECT_EQ(render({"-o", out, asked, "--bloom-threshold", "0.25"}), "");
    EXPECT_EQ(render({"-o", out, asked, "--no-bloom"}), "");
    EXPECT_EQ(render({"-o", out}), "") << "on by itself";
    EXPECT_EQ(render({"-o", out, asked, "--quiet"}), "");
    EXPECT_EQ(render({"-o", path("out.####.png"), asked, "--frames", "0-2", "--fps", "24"}), line("1", "0.5"))
        << "once";
    // There it reads the scene, here the picture before it.
    EXPECT_EQ(render({"-o", out, asked, "--order", "scene_linear", "--save-frame", path("frame.exr")}),
              line("1", "0.5"));
    const auto develop = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-o", out});
        return said(flags);
    };
    EXPECT_EQ(develop({asked}), line("1", "0.5"));
    EXPECT_EQ(develop({asked, "--bloom-threshold", "0.25"}), "");
    EXPECT_EQ(develop({}), "");
    const std::string look = write("look.toml",
                                   "[[stack]]\neffect = \"exposure\"\nexposure = 1.5\n"
                                   "[[stack]]\neffect = \"bloom\"\n[[stack]]\neffect = \"encode\"\n");
    EXPECT_EQ(develop({"--look", look}), line("1", "0.75"));
    EXPECT_EQ(develop({"--look", look, "--set", "exposure.exposure=3"}), "");
}

TEST_F(CliRenderEffects, FogHasTheColourOfTableAndFlag) {
    const std::string fog =
        "[post_process]\nfog_start = 0.5\nfog_end = 2\nfog_enabled = true\nfog_color = [0.5, 0.25, 0.75]\n";
    const std::string grey = "color = [0.5, 0.5, 0.5]";
    // Full at 2 m. The codes are those of linear 0.5, 0.25 and 0.75: the colour is not tone-mapped.
    constexpr std::array of_table{188, 137, 225};
    EXPECT_EQ(codes_of(rendered(square_scene(fog, grey)), 48, 30), of_table);
    EXPECT_EQ(
        codes_of(rendered(square_scene("", grey), {"--order", "documented", "--fog-density", "0.02", "--fog-color",
                                                   "0.5,0.25,0.75", "--fog-start", "0.5", "--fog-end", "2"}),
                 48, 30),
        of_table);
    EXPECT_EQ(codes_of(rendered(square_scene(fog, grey), {"--fog-color", "0.25, 0.75, 0.5"}), 48, 30),
              (std::array{137, 225, 188}))
        << "the flag wins";
}

TEST_F(CliRenderEffects, FogLeavesTheSkyAlone) {
    const std::string sky = "[post_process]\nfog_start = 0.5\nfog_end = 2\nfog_color = [0.5, 0.25, 0.75]\n";
    std::string scene = square_scene(sky, "color = [0.5, 0.5, 0.5]");
    scene.replace(scene.find("background = [0, 0, 0]"), 22, "background = [0.2, 0.3, 0.4]");
    const Picture clear = rendered(scene, {"--no-fog"}), fogged = rendered(scene, {"--fog-enabled", "on"});
    const Picture covered = rendered(scene, {"--fog-enabled", "on", "--fog-sky", "on"});
    EXPECT_GT(code_of(clear, 4, 4), 40) << "there is a sky to be seen";
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const bool is_sky = x < 38 || x >= 58 || y < 20 || y >= 40;
            ASSERT_EQ(codes_of(fogged, x, y), is_sky ? codes_of(clear, x, y) : codes_of(covered, x, y))
                << x << ", " << y;
            ASSERT_EQ(codes_of(covered, x, y), (std::array{188, 137, 225})) << x << ", " << y;
        }
}

/// What haze adds to the light of a picture, summed by channel.
class CliRenderHaze : public CliRenderEffects {
  protected:
    [[nodiscard]] std::array<double, 3> haze(const std::string& light) const {
        const std::string scene =
            square_scene("[post_process]\nssao_enabled = false\nbloom_enabled = false\nvolumetric_density = 40\n",
                         "color = [0.5, 0.5, 0.5]", light);
        const Picture with = rendered(scene, {"--no-tonemapping"}, "with.exr");
        const Picture without = rendered(scene, {"--no-tonemapping", "--volumetric-enabled", "off"}, "without.exr");
        std::array<double, 3> sum{};
        for (std::size_t i = 0; i < with.pixels.size(); ++i)
            if (i % 4 != 3) sum[i % 4] += double{with.pixels[i]} - double{without.pixels[i]};
        return sum;
    }
};

TEST_F(CliRenderHaze, HasTheLightsColourUnlessItHasItsOwn) {
    const std::string amber = "color = [1, 0.5, 0.25]\n";
    const std::array<double, 3> one = haze(amber + "volumetric_intensity = 1");
    EXPECT_GT(one[0], 1);
    EXPECT_NEAR(one[1] / one[0], 0.5, 0.005);
    EXPECT_NEAR(one[2] / one[0], 0.25, 0.005);
    // The intensity of the haze is its own, and scales it; that of the light does not.
    const std::array<double, 3> three = haze(amber + "intensity = 7\nvolumetric_intensity = 3");
    EXPECT_NEAR(three[0] / one[0], 3, 0.03);
    const std::array<double, 3> blue = haze(amber + "volumetric_intensity = 1\nvolumetric_color = [0.125, 0.25, 1]");
    EXPECT_NEAR(blue[2] / one[0], 1, 0.01);
    EXPECT_NEAR(blue[0] / blue[2], 0.125, 0.005);
    EXPECT_NEAR(blue[1] / blue[2], 0.25, 0.005);
}

TEST_F(CliRenderHaze, ALightWithoutVolumetricIntensityAddsNothing) {
    EXPECT_EQ(haze("intensity = 7\nvolumetric_color = [9, 9, 9]"), (std::array{0.0, 0.0, 0.0})) << "0 is the default";
    EXPECT_EQ(haze("intensity = 7\nvolumetric_intensity = 0"), (std::array{0.0, 0.0, 0.0}));
}

/// The six scenes that ship, of one sample a pixel, against the light that 16 show.
class SoakRenderEdges : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"fxaa", "smaa", "dither"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
    [[nodiscard]] Picture shown(const std::string& scene, const std::string& size,
                                const std::vector<std::string>& flags) const {
        std::vector<std::string> words{"render", std::string(test::source_folder) + "/scenes/" + scene + ".scene.toml",
                                       "-q",     "--size",
                                       size,     "--samples",
                                       "1",      "--no-dither",
                                       "-o",     path("shown.png")};
        words.insert(words.end(), flags.begin(), flags.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture("shown.png");
    }
    /// The mean light of every 4x4 pixels, as code values.
    [[nodiscard]] static Picture mean_of(const Picture& large) {
        Picture out(large.width / 4, large.height / 4);
        for (std::uint32_t y = 0; y < out.height; ++y)
            for (std::uint32_t x = 0; x < out.width; ++x)
                for (std::uint32_t c = 0; c < 3; ++c) {
                    double light = 0;
                    for (std::uint32_t k = 0; k < 16; ++k)
                        light += srgb_decoded(double{large.at(4 * x + k % 4, 4 * y + k / 4)[c]}) / 16;
                    out.at(x, y)[c] = static_cast<float>(srgb_encoded(light));
                }
        return out;
    }
};

TEST_F(SoakRenderEdges, AreNearerToManySamplesThanWithoutAFilter) {
    for (const char* const scene : {"dungeon", "courtyard", "interior", "street", "forge", "showcase"}) {
        const Picture truth = mean_of(shown(scene, "2560x1440", {"--no-fxaa"}));
        const std::array<Picture, 3> made{shown(scene, "640x360", {"--no-fxaa"}), shown(scene, "640x360", {"--fxaa"}),
                                          shown(scene, "640x360", {"--no-fxaa", "--smaa"})};
        // Where a filter changes anything that is seen.
        std::array<double, 3> errors{};
        for (std::size_t i = 0; i < truth.pixels.size(); i += 4) {
            const auto apart = [&](const Picture& a, const Picture& b, std::size_t c) {
                return std::abs(double{a.pixels[i + c]} - double{b.pixels[i + c]});
            };
            bool is_changed = false;
            for (std::size_t c = 0; c < 3; ++c)
                is_changed |= apart(made[1], made[0], c) > 8.0 / 255 || apart(made[2], made[0], c) > 8.0 / 255;
            for (std::size_t of = 0; is_changed && of < 3; ++of)
                for (std::size_t c = 0; c < 3; ++c) errors[of] += apart(made[of], truth, c);
        }
        EXPECT_LT(errors[1], errors[0]) << scene << ", fxaa";
        EXPECT_LT(errors[2], errors[0]) << scene << ", smaa";
    }
}

}  // namespace
}  // namespace darkroom
