// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/gamut_compression.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "compose/test_stacks/support.hpp"
#include "gamut_compression/gamut_compression_reference.hpp"

namespace darkroom {
namespace {

using color_state_detail::Color;
using Into = GamutCompressionInto;
constexpr std::array all_gamuts{Into::Rec709, Into::P3, Into::Rec2020};

Color in_gamut(const Color& light, Into gamut) {
    if (gamut == Into::P3) return color_state_detail::multiplied(color_state_detail::p3, light);
    return gamut == Into::Rec2020 ? color_state_detail::multiplied(color_state_detail::rec2020, light) : light;
}
Color from_gamut(const Color& light, Into gamut) {
    if (gamut == Into::P3) return color_state_detail::solved(color_state_detail::p3, light);
    return gamut == Into::Rec2020 ? color_state_detail::solved(color_state_detail::rec2020, light) : light;
}
Color compressed(const Color& light, const GamutCompression& parameters) {
    const Rgba out = gamut_compression_reference({light[0], light[1], light[2]}, {}, parameters);
    return {out.r, out.g, out.b};
}
double smallest(const Color& c) { return std::min({c[0], c[1], c[2]}); }

/// Colours of a cube, its faces among them.
std::vector<Color> colors_of_cube(std::size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(0, 1);
    std::vector<Color> out;
    for (std::size_t i = 0; i < count; ++i) {
        Color c{part(random), part(random), part(random)};
        if (i % 2 == 0) c[i / 2 % 3] = 0;
        if (i % 4 == 0) c[(i / 4 + 1) % 3] = 0;
        out.push_back(c);
    }
    return out;
}

// Values of the published transform (thresholds, limits and power of ACES 1.3), worked out apart from this tree.
TEST(EffectGamutCompression, CurveHasThePublishedValues) {
    EXPECT_NEAR(gamut_compression_curve(1.147, 1.147, 0.815, 1.2), 1, 1e-12);
    EXPECT_NEAR(gamut_compression_curve(1.264, 1.264, 0.803, 1.2), 1, 1e-12);
    EXPECT_NEAR(gamut_compression_curve(1.312, 1.312, 0.88, 1.2), 1, 1e-12);
    EXPECT_NEAR(gamut_compression_curve(1.0, 1.147, 0.815, 1.2), 0.9466433, 1e-6);
    EXPECT_NEAR(gamut_compression_curve(2.0, 1.312, 0.88, 1.2), 1.0169284, 1e-6);
}

TEST(EffectGamutCompression, CurveNeverFallsAndItsSlopeHasNoStep) {
    for (const double power : {1.0, 1.2, 4.0}) {
        constexpr double step = 1e-4;
        double before = 0, slope = 1;
        for (double distance = step; distance < 3; distance += step) {
            const double value = gamut_compression_curve(distance, 1.3, 0.8, power);
            EXPECT_GT(value, before) << distance;
            EXPECT_NEAR((value - before) / step, slope, 0.01) << distance << " " << power;
            slope = (value - before) / step;
            before = value;
        }
    }
}

TEST(EffectGamutCompression, WhatIsNearGreyStays) {
    for (const Into into : all_gamuts) {
        for (const Color& color : colors_of_cube(1000)) {
            const double grey = 5 * std::max({color[0], color[1], color[2]});
            const Color pale{color[0] + grey, color[1] + grey, color[2] + grey};
            const Color out = compressed(pale, {.into = into});
            for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(out[i], pale[i], 1e-9 * grey);
        }
    }
}

// The limits that the page names.
TEST(EffectGamutCompression, AWholeGamutComesToLieInsideOfASmallerOne) {
    struct Case {
        Into from, into;
        Vec3 limit;
    };
    for (const auto& [from, into, limit] :
         {Case{Into::Rec2020, Into::Rec709, {1.60f, 1.09f, 1.12f}},
          Case{Into::Rec2020, Into::P3, {1.33f, 1.07f, 1.02f}}, Case{Into::P3, Into::Rec709, {1.22f, 1.04f, 1.10f}}}) {
        double lowest = 1;
        bool was_outside = false;
        for (const Color& color : colors_of_cube(20000)) {
            const Color light = from_gamut(color, from);
            was_outside = was_outside || smallest(in_gamut(light, into)) < -0.01;
            lowest = std::min(lowest, smallest(in_gamut(compressed(light, {.into = into, .limit = limit}), into)));
        }
        EXPECT_TRUE(was_outside);
        EXPECT_GE(lowest, -1e-9) << static_cast<int>(from) << " " << static_cast<int>(into);
    }
}

TEST(EffectGamutCompression, TheLargestChannelAndTheOrderStayAndLightScales) {
    for (const Into into : all_gamuts) {
        const GamutCompression parameters{.into = into};
        for (const Color& color : colors_of_cube(500)) {
            const Color light = from_gamut({color[0] - 0.3 * color[1], color[1], color[2] - 0.2 * color[0]}, into);
            const Color before = in_gamut(light, into), after = in_gamut(compressed(light, parameters), into);
            for (std::size_t i = 0; i < 3; ++i) {
                if (before[i] == std::max({before[0], before[1], before[2]})) {
                    EXPECT_NEAR(after[i], before[i], 1e-9);
                }
                EXPECT_GE(after[i], before[i] - 1e-9) << "towards grey";
            }
            const Color bright = in_gamut(compressed({light[0] * 16, light[1] * 16, light[2] * 16}, parameters), into);
            for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(bright[i], 16 * after[i], 1e-8);
        }
    }
}

// Of the pixel's brightest channel: what comes to lie on the edge is a difference of large numbers.
void expect_near_reference(const GamutCompression& values, const ReferenceImage& picture) {
    const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(values); }, picture);
    const ReferenceImage expected = test::reference_of(values, picture);
    ASSERT_EQ(out.pixels.size(), expected.pixels.size());
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Rgba &a = out.pixels[i], &b = expected.pixels[i];
        const double bound = 1e-4 * std::max({std::abs(b.r), std::abs(b.g), std::abs(b.b), 1e-3});
        EXPECT_NEAR(a.r, b.r, bound) << i;
        EXPECT_NEAR(a.g, b.g, bound) << i;
        EXPECT_NEAR(a.b, b.b, bound) << i;
        EXPECT_EQ(a.a, b.a);
    }
}

