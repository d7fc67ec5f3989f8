// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <darkroom/effects/color_grade.hpp>
#include <limits>
#include <span>
#include <vector>

#include "color_grade/color_grade_reference.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

Curve curve_of(std::initializer_list<std::array<float, 2>> points) {
    Curve curve;
    for (const auto& [x, y] : points) {
        curve.x[curve.count] = x;
        curve.y[curve.count++] = y;
    }
    return curve;
}

/// As many points as there can be, and none on a straight line with the next.
Curve long_curve() {
    Curve curve;
    for (; curve.count < Curve::capacity; ++curve.count) {
        const auto i = static_cast<float>(curve.count);
        curve.x[curve.count] = i * 1.25f - 12.0f;
        curve.y[curve.count] = i * 1.25f - 12.0f + (curve.count % 2 == 0 ? 0.7f : -0.4f);
    }
    return curve;
}

const std::vector<ColorGrade> settings{
    {.temperature = 3200, .tint = 20},
    {.temperature = 9000, .tint = -40},
    {.mixer_red = {0.5f, 0.6f, -0.1f}, .mixer_green = {0, 0.9f, 0.2f}, .mixer_blue = {-0.3f, 0.1f, 1.1f}},
    {.shadows = {0.5f, 0.8f, 1.4f}, .midtones = {1, 1.1f, 0.9f}, .highlights = {1.5f, 1.2f, 0.4f}},
    {.shadows = {0.5f, 1, 1}, .highlights = {1, 1, 2}, .shadows_range = {0.2f, 0.8f}, .highlights_range = {0.1f, 2}},
    {.lift = {0.02f, 0, -0.03f}, .gamma = {1.2f, 1, 0.8f}, .gain = {1.1f, 0.9f, 2}},
    {.contrast = 1.6f},
    {.contrast = 0, .pivot = 0.5f},
    {.contrast = 0.7f, .pivot = 1},
    {.curve_red = curve_of({{-8, -9}, {0, 0.5f}, {6, 5}}), .curve_blue = curve_of({{0, 1}})},
    {.curve_red = long_curve(), .curve_green = long_curve(), .curve_blue = long_curve()},
    {.hue = 130},
    {.vibrance = 0.8f, .saturation = 0.7f},
    {.vibrance = -1, .saturation = 2},
    {.temperature = 7500,
     .shadows = {0.9f, 1, 1.2f},
     .gamma = {1.1f, 1.1f, 1.1f},
     .contrast = 1.2f,
     .curve_green = curve_of({{-4, -4.5f}, {0, 0}, {4, 3.5f}}),
     .hue = -10,
     .vibrance = 0.3f}};

Rgba graded(Rgba color, const ColorGrade& grade) { return color_grade_reference(color, {}, grade); }
double luminance(const Rgba& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }
/// Linear Rec. 709 of a light of luminance 1.
Rgba light_of(const color_grade::Chromaticity& c) {
    const auto [r, g, b] = color_grade::product(color_grade::inverse(color_grade::rec709_to_xyz),
                                                color_grade::Triple{c.x / c.y, 1, (1 - c.x - c.y) / c.y});
    return {r, g, b, 1};
}

TEST(EffectColorGrade, DaylightIsThePublishedLocus) {
    struct Known {
        double kelvin, x, y;
    };
    // CIE 15: D50, D55, D65 and D75, whose temperatures are 1.4388 / 1.438 of their names.
    for (const auto& [kelvin, x, y] : {Known{5003, 0.34567, 0.35850},
                                       {5503, 0.33242, 0.34743},
                                       {6504, 0.31272, 0.32903},
                                       {7504, 0.29902, 0.31485}}) {
        EXPECT_NEAR(color_grade::daylight(kelvin).x, x, 2e-4) << kelvin;
        EXPECT_NEAR(color_grade::daylight(kelvin).y, y, 2e-4) << kelvin;
    }
    // Black bodies of 2500 K and 3200 K: what the continuation stays near.
    EXPECT_NEAR(color_grade::daylight(2500).x, 0.4770, 0.014);
    EXPECT_NEAR(color_grade::daylight(3200).x, 0.4234, 0.002);
    for (double kelvin = 2500; kelvin < 25000; kelvin *= 1.01)
        EXPECT_GT(color_grade::daylight(kelvin).x, color_grade::daylight(kelvin * 1.01).x) << kelvin;
}

