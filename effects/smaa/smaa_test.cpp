// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/smaa.hpp>
#include <functional>
#include <limits>
#include <numbers>

#include "compose/test_stacks/support.hpp"
#include "smaa/smaa_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array every_smaa_quality{SmaaQuality::Low, SmaaQuality::Medium, SmaaQuality::High, SmaaQuality::Ultra};

ReferenceImage smoothed(const Smaa& smaa, const ReferenceImage& picture, test::RunOptions options = {}) {
    return test::develop([&](Composer& composer) { composer.add(smaa); }, picture, options);
}

/// How much of each pixel lies inside, by `samples` x `samples` places.
ReferenceImage sampled(std::uint32_t side, int samples, const std::function<bool(double x, double y)>& is_inside) {
    ReferenceImage out(side, side);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            int inside = 0;
            for (int j = 0; j < samples; ++j)
                for (int i = 0; i < samples; ++i)
                    inside += is_inside(x + (i + 0.5) / samples, y + (j + 0.5) / samples) ? 1 : 0;
            const double part = double{1} * inside / (samples * samples);
            out.at(x, y) = {part, part, part, 1};
        }
    return out;
}

/// Of what does not lie at the borders, where nobody knows how an edge goes on.
double mean_error(const ReferenceImage& a, const ReferenceImage& b, std::uint32_t border) {
    double sum = 0;
    for (std::uint32_t y = border; y + border < a.height; ++y)
        for (std::uint32_t x = border; x + border < a.width; ++x) sum += std::abs(a.at(x, y).g - b.at(x, y).g);
    return sum / ((a.width - 2.0 * border) * (a.height - 2.0 * border));
}

/// A line of a width through the middle, at an angle; of width 0 all that lies to one side of it.
std::function<bool(double, double)> slanted_line(std::uint32_t side, double angle, double width, double shift) {
    const double middle = side / 2.0 + shift, across_x = -std::sin(angle), across_y = std::cos(angle);
    return [=](double x, double y) {
        const double distance = (x - middle) * across_x + (y - middle) * across_y;
        return width > 0 ? std::abs(distance) < width / 2 : distance > 0;
    };
}

/// Things with all that edges have: lines at several slopes, a disc, a frame, single pixels and letters.
ReferenceImage drawing(std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(width, height, {0.1, 0.2, 0.3, 0.5});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double u = x + 0.5, v = y + 0.5;
            Rgba& pixel = out.at(x, y);
            if (std::hypot(u - 0.3 * width, v - 0.4 * height) < 0.25 * height) pixel = {0.9, 0.5, 0.1, 0.5};
            if (std::abs(v - 0.31 * u - 4.2) < 0.7) pixel = {0.9, 0.9, 0.8, 0.5};
            if (std::abs(v - 1.4 * u + 30) < 1.2) pixel = {0.2, 0.8, 0.7, 0.5};
            if (std::abs(v + 0.8 * u - 60) < 1) pixel = {0.7, 0.1, 0.6, 0.5};
            if (x % 23 == 7 && y % 19 == 11) pixel = {1, 1, 1, 0.5};
            if (x > width - 12 && y > height - 15 && (x % 4 == 0 || y % 5 == 0)) pixel = {0.95, 0.9, 0.9, 0.5};
        }
    return test::round_to_float(out);
}

/// Are all steps of a line at this angle as long as each other, or nearly so? Then one sample a pixel cannot tell where
/// in a step it lies.
bool has_equal_steps(double degrees) {
    const double folded = std::abs(std::remainder(degrees, 90));
    const auto is_near = [&](double slope, double apart) {
        return std::abs(folded - std::atan(slope) * 180 / std::numbers::pi) < apart;
    };
    return is_near(0, 1) || is_near(1, 1) || is_near(1.0 / 2, 2.3) || is_near(1.0 / 3, 1) || is_near(2.0 / 3, 1);
}

TEST(EffectSmaa, LinesOfASlopeAreHalfAsFarFromTheTruthAsThoseOfTheFastOne) {
    const EffectInfo* const fast = find_effect("fxaa");
    if (fast == nullptr) GTEST_SKIP() << "this build has no fxaa";
    constexpr std::uint32_t side = 80, border = 24;
    double all_ours = 0, all_theirs = 0;
    for (int i = 0; i < 90; ++i) {
        const double degrees = 2 * (i + 0.37);
        double ours = 0, theirs = 0;
        for (const double width : {0.0, 1.0, 1.5, 2.0, 3.0})
            for (const int place : {0, 1}) {
                const auto line = slanted_line(side, degrees * std::numbers::pi / 180, width,
                                               std::fmod(i * 0.37 + place * 0.618, 1) - 0.5);
                const ReferenceImage picture = sampled(side, 1, line), truth = sampled(side, 8, line);
                ours += mean_error(test::reference_of(Smaa{}, picture), truth, border);
                const void* const defaults = fast->parameters.defaults.data();
                theirs +=
                    mean_error(fast->reference(defaults, {.picture = &picture, .source = &picture}), truth, border);
            }
        EXPECT_LE(ours / theirs, has_equal_steps(degrees) ? 0.75 : 0.5) << degrees << " degrees";
        all_ours += ours, all_theirs += theirs;
    }
    EXPECT_LE(all_ours, 0.35 * all_theirs);
    RecordProperty("ratio", std::to_string(all_ours / all_theirs));
}

