// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/tonemap.hpp>

#include <array>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "tonemap/tonemap_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array all_operators{
    TonemapOperator::AcesNarkowicz, TonemapOperator::AcesHill, TonemapOperator::ReinhardExtended,
    TonemapOperator::Hable,         TonemapOperator::Agx,      TonemapOperator::KhronosPbrNeutral,
    TonemapOperator::Linear,
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

void expect_in_unit_range(const ReferenceImage& picture) {
    ASSERT_FALSE(picture.pixels.empty());
    for (const Rgba& color : picture.pixels) {
        for (const double value : {color.r, color.g, color.b}) {
            // Fails for NaN, too.
            EXPECT_TRUE(value >= 0.0 && value <= 1.0) << value;
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
        expect_in_unit_range(test::reference_of(Tonemap{.curve = curve}, hostile_picture()));
        expect_in_unit_range(test::reference_of(Tonemap{.curve = curve}, test::random_hdr(64, 64, 3)));
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
        expect_in_unit_range(out);
        EXPECT_LE(test::worst_half_ulps(out, test::reference_of(Tonemap{.curve = curve}, hostile_picture())), 2.0)
            << static_cast<int>(curve);
    }
}

TEST(EffectTonemap, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const TonemapOperator curve : all_operators) {
        SCOPED_TRACE(static_cast<int>(curve));
        test::expect_gpu_matches_reference(Tonemap{.curve = curve}, picture);
    }
    test::expect_gpu_matches_reference(Tonemap{.curve = TonemapOperator::ReinhardExtended, .white = 0.5f}, picture);
}

}  // namespace
}  // namespace darkroom