TEST(EffectColorGrade, TemperatureMovesTheWhiteAlongTheLocus) {
    for (const float kelvin : {2500.0f, 3200.0f, 5000.0f, 6504.0f, 9000.0f, 25000.0f}) {
        const Rgba white = graded(light_of(color_grade::daylight(double{kelvin})), {.temperature = kelvin});
        EXPECT_NEAR(white.r, 1, 2e-3) << kelvin;
        EXPECT_NEAR(white.g, 1, 2e-3) << kelvin;
        EXPECT_NEAR(white.b, 1, 2e-3) << kelvin;
    }
    double before = 0;
    for (const float kelvin : {2500.0f, 4000.0f, 6504.0f, 12000.0f, 25000.0f}) {
        const Rgba white = graded({1, 1, 1, 1}, {.temperature = kelvin});
        EXPECT_GT(white.r / white.b, before) << kelvin;
        before = white.r / white.b;
    }
    const Rgba magenta = graded({1, 1, 1, 1}, {.tint = 30}), green = graded({1, 1, 1, 1}, {.tint = -30});
    EXPECT_GT(std::min(magenta.r, magenta.b), 1.05 * magenta.g);
    EXPECT_LT(1.05 * std::max(green.r, green.b), green.g);
}

TEST(EffectColorGrade, GreyStaysGreyUnderNeutralBalance) {
    const Curve curve = curve_of({{-6, -7}, {0, 0.3f}, {5, 4}});
    const ColorGrade grade{.midtones = {1.2f, 1.2f, 1.2f},
                           .lift = {0.01f, 0.01f, 0.01f},
                           .gamma = {1.3f, 1.3f, 1.3f},
                           .contrast = 1.4f,
                           .curve_red = curve,
                           .curve_green = curve,
                           .curve_blue = curve,
                           .hue = 70,
                           .vibrance = 0.6f,
                           .saturation = 1.7f};
    for (const double grey : {0.0, 0.001, 0.18, 0.5, 7.0, 300.0}) {
        const Rgba out = graded({grey, grey, grey, 1}, grade);
        EXPECT_NEAR(out.r, out.g, 1e-12 + 1e-3 * out.g);
        EXPECT_NEAR(out.b, out.g, 1e-12 + 1e-3 * out.g);
    }
}

TEST(EffectColorGrade, RangesHoldTheirOwnTones) {
    const ColorGrade grade{.shadows = {0.5f, 1, 1}, .midtones = {1, 2, 1}, .highlights = {1, 1, 3}};
    const auto expect_scaled = [&](double grey, double r, double g, double b) {
        const Rgba out = graded({grey, grey, grey, 1}, grade);
        EXPECT_NEAR(out.r / grey, r, 2e-3) << grey;
        EXPECT_NEAR(out.g / grey, g, 2e-3) << grey;
        EXPECT_NEAR(out.b / grey, b, 2e-3) << grey;
    };
    expect_scaled(1e-4, 0.5, 1, 1);
    expect_scaled(0.4, 1, 2, 1);
    expect_scaled(5, 1, 1, 3);
    // Half way through a range both sides count alike.
    expect_scaled(0.15, 0.75, 1.5, 1);
    expect_scaled(0.775, 1, 1.5, 2);
}

TEST(EffectColorGrade, LiftGammaGainAreOffsetPowerAndSlope) {
    const ColorGrade grade{.lift = {0.1f, 0, -0.5f}, .gamma = {2, 1, 1}, .gain = {1.5f, 3, 1}};
    const Rgba out = graded({0.1, 0.1, 0.2, 1}, grade);
    EXPECT_NEAR(out.r, std::sqrt(0.25), 2e-3);
    EXPECT_NEAR(out.g, 0.3, 1e-3);
    EXPECT_NEAR(out.b, -0.3, 1e-3);
}