TEST(EffectSmaa, AStairBecomesTheLineThatItStandsFor) {
    // Steps of one and two pixels, and of two and three: a column is covered as far as the line says.
    for (const double slope : {0.4, 2.0 / 3, 1.5}) {
        const auto line = [&](double x, double y) { return y - 40.2 > slope * (x - 40.2); };
        const ReferenceImage picture = sampled(80, 1, line), truth = sampled(80, 8, line);
        const ReferenceImage out = test::reference_of(Smaa{}, picture);
        double worst = 0;
        for (std::uint32_t x = 25; x < 55; ++x) {
            double covered = 0, expected = 0;
            for (std::uint32_t y = 0; y < 80; ++y) covered += out.at(x, y).g, expected += truth.at(x, y).g;
            worst = std::max(worst, std::abs(covered - expected));
        }
        EXPECT_LE(worst, 0.3) << slope;
    }
}

/// How far from a line of a pixel's width the light of each column lies, from the farthest above to the farthest below.
double stairs_of(const Smaa& smaa, double degrees, bool is_upright) {
    constexpr std::uint32_t side = 120;
    const double slope = std::tan(degrees * std::numbers::pi / 180);
    const auto line = [&](double x, double y) {
        const double along = is_upright ? y : x, across = is_upright ? x : y;
        return std::abs(across - 60.3 - slope * (along - 60)) * std::cos(degrees * std::numbers::pi / 180) < 0.5;
    };
    const ReferenceImage out = test::reference_of(smaa, sampled(side, 1, line));
    double least = 1e9, most = -1e9;
    for (std::uint32_t along = 30; along < 90; ++along) {
        double light = 0, middle = 0;
        for (std::uint32_t across = 0; across < side; ++across) {
            const double value = is_upright ? out.at(across, along).g : out.at(along, across).g;
            light += value, middle += value * (across + 0.5);
        }
        const double apart = middle / light - (60.3 + slope * (along + 0.5 - 60));
        least = std::min(least, apart), most = std::max(most, apart);
    }
    return most - least;
}

TEST(EffectSmaa, LinesAPixelWideHaveNoStairs) {
    for (const double degrees : {2.5, 3.5, 5.0, 7.3, 9.0, 12.0, -5.0, -9.0})
        for (const bool is_upright : {false, true})
            EXPECT_LT(stairs_of({}, degrees, is_upright), 0.2) << degrees << (is_upright ? " upright" : "");
}

TEST(EffectSmaa, WhatIsSmoothAlreadyKeepsItsBits) {
    // A soft shadow's edge, which light falls off behind over three pixels and more.
    for (const double width : {3.0, 4.5, 8.0})
        for (int i = 0; i < 45; ++i) {
            const double angle = 8 * (i + 0.37) * std::numbers::pi / 180;
            ReferenceImage picture(48, 48);
            for (std::uint32_t y = 0; y < 48; ++y)
                for (std::uint32_t x = 0; x < 48; ++x) {
                    // Along the axis that it falls off by most.
                    const double scale = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
                    const double distance = ((x - 23.7) * std::cos(angle) + (y - 23.7) * std::sin(angle)) / scale;
                    const double value = std::clamp(0.5 + distance / width, 0.0, 1.0);
                    picture.at(x, y) = {value, value, value, 1};
                }
            // At the borders half of it is not seen.
            EXPECT_EQ(mean_error(test::reference_of(Smaa{}, picture), picture, 8), 0) << width << ' ' << i;
        }
}

// As light: at a mean of half a pixel's coverage codes would be off by 0.29 of it.
TEST(EffectSmaa, LinesInCodeValuesAreCoveredByLight) {
    constexpr std::uint32_t side = 80, border = 24;
    double light = 0, codes = 0, none = 0;
    for (int i = 0; i < 24; ++i)
        for (const double width : {0.0, 1.0, 2.0}) {
            const auto line = slanted_line(side, 7.5 * (i + 0.37) * std::numbers::pi / 180, width, i * 0.37 - 4);
            // Black and white are the same numbers in both.
            const ReferenceImage picture = sampled(side, 1, line), truth = sampled(side, 8, line);
            const Smaa smaa;
            const auto error = [&](const ColorState& state) {
                ReferenceImage out = smaa_reference(&smaa, {.picture = &picture, .source = &picture, .color = state});
                for (Rgba& pixel : out.pixels) pixel.g = srgb_decoded(pixel.g);
                return mean_error(out, truth, border);
            };
            light += error(srgb_color), codes += error({}), none += mean_error(picture, truth, border);
        }
    EXPECT_LT(light, 0.5 * codes);
    EXPECT_LT(light, 0.35 * none);
}

