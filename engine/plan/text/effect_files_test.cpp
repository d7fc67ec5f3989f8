// SPDX-License-Identifier: MIT
#include "plan/text/effect_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace darkroom::plan {
namespace {

constexpr std::array files{EffectFile{"mist.glsl",
                                      "const float everybody = 1.0;\n"
                                      "#part thin thick\n"
                                      "const float some = 2.0;\n"
                                      "#part\n"
                                      "const float all_again = 3.0;\n"
                                      "#part end\n"
                                      "vec4 mist(vec4 color) { return color; }\n"},
                           EffectFile{"mist_pass.glsl", "#include \"mist.glsl\"\n"}};
const EffectInfo mist{.name = "mist", .files = files};

TEST(PlanText, APartHasItsLinesAndThoseOfAllAtTheirNumbers) {
    const std::string everybody = "const float everybody = 1.0;\n", all_again = "const float all_again = 3.0;\n";
    const std::string some = everybody + "\nconst float some = 2.0;\n\n" + all_again + "\n\n";
    for (const char* const name : {"mist.glsl#thin", "mist.glsl#thick"}) EXPECT_EQ(own_text(mist, name).glsl, some);
    EXPECT_EQ(own_text(mist, "mist.glsl#th").glsl, everybody + "\n\n\n" + all_again + "\n\n");
    const std::string end = everybody + "\n\n\n" + all_again + "\nvec4 mist(vec4 color) { return color; }\n";
    EXPECT_EQ(own_text(mist, "mist.glsl").glsl, end);
    EXPECT_NE(own_text(mist, "mist_pass.glsl#thin").glsl.find(some), std::string::npos);
    EXPECT_EQ(own_text(mist, "mist.glsl#thin").shown, "effects/mist/mist.glsl");
    EXPECT_TRUE(own_text(mist, "rain.glsl#thin").glsl.empty());
}

}  // namespace
}  // namespace darkroom::plan
