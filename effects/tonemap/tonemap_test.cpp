// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/tonemap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "tonemap/tonemap_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array all_operators{
    TonemapOperator::AcesNarkowicz, TonemapOperator::AcesHill, TonemapOperator::ReinhardExtended,
    TonemapOperator::Hable,         TonemapOperator::Agx,      TonemapOperator::KhronosPbrNeutral,
    TonemapOperator::Linear,        TonemapOperator::Bt2390,   TonemapOperator::Gt7,
};

Rgba mapped(TonemapOperator curve, const Rgba& color, float white = 4.0f) {
    return tonemap_reference(color, {}, {.curve = curve, .white = white});
}
double mapped_grey(TonemapOperator curve, double value) { return mapped(curve, {value, value, value}).g; }

void expect_color(const Rgba& color, double r, double g, double b) {
    EXPECT_NEAR(color.r, r, 1e-6);
    EXPECT_NEAR(color.g, g, 1e-6);
    EXPECT_NEAR(color.b, b, 1e-6);
}

/// Everything a broken frame may hold.
ReferenceImage hostile_picture() {
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::array values{0.0, -0.0, -1.0, 1e-42, 1.0, 65504.0, 3e38, infinity, -infinity, nan};
    ReferenceImage picture(values.size(), values.size());
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) picture.at(x, y) = {values[x], values[y], 0.18, 1.0};
    return picture;
}

/// Of BT.2390, light below 0 is colour outside of Rec. 709; gt7 has the whole of Rec. 2020.
void expect_in_unit_range(const ReferenceImage& picture, TonemapOperator curve) {
    ASSERT_FALSE(picture.pixels.empty());
    const double lowest = curve >= TonemapOperator::Bt2390 ? -1.0 : 0.0;
    const double highest = curve == TonemapOperator::Gt7 ? 1.661 : 1.0;  // BT.2087's matrix back
    for (const Rgba& color : picture.pixels) {
        for (const double value : {color.r, color.g, color.b}) {
            // Fails for NaN, too.
            EXPECT_TRUE(value >= lowest && value <= highest) << value;
        }
    }
}

TEST(EffectTonemap, NarkowiczHasThePublishedValues) {
    constexpr std::array<std::array<double, 2>, 8> table{{{0, 0},
                                                          {0.01, 0.003770},
                                                          {0.05, 0.044283},
                                                          {0.18, 0.266899},
                                                          {0.5, 0.616307},
                                                          {1, 0.803797},
                                                          {2, 0.914855},
                                                          {4, 0.973417}}};
    for (const auto& [light, expected] : table)
        EXPECT_NEAR(mapped_grey(TonemapOperator::AcesNarkowicz, light), expected, 6e-7) << light;
    EXPECT_EQ(mapped_grey(TonemapOperator::AcesNarkowicz, 7.25), 1.0);
}

// Values of the published code, evaluated apart from this tree.
TEST(EffectTonemap, OtherOperatorsHaveThePublishedValues) {
    expect_color(mapped(TonemapOperator::AcesHill, {0.18, 0.18, 0.18}), 0.1055912, 0.1055912, 0.1055902);
    expect_color(mapped(TonemapOperator::AcesHill, {4, 1, 0.2}), 0.9971608, 0.6633807, 0.2818563);
    EXPECT_NEAR(mapped_grey(TonemapOperator::Hable, 0.18), 0.1283384, 1e-6);
    EXPECT_NEAR(mapped_grey(TonemapOperator::Hable, 1.0), 0.4929185, 1e-6);
    EXPECT_NEAR(mapped_grey(TonemapOperator::Hable, 5.6), 1.0, 1e-12);
    expect_color(mapped(TonemapOperator::Agx, {0.18, 0.18, 0.18}), 0.2144674, 0.2145327, 0.2145367);
    expect_color(mapped(TonemapOperator::Agx, {4, 1, 0.2}), 0.9213495, 0.6176296, 0.3502892);
    EXPECT_NEAR(mapped_grey(TonemapOperator::KhronosPbrNeutral, 0.5), 0.46, 1e-12);
    EXPECT_NEAR(mapped_grey(TonemapOperator::KhronosPbrNeutral, 1.0), 0.8690909, 1e-6);
    expect_color(mapped(TonemapOperator::KhronosPbrNeutral, {4, 1, 0.2}), 0.9832558, 0.4682992, 0.3309774);
    EXPECT_EQ(mapped_grey(TonemapOperator::Linear, 0.3), 0.3);
}