TEST(EffectGamutCompression, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const Into into : all_gamuts) {
        SCOPED_TRACE(static_cast<int>(into));
        expect_near_reference({.into = into}, picture);
        expect_near_reference({.into = into, .limit = {1.6f, 1.1f, 1.2f}, .power = 4}, picture);
    }
}

TEST(EffectGamutCompression, GpuLeavesTheBitsOfWhatIsNearGrey) {
    ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 3));
    for (Rgba& p : picture.pixels) p = {p.r + 2, p.g + 2, p.b + 2, p.a};
    picture = test::round_to_float(picture);
    for (const Into into : all_gamuts)
        EXPECT_EQ(test::worst_difference(
                      test::develop([&](Composer& composer) { composer.add(GamutCompression{.into = into}); }, picture),
                      picture),
                  0);
}

TEST(EffectGamutCompression, GpuKeepsBrokenInputFinite) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::array values{
        0.0, -0.0, -1.0, 1e-38, 1.0, 65504.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()};
    ReferenceImage picture(values.size(), values.size());
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) picture.at(x, y) = {values[x], values[y], 0, 1};
    for (const Into into : all_gamuts) {
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(GamutCompression{.into = into}); }, picture);
        for (const Rgba& p : out.pixels)
            for (const double v : {p.r, p.g, p.b}) EXPECT_TRUE(std::abs(v) <= 3e5) << v;
    }
}

}  // namespace
}  // namespace darkroom
