// SPDX-License-Identifier: MIT
// Files of effects that have a second form, for drivers on the CPU.
#include <gtest/gtest.h>

#include <array>

#include "plan/text/glsl.hpp"

namespace darkroom::plan {
namespace {

constexpr std::array files{
    EffectFile{"mist.glsl", "#include \"mist_sum.glsl\"\nvec4 shade(Pixel pixel) { return mist_sum(pixel); }\n"},
    EffectFile{"mist_sum.glsl", "vec4 mist_sum(Pixel pixel) { return by_taps; }\n"},
    EffectFile{"mist_sum.software.glsl", "vec4 mist_sum(Pixel pixel) { return by_loads; }\n"},
};

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

std::string text_of(std::string_view file, bool is_software) {
    const EffectInfo info{.name = "mist", .parameters = {.struct_name = "Mist"}, .files = files};
    const auto text = effect_text(info, file, 0, {}, is_software);
    EXPECT_TRUE(text) << text.error().text;
    return text ? text->glsl : std::string();
}

TEST(PlanTextForms, ADriverOnTheCpuGetsItsFormOfAFileWhoeverNamesIt) {
    for (const std::string_view file : {"mist.glsl", "mist_sum.glsl"}) {
        EXPECT_TRUE(has(text_of(file, false), "by_taps")) << file;
        EXPECT_FALSE(has(text_of(file, false), "by_loads")) << file;
        EXPECT_TRUE(has(text_of(file, true), "by_loads")) << file;
        EXPECT_FALSE(has(text_of(file, true), "by_taps")) << file;
    }
    EXPECT_TRUE(has(text_of("shared/halve.glsl", false), "sample_linear(halve_input"));
    EXPECT_TRUE(has(text_of("shared/halve.glsl", true), "load_clamped(halve_input"));
    EXPECT_FALSE(has(text_of("shared/halve.glsl", true), "sample_linear(halve_input"));
}

}  // namespace
}  // namespace darkroom::plan