TEST(EffectColorGrade, ContrastTurnsAboutThePivotInStops) {
    const auto grey = [](double value, const ColorGrade& grade) { return graded({value, value, value, 1}, grade).g; };
    for (const float pivot : {0.18f, 1.0f}) {
        const ColorGrade grade{.contrast = 1.5f, .pivot = pivot};
        EXPECT_NEAR(grey(double{pivot}, grade) / double{pivot}, 1, 1e-3);
        EXPECT_NEAR(grey(4 * double{pivot}, grade) / double{pivot}, 8, 1e-2);
        EXPECT_NEAR(grey(double{pivot} / 4, grade) / double{pivot}, 1.0 / 8, 1e-3);
    }
    EXPECT_NEAR(grey(3, {.contrast = 0}), 0.18, 1e-3);
    EXPECT_EQ(grey(0, {.contrast = 0.5f}), 0.0);
}

TEST(EffectColorGrade, CurvesGoThroughTheirPointsInStops) {
    const ColorGrade grade{.curve_green = curve_of({{-4, -5}, {0, 1}, {2, 2}})};
    const auto green = [&](double stops) {
        // The least of a colour on its own, for saturation does not touch it.
        return std::log2(graded({0.18, 0.18 * std::exp2(stops), 0.18, 1}, grade).g / 0.18);
    };
    EXPECT_NEAR(green(-4), -5, 2e-3);
    EXPECT_NEAR(green(0), 1, 2e-3);
    EXPECT_NEAR(green(2), 2, 2e-3);
    // Beyond the ends the light moves as it does there, so black stays black.
    EXPECT_NEAR(green(-6), -7, 2e-3);
    EXPECT_NEAR(green(5), 5, 2e-3);
    EXPECT_EQ(graded({0, 0, 0, 1}, grade).g, 0.0);
}

TEST(EffectColorGrade, CurvesHaveNoKinksAndNeverOvershoot) {
    constexpr double step = 1e-3;
    for (const Curve& curve : {curve_of({{-4, -5}, {0, 1}, {2, 2}}), curve_of({{-6, -5}, {-1, -1}, {0, -1}, {3, 4}}),
                               curve_of({{-2, 0}, {1, 1}})}) {
        double before = color_grade_reference_curve(curve, -8 - step), slope = 1;
        for (double stops = -8; stops < 6; stops += step) {
            const double value = color_grade_reference_curve(curve, stops), now = (value - before) / step;
            EXPECT_GE(now, -1e-9) << stops << ": the points rise";
            EXPECT_NEAR(now, slope, 0.02) << stops;
            slope = now;
            before = value;
        }
        for (std::size_t i = 0; i < curve.count; ++i)
            EXPECT_NEAR(color_grade_reference_curve(curve, double{curve.x[i]}), double{curve.y[i]}, 1e-12);
    }
}

TEST(EffectColorGrade, HueAndSaturationKeepLuminance) {
    for (const Rgba& color : test::random_display(20, 20, 8).pixels) {
        for (const float hue : {-120.0f, 33.0f, 180.0f})
            EXPECT_NEAR(luminance(graded(color, {.hue = hue})), luminance(color), 2e-4);
        EXPECT_NEAR(luminance(graded(color, {.vibrance = 0.5f, .saturation = 0.3f})), luminance(color), 2e-4);
        const Rgba there = graded(color, {.hue = 75}), back = graded(there, {.hue = -75});
        EXPECT_NEAR(back.r, color.r, 1e-3);
        EXPECT_NEAR(back.b, color.b, 1e-3);
        const Rgba grey = graded(color, {.saturation = 0});
        EXPECT_NEAR(grey.r, grey.b, 1e-12);
    }
    // A third of a turn makes red green: the axis of greys is the same for all three.
    const Rgba turned = graded({1, 0, 0, 1}, {.hue = 120});
    EXPECT_NEAR(turned.r, turned.b, 1e-3);
    EXPECT_GT(turned.g, turned.r + 0.9);
}

TEST(EffectColorGrade, VibranceSparesWhatIsColourful) {
    const auto spread = [](const Rgba& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); };
    const Rgba pale{0.5, 0.45, 0.45, 1}, vivid{0.5, 0.02, 0.02, 1};
    const ColorGrade more{.vibrance = 1}, less{.vibrance = -1};
    EXPECT_GT(spread(graded(pale, more)) / spread(pale), 1.8);
    EXPECT_LT(spread(graded(vivid, more)) / spread(vivid), 1.1);
    EXPECT_LT(spread(graded(pale, less)) / spread(pale), 0.2);
    EXPECT_GT(spread(graded(vivid, less)) / spread(vivid), 0.9);
}