TEST(EffectSmaa, GpuMixesLightAndCoverage) {
    const EffectInfo* const encode = find_effect("encode");
    if (encode == nullptr) GTEST_SKIP() << "this build has no encode";
    ReferenceImage picture = drawing(97, 61);
    for (const bool is_associated : {false, true}) {
        if (is_associated)
            for (Rgba& pixel : picture.pixels) {
                const double alpha = pixel.g > 0.45 ? 1 : pixel.g > 0.3 ? 0.5 : 0;
                pixel = {pixel.r * alpha, pixel.g * alpha, pixel.b * alpha, alpha};
            }
        picture = test::round_to_float(picture);
        ReferenceImage coded = picture;
        const auto without_alpha = [](double value, double alpha) {
            return alpha > 0 ? alpha * srgb_encoded(value / alpha) : srgb_encoded(value);
        };
        for (Rgba& p : coded.pixels) {
            const double alpha = is_associated ? p.a : 1;
            p = {without_alpha(p.r, alpha), without_alpha(p.g, alpha), without_alpha(p.b, alpha), p.a};
        }
        ColorState state = srgb_color;
        state.is_associated = is_associated;
        const Smaa smaa;
        const ReferenceImage expected = smaa_reference(&smaa, {.picture = &coded, .source = &coded, .color = state});
        for (const bool fuse : {true, false}) {
            const ReferenceImage out = test::develop(
                [&](Composer& composer) {
                    composer.add(*encode, nullptr);
                    composer.add(smaa);
                },
                picture, {.fuse = fuse, .is_color_associated = is_associated});
            // A code of the weights in the dark, where a step of light is many of codes.
            EXPECT_LE(test::worst_difference(out, expected), 0.03);
            if (!is_associated) continue;
            for (const Rgba& pixel : out.pixels) EXPECT_LE(std::max({pixel.r, pixel.g, pixel.b}), pixel.a + 1e-5);
        }
    }
}

TEST(EffectSmaa, FlatFieldsAndStraightEdgesKeepTheirBits) {
    const ReferenceImage flat = test::round_to_float(test::uniform(33, 19, {0.3, 0.7, 0.1, 0.25}));
    EXPECT_EQ(test::worst_difference(smoothed({}, flat), flat), 0);
    for (const bool is_upright : {false, true})
        for (const std::uint32_t width : {1u, 2u, 9u}) {
            ReferenceImage straight(40, 40, {0, 0, 0, 1});
            for (std::uint32_t along = 0; along < 40; ++along)
                for (std::uint32_t across = 15; across < 15 + width; ++across)
                    straight.at(is_upright ? across : along, is_upright ? along : across) = {1, 1, 1, 1};
            for (const SmaaQuality quality : every_smaa_quality)
                EXPECT_EQ(test::worst_difference(smoothed({.quality = quality}, straight), straight), 0) << width;
        }
}

TEST(EffectSmaa, CornersStaySharp) {
    ReferenceImage frame(48, 48, {0, 0, 0, 1});
    for (std::uint32_t y = 12; y < 36; ++y)
        for (std::uint32_t x = 12; x < 36; ++x) frame.at(x, y) = {1, 1, 1, 1};
    const double kept = test::worst_difference(test::reference_of(Smaa{.corner_rounding = 0}, frame), frame);
    const double rounded = test::worst_difference(test::reference_of(Smaa{.corner_rounding = 1}, frame), frame);
    EXPECT_EQ(kept, 0);
    EXPECT_GT(rounded, 0.3);
    EXPECT_LT(test::worst_difference(test::reference_of(Smaa{}, frame), frame), 0.15);
}

TEST(EffectSmaa, FaintEdgesAreSmoothedWhereTheDepthJumps) {
    // A step of 0.08, half of which lies before a thing that is near.
    ReferenceImage picture(64, 32), depth(64, 32, {20, 0, 0, 1});
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const bool is_below = y > 8 + x / 8;
            const double value = is_below ? 0.58 : 0.5;
            picture.at(x, y) = {value, value, value, 1};
            if (is_below && x < 32) depth.at(x, y).r = 5;
        }
    picture = test::round_to_float(picture);
    const test::RunOptions options{.depth = &depth};
    const Smaa by_depth{.predication = 1};
    const ReferenceImage expected = test::scene_reference_of(by_depth, picture, options);
    int near = 0, far = 0;
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            (x < 32 ? near : far) += expected.at(x, y).g != picture.at(x, y).g ? 1 : 0;
    EXPECT_GT(near, 20);
    EXPECT_LT(far, 3);
    EXPECT_LE(test::worst_difference(smoothed(by_depth, picture, options), expected), 0.08 * 1.1 / 255);
    // Without depth, or where it is not asked for, nothing is seen.
    EXPECT_EQ(test::worst_difference(smoothed(by_depth, picture), picture), 0);
    EXPECT_EQ(test::worst_difference(smoothed({}, picture, options), picture), 0);
}