TEST(EffectTonemap, ReinhardMapsWhiteToWhite) {
    for (const float white : {1.0f, 4.0f, 100.0f}) {
        const Rgba at_white = mapped(TonemapOperator::ReinhardExtended, {white, white, white}, white);
        EXPECT_NEAR(at_white.r, 1.0, 1e-12) << white;
        const double below = white * 0.9;
        EXPECT_LT(mapped(TonemapOperator::ReinhardExtended, {below, below, below}, white).r, 1.0) << white;
    }
}

TEST(EffectTonemap, GreyNeverFalls) {
    for (const TonemapOperator curve : all_operators) {
        double before = 0.0;
        for (double light = 1e-4; light < 1e4; light *= 1.01) {
            const double value = mapped_grey(curve, light);
            EXPECT_GE(value, before - 1e-12) << static_cast<int>(curve) << " at " << light;
            before = value;
        }
        EXPECT_GT(before, 0.99) << static_cast<int>(curve);
    }
}

TEST(EffectTonemap, BlackIsBlackAndNothingLeavesTheRange) {
    for (const TonemapOperator curve : all_operators) {
        EXPECT_EQ(mapped_grey(curve, 0.0), 0.0) << static_cast<int>(curve);
        expect_in_unit_range(test::reference_of(Tonemap{.curve = curve}, hostile_picture()), curve);
        expect_in_unit_range(test::reference_of(Tonemap{.curve = curve}, test::random_hdr(64, 64, 3)), curve);
    }
}

TEST(EffectTonemap, MakesDisplayLinear) {
    const Tonemap parameters;
    EXPECT_EQ(effect_info(parameters).makes({}, &parameters).domain, Domain::DisplayLinear);
}

// `operator` is what an artist looks for and what C++ does not allow.
TEST(EffectTonemap, FilesMaySayOperator) {
    const ParamTable table = effect_info(Tonemap{}).parameters;
    ASSERT_NE(table.find("operator"), nullptr);
    EXPECT_EQ(table.find("operator"), table.find("curve"));
    EXPECT_EQ(table.find("curve")->choices[5], "khronos_pbr_neutral");
}

TEST(EffectTonemap, GpuKeepsBrokenInputInRange) {
    for (const TonemapOperator curve : all_operators) {
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(Tonemap{.curve = curve}); }, hostile_picture());
        expect_in_unit_range(out, curve);
        EXPECT_LE(test::worst_half_ulps(out, test::reference_of(Tonemap{.curve = curve}, hostile_picture())), 2.0)
            << static_cast<int>(curve);
    }
}

TEST(EffectTonemap, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const TonemapOperator curve : all_operators) {
        if (curve == TonemapOperator::Gt7) continue;  // below, with the other one of ICtCp
        SCOPED_TRACE(static_cast<int>(curve));
        test::expect_gpu_matches_reference(Tonemap{.curve = curve}, picture);
    }
    test::expect_gpu_matches_reference(Tonemap{.curve = TonemapOperator::ReinhardExtended, .white = 0.5f}, picture);
}

