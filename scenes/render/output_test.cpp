// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "render/light/shading_test_support.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::render {
namespace {

using scene::vec4;

/// finish() of these colours and alphas.
std::vector<vec4> finished(const std::vector<vec4>& colors, const std::string& arguments, float exposure = 1) {
    return test::evaluate("finish " + arguments,
                          test::frame_stand_in() + test::shader_part("output.glsl") +
                              "vec4 shade(Pixel pixel) {\n    vec4 color = load(input_0, pixel.texel);\n"
                              "    frame.modes = uvec4(1u, 1u, 0u, 0u);\n    frame.planes.w = " +
                              std::to_string(exposure) +
                              ";\n"
                              "    return finish(color.rgb, color.a" +
                              arguments + ");\n}\n",
                          {colors});
}

double narkowicz(double x) { return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

/// White need not be 1 to the last bit: powers are approximate.
void expect_near(const vec4& color, const vec4& truth) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(color[c], truth[c], 1e-6) << c;
}

std::vector<vec4> ramp() {
    std::vector<vec4> colors;
    for (int i = 0; i <= 1000; ++i) {
        const auto x = static_cast<float>(std::pow(10.0, i * 0.008 - 5));
        colors.emplace_back(x, 0.5F * x, 2 * x, 1);
    }
    return colors;
}

TEST(RenderGpuOutput, LinearIsKept) {
    const std::vector<vec4> colors = ramp();
    const std::vector<vec4> out = finished(colors, ", Output_hdr, true");
    for (std::size_t i = 0; i < colors.size(); ++i) EXPECT_EQ(out[i], colors[i]);
}

TEST(RenderGpuOutput, BrokenLightIsStoredAsNumbers) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<vec4> colors{{nan, -1, infinity, 0.5F}, {-infinity, 1e30F, 65504, nan}, {1, 1, 1, 7}};
    const std::vector<vec4> hdr = finished(colors, ", Output_hdr, false");
    EXPECT_EQ(hdr[0], vec4(0, 0, 65504, 0.5F));
    EXPECT_EQ(hdr[1], vec4(0, 65504, 65504, 0));
    EXPECT_EQ(hdr[2], vec4(1));
    for (const char* arguments : {", Output_display, false", ", Output_display, true"}) {
        const std::vector<vec4> display = finished(colors, arguments);
        expect_near(display[0], vec4(0, 0, 1, 0.5F));
        expect_near(display[1], vec4(0, 1, 1, 0));
    }
}

TEST(RenderGpuOutput, DisplayIsToneMappedByThePublishedCurveAndEncoded) {
    // Decoded again, so that the numbers are those of the curve.
    constexpr std::array<std::array<double, 2>, 8> table{{{0, 0},
                                                          {0.01, 0.003770},
                                                          {0.05, 0.044283},
                                                          {0.18, 0.266899},
                                                          {0.5, 0.616307},
                                                          {1, 0.803797},
                                                          {2, 0.914855},
                                                          {4, 0.973417}}};
    std::vector<vec4> colors;
    for (const auto& row : table) colors.emplace_back(row[0], row[0], row[0], 1);
    colors.emplace_back(7.25F, 100, 65504, 1);
    const std::vector<vec4> out = finished(colors, ", Output_display, true");
    // The table is rounded to 5e-7, and the curve encodes the darkest 12.92 times as bright.
    for (std::size_t i = 0; i < table.size(); ++i)
        EXPECT_NEAR(out[i].y, srgb_encoded(table[i][1]), 7e-6) << table[i][0];
    expect_near(out.back(), vec4(1));
}

TEST(RenderGpuOutput, CodesAreThoseOfTheStandard) {
    const std::vector<vec4> colors = ramp();
    const std::vector<vec4> encoded = finished(colors, ", Output_display, false");
    const std::vector<vec4> mapped = finished(colors, ", Output_display, true");
    for (std::size_t i = 0; i < colors.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            // A hundredth of an 8-bit code: drivers raise to powers with less than single precision.
            EXPECT_NEAR(encoded[i][c], srgb_encoded(std::min(double(colors[i][c]), 1.0)), 0.01 / 255);
            EXPECT_NEAR(mapped[i][c], srgb_encoded(narkowicz(colors[i][c])), 0.01 / 255);
        }
    }
    const std::vector<vec4> half = finished({vec4(0.5F)}, ", Output_display, false");
    EXPECT_EQ(std::lround(half[0].x * 255), 188);
}

TEST(RenderGpuOutput, ExposureIsOfWhatIsShownAndNotOfWhatIsStored) {
    const std::vector<vec4> colors = ramp();
    std::vector<vec4> brighter = colors;
    for (vec4& color : brighter) color = vec4(4 * color.x, 4 * color.y, 4 * color.z, color.w);
    EXPECT_EQ(finished(colors, ", Output_hdr, true", 4), colors);
    for (const char* arguments : {", Output_display, false", ", Output_display, true"})
        EXPECT_EQ(finished(colors, arguments, 4), finished(brighter, arguments)) << arguments;
}

TEST(RenderGpuOutput, ModesOfTheFrameAreTheSameModes) {
    EXPECT_EQ(finished(ramp(), ""), finished(ramp(), ", Output_display, true"));
}

}  // namespace
}  // namespace darkroom::render
