// SPDX-License-Identifier: MIT
// Files of users in one kernel: what one of them names stays its own.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <darkroom/custom_effect.hpp>
#include <string>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

// Two files of a name, whose rows stand in another order: of which the second begins what the first ends with.
constexpr std::string_view red_first =
    "// @effect tone: First.\n"
    "// @param float first = 1 in [0, 4]: Red is multiplied.\n"
    "// @param float last = 1 in [0, 4]: Blue is multiplied.\n"
    "// @param choice mode = as_is | negative: What is done then.\n"
    "vec4 tone(vec4 color, Pixel pixel, Tone parameters) {\n"
    "    vec3 toned = color.rgb * vec3(parameters.first, 1.0, parameters.last);\n"
    "    return vec4(parameters.mode == Tone_mode_negative ? 1.0 - toned : toned, color.a);\n}\n";
constexpr std::string_view blue_first =
    "// @effect tone: Second.\n"
    "// @param choice mode = negative | as_is: What is done then.\n"
    "// @param float last = 1 in [0, 4]: Blue is multiplied.\n"
    "// @param float first = 1 in [0, 4]: Red is multiplied.\n"
    "vec4 tone(vec4 color, Pixel pixel, Tone parameters) {\n"
    "    vec3 toned = color.rgb * vec3(parameters.first, 1.0, parameters.last);\n"
    "    return vec4(parameters.mode == Tone_mode_negative ? 1.0 - toned : toned, color.a);\n}\n";

TEST(ComposeCustomFusion, TwoFilesOfOneNameKeepTheirOwnParameters) {
    const CustomEffect a = must(CustomEffect::parse(red_first, "a/tone.glsl"));
    const CustomEffect b = must(CustomEffect::parse(blue_first, "b/tone.glsl"));
    const ReferenceImage white = test::uniform(9, 5, {1, 1, 1, 1});
    for (const bool is_fused : {true, false}) {
        const auto fill = [&](Composer& composer) {
            composer.add(a.info(), nullptr);
            const Handle second = composer.add(b.info(), nullptr);
            must(composer.set(second, "first", 0.25));
            test::set_word(composer, second, "mode", 1);
        };
        const ReferenceImage out = test::develop(fill, white, {.fuse = is_fused});
        ASSERT_EQ(out.pixels.size(), white.pixels.size());
        EXPECT_EQ(out.at(3, 3).r, 0.25) << (is_fused ? "fused" : "unfused");
        EXPECT_EQ(out.at(3, 3).g, 1);
        EXPECT_EQ(out.at(3, 3).b, 1);
    }
}

// Functions, constants and structs of the same names, of which nobody told the other.
TEST(ComposeCustomFusion, HelpersOfOneNameAreEachFilesOwn) {
    const auto file = [](std::string_view name, std::string_view type, double factor) {
        return fmt::format(
            "// @effect {0}: Multiplies.\n"
            "const float factor = {2:.3f}, unused[2] = float[2](factor, 1.0);\n"
            "struct Pair {{ float factor, rest; }};\n"
            "float luma(vec3 c);\n"
            "const float[3] weights = float[3](1.0, 1.0, 1.0);\n"
            "float _luma(vec3 c) {{ return weights[2] * c.g; }}\n"
            "float own(vec3 c) {{ return _luma(c); }}\n"
            "Pair pair_of(float a) {{ return Pair(a, unused[1]); }}\n"
            "float luma(vec3 c) {{ Pair pair = pair_of(factor); return c.g * pair.factor * pair.rest; }}\n"
            "float {0}_own(vec3 c) {{ return luma(c) * own(vec3(1.0)); }}\n"
            "vec4 {0}(vec4 color, Pixel pixel, {1} parameters) {{ return vec4(vec3({0}_own(color.rgb)), 1.0); }}\n",
            name, type, factor);
    };
    const CustomEffect a = must(CustomEffect::parse(file("one", "One", 0.5), "one.glsl"));
    const CustomEffect b = must(CustomEffect::parse(file("other", "Other", 0.25), "other.glsl"));
    for (const bool is_fused : {true, false}) {
        const auto fill = [&](Composer& composer) {
            for (const CustomEffect* const effect : {&a, &b, &a}) composer.add(effect->info(), nullptr);
        };
        const ReferenceImage out = test::develop(fill, test::uniform(3, 3, {1, 1, 1, 1}), {.fuse = is_fused});
        ASSERT_FALSE(out.pixels.empty());
        EXPECT_EQ(out.at(1, 1).r, 0.0625);
    }
}

TEST(ComposeCustomFusion, EveryOneOfManyChoicesIsDrawn) {
    constexpr std::uint32_t count = 300;
    std::string names;
    for (std::uint32_t i = 0; i < count; ++i) names += (i == 0 ? "c" : " | c") + std::to_string(i);
    const CustomEffect effect =
        must(CustomEffect::parse("// @effect many: Shows its choice as a grey.\n// @param choice pick = " + names +
                                     ": Which.\n"
                                     "vec4 many(vec4 color, Pixel pixel, Many parameters) {\n"
                                     "    return vec4(vec3(float(parameters.pick)), 1.0);\n}\n",
                                 "many.glsl"));
    for (const std::uint32_t pick : {0U, 3U, 31U, 32U, 35U, 63U, 64U, 255U, 256U, count - 1}) {
        const auto fill = [&](Composer& composer) {
            // Choices of others before it in the kernel's shape.
            composer.add(effect.info(), nullptr);
            test::set_word(composer, composer.add(effect.info(), nullptr), "pick", pick);
        };
        for (const bool is_lean : {true, false}) {
            const ReferenceImage out =
                test::develop(fill, test::uniform(3, 3, {0, 0, 0, 1}), {.wait_for_lean_kernels = is_lean});
            ASSERT_FALSE(out.pixels.empty());
            EXPECT_EQ(out.at(1, 1).g, pick) << (is_lean ? "lean" : "as compiled");
        }
    }
}

}  // namespace
}  // namespace darkroom