// ITU-R BT.2390, 5.4.1: 812 cd/m2, which is 4 times white, into displays of less.
TEST(EffectTonemap, Bt2390KeepsWhatIsBelowItsKneeAndEndsAtThePeak) {
    for (const TonemapOperator curve : {TonemapOperator::Bt2390, TonemapOperator::Bt2390Ictcp}) {
        for (const float peak : {100.0f, 203.0f, 400.0f, 1000.0f, 4000.0f}) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(curve) << " " << peak);
            const float white = peak < 800 ? 4.0f : 49.0f;
            const Tonemap values{.curve = curve, .white = white, .peak_nits = peak};
            const auto grey = [&](double light) { return tonemap_reference({light, light, light}, {}, values).g; };
            const double most = pq_encoded(white * 203.0 / 10000), end = peak / 203.0;
            const double knee = pq_decoded(1.5 * pq_encoded(peak / 10000.0) - 0.5 * most) * 10000 / 203;
            EXPECT_NEAR(grey(knee * 0.5), knee * 0.5, 1e-5);
            EXPECT_NEAR(grey(white), end, 2e-5 * end);
            EXPECT_LE(grey(4 * white), end);
            double before = 0, slope = 1;
            for (double light = 1e-3; light < white; light *= 1.002) {
                const double value = grey(light), now = (value - before) / (light * (1 - 1 / 1.002));
                EXPECT_GT(value, before);
                if (light > 2e-3) {
                    EXPECT_NEAR(now, slope, 0.05) << light;
                }
                slope = now;
                before = value;
            }
        }
    }
}

// Up to where nothing is clipped.
TEST(EffectTonemap, Bt2390KeepsTheHue) {
    const Tonemap largest{.curve = TonemapOperator::Bt2390, .white = 16, .peak_nits = 400};
    const Rgba color = tonemap_reference({8, 4, 1}, {}, largest);
    EXPECT_NEAR(color.r / color.g, 2, 1e-9);
    EXPECT_NEAR(color.g / color.b, 4, 1e-9);
    Tonemap ictcp = largest;
    ictcp.curve = TonemapOperator::Bt2390Ictcp;
    const auto chroma = [](const Rgba& c) {
        const tonemap_detail::Rows to_lms{{{1688, 2146, 262}, {683, 2951, 462}, {99, 309, 3688}}};
        auto lms =
            tonemap_detail::multiply(to_lms, tonemap_detail::multiply(color_state_detail::rec2020, {c.r, c.g, c.b}));
        for (double& v : lms) v = pq_encoded(v / 4096 * 203 / 10000);
        return std::array{6610 * lms[0] - 13613 * lms[1] + 7003 * lms[2],
                          17933 * lms[0] - 17390 * lms[1] - 543 * lms[2]};
    };
    const Rgba light{2.4, 1.6, 1.2}, shown = tonemap_reference(light, {}, ictcp);
    EXPECT_NEAR(chroma(shown)[0] / chroma(shown)[1], chroma(light)[0] / chroma(light)[1], 1e-4);
    EXPECT_LT(std::abs(chroma(shown)[0]), std::abs(chroma(light)[0]));
}

// A green of Rec. 2020 stays one, below the knee and above it.
TEST(EffectTonemap, Bt2390KeepsColoursOutsideOfRec709) {
    for (const TonemapOperator curve : {TonemapOperator::Bt2390, TonemapOperator::Bt2390Ictcp}) {
        for (const double light : {0.5, 3.0}) {
            const auto [r, g, b] =
                color_state_detail::solved(color_state_detail::rec2020, {0.2 * light, light, 0.2 * light});
            const Rgba out = tonemap_reference({r, g, b}, {}, {.curve = curve, .white = 8, .peak_nits = 600});
            EXPECT_LT(out.r, 0);
            const auto wide = color_state_detail::multiplied(color_state_detail::rec2020, {out.r, out.g, out.b});
            for (const double v : wide) EXPECT_GT(v, 0);
            EXPECT_GT(wide[1], 3 * wide[0]);
        }
    }
}

