// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <darkroom/custom_effect.hpp>
#include <filesystem>
#include <string>
#include <utility>

#include "compose/test_stacks/support.hpp"
#include "core/files.hpp"
#include "plan/text/glsl_names.hpp"

namespace darkroom {
namespace {

constexpr std::string_view duotone = R"(// SPDX-License-Identifier: MIT
// @effect duotone: Maps shadows and highlights to two colours.
// @accepts display_linear encoded

// @param float amount = 0.5 in [0, 1] amount: Mix of the toned picture: 0 is none.
// @param rgb shadow = 0.25, 0, 0.125 in [0, 4]: Colour of the shadows.
// @param choice mode = luma | red: What decides.
// @param toggle is_inverted = on: Exchanges the two.
// @param int steps = 4 in [1, 8] px: Steps.
// @param vec2 where = -1, 0.1 in [-1, 0.1]: Place.
// @param float ratio = 2 in [0.5, 8] log: Ratio.

float duotone_weight(vec3 color) { return clamp(dot(color, vec3(0.25, 0.5, 0.25)), 0.0, 1.0); }

vec4 duotone(vec4 color, Pixel pixel, Duotone parameters) {
    float weight = parameters.mode == Duotone_mode_red ? color.r : duotone_weight(color.rgb);
    if (parameters.is_inverted != 0u) weight = 1.0 - weight;
    return vec4(mix(color.rgb, mix(parameters.shadow, vec3(1.0), weight), parameters.amount), color.a);
}
)";

std::string error_of(std::string_view text) {
    const auto effect = CustomEffect::parse(text, "my.glsl");
    return effect ? "" : effect.error().text;
}
/// The error of a file whose third line is `line`.
std::string error_of_line(const std::string& line) {
    return error_of("// @effect mine: Mine.\n\n// " + line +
                    "\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) { return color; }\n");
}

TEST(CustomEffect, EveryRowIsReadAsItWouldBeFromAStruct) {
    auto parsed = CustomEffect::parse(duotone, "duotone.glsl");
    ASSERT_TRUE(parsed) << parsed.error().text;
    const EffectInfo* const before = &parsed->info();
    const CustomEffect moved = std::move(*parsed);
    const EffectInfo& info = moved.info();
    EXPECT_EQ(&info, before);
    EXPECT_EQ(info.name, "duotone");
    EXPECT_EQ(info.doc, "Maps shadows and highlights to two colours.");
    EXPECT_EQ(info.parameters.struct_name, "Duotone");
    EXPECT_EQ(info.touch, Touch::Pointwise);
    EXPECT_FALSE(info.accepts.contains(Domain::SceneLinear));
    EXPECT_TRUE(info.accepts.contains(Domain::Encoded));
    ASSERT_EQ(info.files.size(), 1u);
    EXPECT_EQ(info.files[0].name, "duotone.glsl");
    EXPECT_EQ(info.files[0].text, duotone);

    const ParamTable& table = info.parameters;
    ASSERT_EQ(table.rows.size(), 7u);
    std::uint32_t next = 0;
    for (const ParamInfo& row : table.rows) {
        EXPECT_EQ(row.word, next) << row.name;
        next += row.words;
    }
    EXPECT_EQ(table.words(), next);
    const auto number = [&](std::string_view name, std::size_t i = 0) {
        return std::bit_cast<float>(table.defaults[table.find(name)->word + i]);
    };
    EXPECT_EQ(number("amount"), 0.5f);
    EXPECT_TRUE(table.find("amount")->is_amount);
    EXPECT_EQ(table.find("amount")->doc, "Mix of the toned picture: 0 is none.");
    EXPECT_EQ(number("shadow", 0), 0.25f);
    EXPECT_EQ(number("shadow", 2), 0.125f);
    EXPECT_EQ(table.find("shadow")->range.max, 4.0);
    EXPECT_EQ(table.find("mode")->choices.size(), 2u);
    EXPECT_EQ(table.find("mode")->choices[1], "red");
    EXPECT_EQ(table.defaults[table.find("mode")->word], 0u);
    EXPECT_EQ(table.defaults[table.find("is_inverted")->word], 1u);
    EXPECT_EQ(table.defaults[table.find("steps")->word], 4u);
    EXPECT_EQ(table.find("steps")->unit.symbol, "px");
    EXPECT_EQ(number("where", 1), 0.1f);
    EXPECT_EQ(table.find("ratio")->range.scale, Scale::Log);
}

TEST(CustomEffect, TouchAndNeedsAreRead) {
    const auto parsed = CustomEffect::parse(
        "// @effect shimmer: Moves.\r\n// @touch warp\r\n// @needs depth ui\r\nvec4 shimmer(Pixel pixel, Shimmer "
        "parameters)\r\n{}",
        "x");
    ASSERT_TRUE(parsed) << parsed.error().text;
    EXPECT_EQ(parsed->info().touch, Touch::Warp);
    EXPECT_TRUE(parsed->info().needs.contains(FrameImage::Depth) && parsed->info().needs.contains(FrameImage::Ui));
    EXPECT_FALSE(parsed->info().needs.contains(FrameImage::Normals));
    EXPECT_EQ(parsed->info().accepts.bits, Domains::all().bits);
}

TEST(CustomEffect, ErrorsNameThePlaceTheThingAndWhatIsAllowed) {
    EXPECT_EQ(error_of(""), "my.glsl:1: no line `// @effect NAME: SENTENCE.` before the code");
    EXPECT_EQ(error_of("// @effect mine: Mine.\n// vec4 mine(\nfloat other() { return mine; }\n"),
              "my.glsl:1: no function mine: expected `vec4 mine(vec4 color, Pixel pixel, Mine parameters)`");
    EXPECT_EQ(error_of("// @effect two_words: Mine.\n\nvec4 two_words(vec4 color,\n  Pixel pixel, two_words p) {}\n"),
              "my.glsl:3: two_words: the struct of its parameters is TwoWords: expected `vec4 two_words(vec4 color, "
              "Pixel pixel, "
              "TwoWords parameters)`");
    EXPECT_EQ(
        error_of("// @effect two_words: Mine.\n// @image a: 1 rgba16f\n// @result a\n// @pass one: picture -> a\n"
                 "vec4 two_words_one(Pixel pixel, Two_words parameters) {}\n"),
        "my.glsl:5: two_words_one: the struct of its parameters is TwoWords: expected `vec4 two_words_one(Pixel pixel, "
        "TwoWords parameters)`");
    EXPECT_EQ(
        error_of_line("@parm float a = 1"),
        "my.glsl:3: @parm: allowed is @effect, @param, @touch, @accepts, @makes, @needs, @image, @history, @table, "
        "@buffer, @value, @result, @pre_roll, @pass, @compute, @end");
    EXPECT_EQ(error_of_line("@touch history"), "my.glsl:3: @touch history: allowed is pointwise, warp");
    EXPECT_EQ(error_of_line("@accepts linear"),
              "my.glsl:3: @accepts linear: allowed is scene_linear, display_linear, encoded");
    EXPECT_EQ(error_of_line("@needs money"),
              "my.glsl:3: @needs money: allowed is depth, normals, velocity, shadows, ui, reactive, transparency, "
              "exposure, second");
    EXPECT_EQ(error_of_line("@param double a = 1 in [0, 2]: A."),
              "my.glsl:3: @param double: allowed is float, int, toggle, choice, vec2, vec3, vec4, rgb");
    EXPECT_EQ(error_of_line("@effect other: Other."), "my.glsl:3: a second @effect; a file holds one");
}

TEST(CustomEffect, ARowObeysTheRulesOfACompiledRow) {
    const auto says = [](const std::string& line, std::string_view part) {
        const std::string text = error_of_line("@param " + line);
        EXPECT_TRUE(text.starts_with("my.glsl:3: ") && text.find(part) != std::string::npos) << line << " -> " << text;
    };
    says("float a = 1 in [0, 2]: A", "full stop");
    says("float a = 1 in [0, 2]", "full stop");
    says("float a = 1 in [2, 2]: A.", "the interval is empty");
    says("float a = 1 in [0, x]: A.", "expected two numbers");
    says("float a = 1: A.", "no interval");
    says("float a = 3 in [0, 2]: A.", "allowed is [0, 2]");
    says("float a = nan in [0, 2]: A.", "a = nan");
    says("float a in [0, 2]: A.", "expected `@param float a = DEFAULT`");
    says("float a = in [0, 2]: A.", "no");
    says("float a = 1 in [0, 2] log: A.", "the lowest is above 0");
    says("float a = 1 in [0, 2] miles: A.", "allowed is a unit");
    says("float while = 1 in [0, 2]: A.", "a keyword of GLSL");
    says("float two__bars = 1 in [0, 2]: A.", "single underscores");
    says("float Big = 1 in [0, 2]: A.", "lower-case");
    says("float opacity = 1 in [0, 2]: A.", "a key of every stack entry");
    says("int a = 1.5 in [0, 2]: A.", "whole number");
    says("rgb a = 1, 2 in [0, 2]: A.", "a = 1, 2");
    says("toggle a = maybe: A.", "a = maybe");
    says("choice a = one: A.", "two names or more");
    says("choice a = one | one: A.", "named twice");
    says("choice a = one | Two: A.", "lower-case");
    EXPECT_EQ(error_of("// @effect mine: Mine.\n// @param toggle a = on: A.\n// @param toggle a = on: A.\nmine("),
              "my.glsl:3: a: described twice");
    EXPECT_EQ(error_of("\n// @effect mix: Mine.\nmix("), "my.glsl:2: mix: a name of GLSL or of the kernels");
}

TEST(CustomEffect, HostileTextIsRefusedOrReadAndNeverTrusted) {
    for (const char* const text :
         {"// @", "//@effect", "// @param", "// @effect :.", "// @effect a:", "// @param float", "// @param = :.",
          "// @effect a: A.\n// @param float b = 1 in ]0, 1[: B.", "// @effect a: A.\n/* a("}) {
        EXPECT_NE(error_of(text), "") << text;
    }
    EXPECT_NE(error_of(std::string_view("// @effect a: A.\0a(", 20)), "");
    std::string cut(duotone);
    while (!cut.empty()) {
        cut.pop_back();
        static_cast<void>(error_of(cut));
    }
}

// Of one stage alone: such a file would work on one device and not on another.
TEST(CustomEffect, WhatOneStageHasAloneIsRefused) {
    const auto of = [](const std::string& statement) {
        return error_of("// @effect mine: Mine.\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n    " +
                        statement + "\n    return color;\n}\n");
    };
    EXPECT_EQ(of("// discard, barrier()"), "");
    for (const std::string word : {"discard", "dFdx", "fwidth", "gl_FragCoord"})
        EXPECT_EQ(of("color.r += float(" + word + ");"),
                  "my.glsl:3: " + word + ": GLSL has it in fragment shaders alone, and this code may run in others");
    for (const std::string word : {"barrier", "gl_GlobalInvocationID"})
        EXPECT_EQ(of("color.r += float(" + word + ");"),
                  "my.glsl:3: " + word +
                      ": GLSL has it in compute shaders alone; allowed is it in the function of a `@compute`");
    const std::string pass =
        "// @effect mine: Mine.\n// @buffer counts: 64 uint\n// @value most: 1\n"
        "// @compute count 64x1 1x1: -> counts\n"
        "void mine_count(Mine parameters) { counts[gl_GlobalInvocationID.x] = 0u; }\n"
        "// @compute tell 1x1 1x1: counts -> most\n"
        "void mine_tell(Mine parameters) { most[0] = float(counts[0]); }\n"
        "// @end most\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return color * most[0]; }\n";
    EXPECT_EQ(error_of(pass), "");
}

TEST(CustomEffect, AMarkOfUtf8BeforeTheTextIsNoCode) {
    EXPECT_EQ(error_of("\xef\xbb\xbf" + std::string(duotone)), "");
    EXPECT_EQ(error_of("\xef\xbb\xbf// @effect Mine: Mine.\n").substr(0, 10), "my.glsl:1:");
}

TEST(CustomEffect, AFileIsNamedInItsErrors) {
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "darkroom_custom_effect";
    std::filesystem::create_directories(folder);
    const std::string text = "\n// @effect none\n";
    ASSERT_TRUE(write_file(folder / "bad.glsl", std::as_bytes(std::span(text))));
    const auto bad = CustomEffect::load(folder / "bad.glsl");
    ASSERT_FALSE(bad);
    EXPECT_TRUE(bad.error().text.starts_with((folder / "bad.glsl").string() + ":2: ")) << bad.error().text;
    EXPECT_FALSE(CustomEffect::load(folder / "absent.glsl"));
    std::filesystem::remove_all(folder);
}

TEST(CustomEffect, NamesAreJudgedAsGlslAndLooksDo) {
    for (const char* const good : {"a", "gaussian_blur", "pass2"}) EXPECT_TRUE(plan::is_snake_name(good)) << good;
    for (const char* const bad : {"", "_a", "a_", "2a", "a__b", "A", "a-b", "gl_a"})
        EXPECT_FALSE(plan::is_snake_name(bad)) << bad;
    EXPECT_TRUE(plan::is_glsl_keyword("uniform"));
    EXPECT_FALSE(plan::is_glsl_keyword("radius"));
    EXPECT_TRUE(plan::calls_name("a\n (b)", "a"));
    EXPECT_FALSE(plan::calls_name("aa(b) /* a( */ // a(", "a"));
}

TEST(ComposeCustomEffect, FusesWithOthersAndObeysItsParameters) {
    const auto loaded = CustomEffect::parse(duotone, "duotone.glsl");
    ASSERT_TRUE(loaded) << loaded.error().text;
    const EffectInfo& info = loaded->info();
    const ReferenceImage picture = test::round_to_float(test::random_display(37, 23, 5));
    const auto stack = [&](Composer& composer) {
        composer.add(info, nullptr);
        const Handle second = composer.add(info, nullptr);
        EXPECT_TRUE(composer.set(second, "amount", 0.25));
        EXPECT_FALSE(composer.set(second, "amount", 1.25));
        const std::uint32_t red = 1, off = 0;
        EXPECT_TRUE(composer.set(second, "mode", {&red, 1}));
        EXPECT_TRUE(composer.set(second, "is_inverted", {&off, 1}));
    };
    const ReferenceImage out = test::develop(stack, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    const auto toned = [](Rgba c, double weight, double amount) {
        const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
        return Rgba{mix(c.r, mix(0.25, 1, weight), amount), mix(c.g, mix(0, 1, weight), amount),
                    mix(c.b, mix(0.125, 1, weight), amount), c.a};
    };
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Rgba c = picture.pixels[i];
        const Rgba first = toned(c, 1 - (0.25 * c.r + 0.5 * c.g + 0.25 * c.b), 0.5);
        const Rgba expected = toned(first, first.r, 0.25);
        ASSERT_NEAR(out.pixels[i].r, expected.r, 1e-6);
        ASSERT_NEAR(out.pixels[i].g, expected.g, 1e-6);
        ASSERT_NEAR(out.pixels[i].b, expected.b, 1e-6);
        ASSERT_EQ(out.pixels[i].a, c.a);
    }
}

TEST(CustomEffect, DefinedValuesStandInTheFileAlone) {
    const auto effect = CustomEffect::parse(
        "// @effect mine: Mine.\n#define pow min // not a power\n#define rg xy\n#include \"shared/srgb.glsl\"\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return pow(color.rgrg, color); }\n",
        "my.glsl");
    ASSERT_TRUE(effect) << effect.error().text;
    EXPECT_EQ(effect->info().files[0].text,
              "// @effect mine: Mine.\n\n\n#include \"shared/srgb.glsl\"\n"
              "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return min(color.rgrg, color); }\n");
}

TEST(ComposeCustomEffect, WhatOneFileDefinesReachesNoEffectBesideIt) {
    const auto loaded = CustomEffect::parse(
        "// @effect mine: Mine.\n// @param float gain = 0.5 in [0, 1]: Gain.\n#define pow min\n#define TAPS 2.0\n"
        "#define mine_gain parameters.gain\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return vec4(pow(color.rgb, vec3(0.25)) * TAPS * "
        "mine_gain, "
        "1); }\n",
        "my.glsl");
    ASSERT_TRUE(loaded) << loaded.error().text;
    const auto other = CustomEffect::parse(
        "// @effect other: Other.\n#define TAPS 1.0\n"
        "vec4 other(vec4 color, Pixel pixel, Other parameters) { return vec4(pow(color.rgb, vec3(2.0)) * TAPS, 1); }\n",
        "other.glsl");
    ASSERT_TRUE(other) << other.error().text;
    const ReferenceImage out = test::develop(
        [&](Composer& composer) {
            composer.add(loaded->info(), nullptr);
            composer.add(other->info(), nullptr);
        },
        test::uniform(4, 4, {0.5, 0.125, 0.25, 1}));
    ASSERT_FALSE(out.pixels.empty());
    EXPECT_NEAR(out.pixels[5].r, 0.0625, 1e-6);
    EXPECT_NEAR(out.pixels[5].g, 0.015625, 1e-6);
}

TEST(ComposeCustomEffect, MayHaveANameThatSharedFilesUse) {
    const auto loaded = CustomEffect::parse(
        "// @effect base: Base.\nvec4 base(vec4 color, Pixel pixel, Base parameters) { return color * 0.5; }\n",
        "base.glsl");
    ASSERT_TRUE(loaded) << loaded.error().text;
    const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(loaded->info(), nullptr); },
                                             test::uniform(4, 4, {0.5, 0.125, 0.25, 1}));
    ASSERT_FALSE(out.pixels.empty());
    EXPECT_NEAR(out.pixels[5].r, 0.25, 1e-6);
}

TEST(ComposeCustomEffect, GlslErrorsComeBackFromCompile) {
    const auto loaded = CustomEffect::parse(
        "// @effect broken: Broken.\nvec4 broken(vec4 color, Pixel pixel, Broken parameters) { return nonsense; }\n",
        "broken.glsl");
    ASSERT_TRUE(loaded) << loaded.error().text;
    auto device = Device::create();
    ASSERT_TRUE(device) << device.error().text;
    Composer composer(*device);
    composer.add(loaded->info(), nullptr);
    const auto plan = composer.compile({.max_extent = {8, 8}});
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().text.find("broken.glsl:2"), std::string::npos) << plan.error().text;
    EXPECT_NE(plan.error().text.find("nonsense"), std::string::npos) << plan.error().text;
}

}  // namespace
}  // namespace darkroom