TEST(EffectColorGrade, MixerMakesChannelsOfAllThree) {
    const Rgba out = graded({0.1, 0.2, 0.4, 0.3}, {.mixer_red = {0, 0, 1}, .mixer_blue = {1, 1, -0.5f}});
    EXPECT_NEAR(out.r, 0.4, 1e-3);
    EXPECT_NEAR(out.g, 0.2, 1e-3);
    EXPECT_NEAR(out.b, 0.1, 1e-3);
    EXPECT_EQ(out.a, 0.3);
}

TEST(EffectColorGrade, GpuNeutralChangesNothingAndEverythingElseDoes) {
    const ColorGrade neutral, straight{.curve_red = curve_of({{-8, -8}, {3, 3}})};
    const EffectInfo& info = effect_info(neutral);
    EXPECT_TRUE(info.is_identity(&neutral));
    EXPECT_TRUE(info.is_identity(&straight));
    for (const ColorGrade& grade : settings) EXPECT_FALSE(info.is_identity(&grade));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(neutral); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

/// The largest part of what rounding can explain, by which GPU and reference differ.
double worst_part(const ReferenceImage& gpu, const ReferenceImage& expected) {
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < gpu.pixels.size(); ++i) {
        const Rgba &got = gpu.pixels[i], &want = expected.pixels[i];
        const double largest = std::max({std::abs(want.r), std::abs(want.g), std::abs(want.b), 0x1p-10});
        for (const double d : {got.r - want.r, got.g - want.g, got.b - want.b, got.a - want.a})
            worst = std::isfinite(d) ? std::max(worst, std::abs(d) / largest) : 1e9;
    }
    return worst;
}

TEST(EffectColorGrade, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{67u, 41u}, {1u, 1u}, {1u, 7u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(width, height, 1));
        for (std::size_t i = 0; i < settings.size(); ++i) {
            SCOPED_TRACE(i);
            const ReferenceImage expected = test::reference_of(settings[i], picture);
            // Stops of up to 16 are known to 2^-20, and steep curves double that; what mixes the channels is a part of
            // the largest.
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
                EXPECT_LE(worst_part(test::develop([&](Composer& composer) { composer.add(settings[i]); }, picture,
                                                   {.kernels = stage}),
                                     expected),
                          0x1p-18);
        }
    }
}

// Values of a frame come from overrides, too, which no one checks together.
TEST(EffectColorGrade, GpuSurvivesEverything) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture(2, 2, {nan, nan, nan, 1});
    picture.at(1, 0) = {infinity, 1, -infinity, 1};
    picture.at(0, 1) = {0, 0, 0, 1};
    picture.at(1, 1) = {65504, -65504, 1e-8, 1};
    std::vector<ColorGrade> grades = settings;
    grades.push_back({.shadows_range = {64, 0}, .highlights_range = {1, 0}, .gamma = {0.1f, 0.1f, 10}, .contrast = 4});
    grades.push_back({.curve_red = curve_of({{0, 16}, {1e-5f, -16}}), .saturation = 4});
    for (const ColorGrade& grade : grades) {
        const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(ColorGrade) / 4>>(grade);
        const ReferenceImage out = test::develop(
            [&](Composer& composer) {
                const Handle entry = composer.add(ColorGrade{});
                for (const ParamInfo& row : effect_info(ColorGrade{}).parameters.rows)
                    EXPECT_TRUE(
                        composer.set_override(entry, row.name, "test", std::span(words).subspan(row.word, row.words)));
            },
            picture);
        for (const Rgba& color : out.pixels)
            EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b));
        if (out.pixels.size() == 4 && grade.lift.r == 0) {
            EXPECT_EQ(out.at(0, 1).r + out.at(0, 1).g + out.at(0, 1).b, 0.0);
        }
    }
}

}  // namespace
}  // namespace darkroom