// What Polyphony Digital's own program (gt7_tone_mapping.cpp of August 2025, compiled by g++) makes of light in Rec.
// 2020 whose 1.0 is 100 cd/m2, in standard range and on displays of 1000 to 10000 cd/m2.
TEST(EffectTonemap, Gt7HasThePublishedValues) {
    struct Row {
        double peak_nits;
        std::array<double, 3> in, out;
    };
    constexpr std::array<Row, 16> table{{
        {250, {0.5, 1.23, 0.75}, {0.1996225, 0.49070296, 0.29956776}},
        {250, {12.3, 34.3, 56.9}, {1, 1, 1}},
        {250, {1504.7, 64.51, 0.5}, {1, 1, 0.7387512}},
        {250, {3, 3, 3}, {0.9179522, 0.91794854, 0.9179471}},
        {250, {0.538, 1.11, 0.444}, {0.21519808, 0.44393855, 0.17727005}},
        {250, {-0.1, 0.2, 0.1}, {0, 0.07863592, 0.036683112}},
        {250, {2.5, 2.5, 2.5}, {0.8351579, 0.8351547, 0.8351534}},
        {1000, {0.5, 1.23, 0.75}, {0.49982318, 1.2300007, 0.74999523}},
        {1000, {12.3, 34.3, 56.9}, {10, 10, 10}},
        {1000, {1504.7, 64.51, 0.5}, {10, 10, 6.7067475}},
        {1000, {20, 15, 5}, {10, 9.912016, 5.2493253}},
        {1000, {1e-5, 1e-5, 1e-5}, {4.7356957e-7, 4.7356775e-7, 4.73567e-7}},
        {4000, {12.3, 34.3, 56.9}, {11.354192, 30.071972, 40}},
        {4000, {1504.7, 64.51, 0.5}, {40, 40, 23.847712}},
        {10000, {12.3, 34.3, 56.9}, {12.277842, 34.24051, 56.39588}},
        {10000, {1504.7, 64.51, 0.5}, {91.72671, 68.02431, 42.575134}},
    }};
    for (const auto& [peak_nits, in, out] : table) {
        std::array<double, 3> wide = in;
        for (double& v : wide) v /= 2.5;
        const auto [r, g, b] = color_state_detail::solved(color_state_detail::rec2020, wide);
        const Rgba shown = tonemap_reference(
            {r, g, b}, {}, {.curve = TonemapOperator::Gt7, .peak_nits = static_cast<float>(peak_nits * 203 / 250)});
        const auto found = color_state_detail::multiplied(color_state_detail::rec2020, {shown.r, shown.g, shown.b});
        // Standard range ends at 1 there, too. The program computes in single precision.
        const double unit = peak_nits > 250 ? 2.5 : 1;
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(found[i] * unit, out[i], 1.5e-4 * std::max({out[0], out[1], out[2], 1e-3}))
                << peak_nits << " cd/m2, " << in[0] << " " << in[1] << " " << in[2] << ", channel " << i;
    }
}

TEST(EffectTonemap, GpuMatchesReferenceUpToAPeakBeyondWhite) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const float peak : {203.0f, 1000.0f, 4000.0f})
        test::expect_gpu_matches_reference(Tonemap{.curve = TonemapOperator::Bt2390, .white = 30, .peak_nits = peak},
                                           picture);
}

// A dark channel beside bright ones is a difference of large numbers: the bound is of the pixel's brightest.
TEST(EffectTonemap, GpuMatchesReferenceInIctcp) {
    for (const ReferenceImage& picture : {test::round_to_float(test::random_hdr(67, 41, 1)), hostile_picture()}) {
        for (const float peak : {203.0f, 1000.0f, 4000.0f}) {
            for (const TonemapOperator curve : {TonemapOperator::Bt2390Ictcp, TonemapOperator::Gt7}) {
                const Tonemap values{.curve = curve, .white = 30, .peak_nits = peak};
                const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(values); }, picture);
                const ReferenceImage expected = test::reference_of(values, picture);
                ASSERT_EQ(out.pixels.size(), expected.pixels.size());
                for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                    const Rgba &a = out.pixels[i], &b = expected.pixels[i];
                    const double bound = 5e-4 * std::max({b.r, b.g, b.b, 1e-3});
                    EXPECT_NEAR(a.r, b.r, bound) << i;
                    EXPECT_NEAR(a.g, b.g, bound) << i;
                    EXPECT_NEAR(a.b, b.b, bound) << i;
                    EXPECT_LE(std::max({a.r, a.g, a.b}),
                              peak / 203 * (curve == TonemapOperator::Gt7 ? 1.661 : 1.000001));
                }
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