TEST(EffectSmaa, ColorFindsWhatLumaDoesNot) {
    ReferenceImage picture(48, 32);
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 48; ++x)
            picture.at(x, y) = y > 8 + x / 5 ? Rgba{0.6, 0.3, 0.5, 1} : Rgba{0.2, 0.5, 0.5, 1};
    EXPECT_EQ(test::worst_difference(test::reference_of(Smaa{}, picture), picture), 0);
    EXPECT_GT(test::worst_difference(test::reference_of(Smaa{.detection = SmaaDetection::Color}, picture), picture),
              0.05);
}

TEST(EffectSmaa, GpuMatchesReference) {
    // Weights are kept in 8 bits: by one code of them, where rounding turns, a pixel may be another.
    for (const ReferenceImage& picture : {drawing(97, 61), test::round_to_float(test::random_display(67, 41, 1))})
        for (const SmaaQuality quality : every_smaa_quality)
            for (const SmaaDetection detection : {SmaaDetection::Luma, SmaaDetection::Color}) {
                const Smaa smaa{.quality = quality, .detection = detection};
                const ReferenceImage expected = test::reference_of(smaa, picture);
                for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
                    EXPECT_LE(test::worst_difference(smoothed(smaa, picture, {.kernels = stage}), expected), 2.1 / 255)
                        << static_cast<int>(quality);
            }
}

TEST(EffectSmaa, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}, {5u, 3u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        EXPECT_LE(test::worst_difference(smoothed({}, picture), test::reference_of(Smaa{}, picture)), 2.1 / 255)
            << width << "x" << height;
    }
}

TEST(EffectSmaa, GpuNanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = drawing(64, 48);
    picture.at(20, 20) = {nan, nan, nan, 1};
    picture.at(33, 21) = {infinity, infinity, -infinity, 1};
    picture.at(10, 33) = {1e38, 1e38, 1e38, 1};
    const auto is_broken = [&](std::int64_t x, std::int64_t y) { return !(std::abs(picture.clamped(x, y).r) <= 1); };
    const ReferenceImage out = smoothed({}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::int64_t y = 0; y < 48; ++y)
        for (std::int64_t x = 0; x < 64; ++x) {
            if (is_broken(x, y)) continue;
            const bool is_beside =
                is_broken(x - 1, y) || is_broken(x + 1, y) || is_broken(x, y - 1) || is_broken(x, y + 1);
            const Rgba& color = out.clamped(x, y);
            for (const double value : {color.r, color.g, color.b})
                EXPECT_TRUE(value >= (is_beside ? -65504 : 0) && value <= (is_beside ? 65504 : 1)) << x << "," << y;
        }
}

TEST(EffectSmaa, LeavesTheTextOfAnInterfaceAlone) {
    const EffectInfo* const over = find_effect("ui_composite");
    if (over == nullptr) GTEST_SKIP() << "this build has no ui_composite";
    const ReferenceImage picture = drawing(64, 48);
    // Strokes a pixel wide, as small text has them: opaque, or nothing.
    ReferenceImage ui(64, 48, {0, 0, 0, 0});
    for (std::uint32_t y = 8; y < 40; ++y)
        for (std::uint32_t x = 8; x < 56; ++x)
            if (x % 5 == y % 5 || x % 7 == 3) ui.at(x, y) = {1, 1, 1, 1};
    const ReferenceImage out = test::develop(
        [&](Composer& composer) {
            composer.add(Smaa{});
            composer.add(*over, nullptr);
        },
        picture, {.ui = &ui});
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    const ReferenceImage world = test::reference_of(Smaa{}, picture);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const double expected = ui.pixels[i].a > 0 ? 1 : world.pixels[i].g;
        EXPECT_NEAR(out.pixels[i].g, expected, ui.pixels[i].a > 0 ? 0 : 2.1 / 255) << i;
    }
}

TEST(EffectSmaa, BelongsBehindTheCurve) {
    const Domains accepts = effect_info(Smaa{}).accepts;
    EXPECT_TRUE(accepts.contains(Domain::Encoded) && accepts.contains(Domain::DisplayLinear));
    EXPECT_FALSE(accepts.contains(Domain::SceneLinear));
}

}  // namespace
}  // namespace darkroom
