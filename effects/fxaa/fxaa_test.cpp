// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/fxaa.hpp>
#include <limits>
#include <string_view>

#include "compose/test_stacks/support.hpp"
#include "fxaa/fxaa_reference.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

constexpr std::array every_quality{FxaaQuality::Low, FxaaQuality::Medium, FxaaQuality::High, FxaaQuality::Ultra};

ReferenceImage developed(const Fxaa& fxaa, const ReferenceImage& picture, KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(fxaa); }, picture, {.kernels = kernels});
}

/// White below a line that falls by one pixel in `run`, black above it, without smoothing; or on its side.
ReferenceImage slanted_edge(std::uint32_t width, std::uint32_t height, std::uint32_t run, bool is_upright) {
    ReferenceImage picture(is_upright ? height : width, is_upright ? width : height, {0, 0, 0, 1});
    for (std::uint32_t along = 0; along < width; ++along)
        for (std::uint32_t across = height / 4 + along / run; across < height; ++across)
            picture.at(is_upright ? across : along, is_upright ? along : across) = {1, 1, 1, 1};
    return picture;
}

/// The largest difference between two neighbours along the edge: what the eye sees of a stair. The ends, where the
/// picture hides how the edge goes on, are left out.
double highest_stair(const ReferenceImage& picture, bool is_upright) {
    double highest = 0;
    const std::uint32_t along = is_upright ? picture.height : picture.width;
    const std::uint32_t across = is_upright ? picture.width : picture.height;
    for (std::uint32_t i = 40; i + 41 < along; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const Rgba& here = is_upright ? picture.at(j, i) : picture.at(i, j);
            const Rgba& next = is_upright ? picture.at(j, i + 1) : picture.at(i + 1, j);
            highest = std::max(highest, std::abs(here.g - next.g));
        }
    return highest;
}

/// A line of letters of 5x7 pixels, twice as large as drawn, on a flat field.
ReferenceImage text(Rgba field, Rgba ink) {
    constexpr std::array<std::string_view, 7> letters{"#...#.####..####..", "#...#.#...#.#.....", "#...#.#...#.#.....",
                                                      "#...#.#...#.####..", "#...#.#...#.#.....", "#...#.#...#.#.....",
                                                      ".###..####..####.."};
    ReferenceImage picture(60, 40, field);
    for (std::uint32_t y = 0; y < 14; ++y)
        for (std::uint32_t x = 0; x < 36; ++x)
            if (letters[y / 2][x / 2] == '#') picture.at(x + 12, y + 13) = ink;
    return picture;
}

bool is_flat_around(const ReferenceImage& picture, std::uint32_t x, std::uint32_t y) {
    for (const int dy : {-1, 0, 1})
        for (const int dx : {-1, 0, 1})
            if (picture.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy).g != picture.at(x, y).g) return false;
    return true;
}

TEST(EffectFxaa, StairsOfAOneToFortyEdgeFallFourfold) {
    for (const bool is_upright : {false, true})
        for (const FxaaQuality quality : every_quality) {
            SCOPED_TRACE(static_cast<int>(quality));
            const ReferenceImage picture = slanted_edge(400, 32, 40, is_upright);
            ASSERT_EQ(highest_stair(picture, is_upright), 1.0);
            for (const float subpixel : {0.0f, 0.75f}) {
                const Fxaa fxaa{.quality = quality, .subpixel = subpixel};
                EXPECT_LE(highest_stair(test::reference_of(fxaa, picture), is_upright), 0.25);
                EXPECT_LE(highest_stair(developed(fxaa, picture), is_upright), 0.25);
            }
        }
}

// The line through the middles of the steps is the edge that was meant: the covered part of each column is near it.
TEST(EffectFxaa, AStairBecomesTheLineThatItStandsFor) {
    const ReferenceImage picture = slanted_edge(400, 32, 10, false);
    const ReferenceImage out = developed({.subpixel = 0}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::uint32_t x = 40; x < 200; ++x) {
        double covered = 0;
        for (std::uint32_t y = 0; y < out.height; ++y) covered += out.at(x, y).g;
        EXPECT_NEAR(covered, out.height - (8 + (x + 0.5) / 10 - 0.5), 0.11) << x;
    }
}

// The eye sees light, so it is light that a pixel has as much of as the line covers, whatever the picture's numbers
// are.
TEST(EffectFxaa, AnEdgeInCodeValuesIsCoveredByLight) {
    const ReferenceImage picture = slanted_edge(400, 32, 10, false);
    const auto worst = [&](const ReferenceImage& out, const auto& light) {
        double most = out.pixels.empty() ? 1 : 0;
        for (std::uint32_t x = 40; x < 200; ++x) {
            double covered = 0;
            for (std::uint32_t y = 0; y < out.height; ++y) covered += light(out.at(x, y).g);
            most = std::max(most, std::abs(covered - (32 - (8 + (x + 0.5) / 10 - 0.5))));
        }
        return most;
    };
    const Fxaa fxaa{.subpixel = 0};
    EXPECT_LE(worst(test::develop([&](Composer& composer) { composer.add(fxaa, {.input = ui_layer}); }, picture,
                                  {.ui = &picture, .ui_format = VK_FORMAT_R32G32B32A32_SFLOAT}),
                    srgb_decoded),
              0.11);
    for (const ColorState& state : {srgb_color, pq_color}) {
        // Of the peak of the display, or of what its diffuse white is.
        ReferenceImage coded = picture;
        for (Rgba& pixel : coded.pixels)
            pixel = coded_reference({203 * pixel.r, 203 * pixel.g, 203 * pixel.b, 1}, state);
        const ReferenceImage out = fxaa_reference(&fxaa, {.picture = &coded, .source = &coded, .color = state});
        EXPECT_LE(worst(out, [&](double code) { return light_reference({code, code, code, 1}, state).g / 203; }), 0.11);
    }
}

TEST(EffectFxaa, CoverageMovesWithColour) {
    const EffectInfo* const encode = find_effect("encode");
    if (encode == nullptr) GTEST_SKIP() << "this build has no encode";
    ReferenceImage picture = slanted_edge(120, 32, 10, false);
    for (Rgba& pixel : picture.pixels) pixel = {0.5 * pixel.g, 0.25 * pixel.g, pixel.g, pixel.g};
    for (const bool is_encoded : {false, true}) {
        const ReferenceImage out = test::develop(
            [&](Composer& composer) {
                if (is_encoded) composer.add(*encode, nullptr);
                composer.add(Fxaa{.subpixel = 0});
            },
            picture, {.is_color_associated = true});
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        int partly = 0;
        for (const Rgba& pixel : out.pixels) {
            EXPECT_NEAR(pixel.b, pixel.a, 1e-5);
            EXPECT_NEAR(pixel.r, (is_encoded ? srgb_encoded(0.5) : 0.5) * pixel.a, 1e-5);
            partly += pixel.a > 0.01 && pixel.a < 0.99 ? 1 : 0;
        }
        EXPECT_GT(partly, 50);
    }
}

// Ends that lie an even number of pixels away are found by pixels alone, not by pairs.
TEST(EffectFxaa, TheDensestSearchFindsTheEndsOfShortSteps) {
    const ReferenceImage picture = slanted_edge(200, 32, 5, false);
    const auto worst = [&](FxaaQuality quality) {
        const ReferenceImage out = developed({.quality = quality, .subpixel = 0}, picture);
        double most = 0;
        for (std::uint32_t x = 30; x < 80; ++x) {
            double covered = 0;
            for (std::uint32_t y = 0; y < out.height; ++y) covered += out.at(x, y).g;
            most = std::max(most, std::abs(covered - (out.height - (8 + (x + 0.5) / 5 - 0.5))));
        }
        return most;
    };
    // As far from the line as exact ends bring it: 1/3 of a pixel for 2/5.
    EXPECT_NEAR(worst(FxaaQuality::Ultra), 1.0 / 15, 1e-4);
    EXPECT_GT(worst(FxaaQuality::High), 0.075);
}

TEST(EffectFxaa, TextLeavesItsFieldUnchanged) {
    const ReferenceImage picture = test::round_to_float(text({0.1, 0.2, 0.3, 0.5}, {0.9, 0.8, 0.7, 0.5}));
    const ReferenceImage out = developed({.subpixel = 1}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    int changed = 0;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba &before = picture.at(x, y), &after = out.at(x, y);
            EXPECT_EQ(after.a, before.a);
            if (is_flat_around(picture, x, y))
                EXPECT_TRUE(after.r == before.r && after.g == before.g && after.b == before.b) << x << "," << y;
            else
                changed += after.g != before.g ? 1 : 0;
        }
    EXPECT_GT(changed, 50);
}

TEST(EffectFxaa, FaintTextAndStraightEdgesAreNoStairs) {
    const ReferenceImage faint = test::round_to_float(text({0.5, 0.5, 0.5, 1}, {0.56, 0.57, 0.55, 1}));
    EXPECT_EQ(test::worst_difference(developed({.subpixel = 1}, faint), faint), 0.0);
    for (const bool is_upright : {false, true}) {
        const ReferenceImage straight = slanted_edge(64, 32, 1000, is_upright);
        // Weights that a filter of hardware gives equal texels need not add up to 1 in the last bit.
        EXPECT_LE(test::worst_difference(developed({.subpixel = 0}, straight), straight),
                  gpu::test::is_lavapipe() ? 0 : 0x1p-24);
    }
}

TEST(EffectFxaa, SubpixelTakesALonePixelAway) {
    ReferenceImage picture = test::uniform(9, 9, {0.2, 0.2, 0.2, 1});
    picture.at(4, 4) = {1, 1, 1, 1};
    double before = 2;
    for (const float subpixel : {0.0f, 0.25f, 0.75f, 1.0f}) {
        const double left = test::reference_of(Fxaa{.subpixel = subpixel}, picture).at(4, 4).g;
        EXPECT_LT(left, before);
        before = left;
    }
    EXPECT_NEAR(before, 0.2, 1e-12);
}

TEST(EffectFxaa, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const FxaaQuality quality : every_quality)
        for (const float subpixel : {0.0f, 0.75f}) {
            const Fxaa fxaa{.quality = quality, .subpixel = subpixel};
            const ReferenceImage expected = test::reference_of(fxaa, picture);
            // Whole pixels are read, so nothing but single precision parts them.
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
                EXPECT_LE(test::worst_difference(developed(fxaa, picture, stage), expected), 1e-5);
        }
}

TEST(EffectFxaa, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        EXPECT_LE(test::worst_difference(developed({}, picture), test::reference_of(Fxaa{}, picture)), 1e-5)
            << width << "x" << height;
    }
}

// A search may end at a broken pixel, but no number of it comes further than to its neighbours.
TEST(EffectFxaa, GpuNanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(48, 48, 4));
    picture.at(20, 20) = {nan, nan, nan, 1};
    picture.at(33, 21) = {infinity, infinity, -infinity, 1};
    // Of such light even the part that the neighbours are given is more than a half can hold.
    picture.at(10, 33) = {1e38, 1e38, 1e38, 1};
    const auto is_broken = [&](std::int64_t x, std::int64_t y) { return !(std::abs(picture.clamped(x, y).r) <= 1); };
    const ReferenceImage out = developed({.subpixel = 1}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::int64_t y = 0; y < 48; ++y)
        for (std::int64_t x = 0; x < 48; ++x) {
            if (is_broken(x, y)) continue;
            const bool is_beside =
                is_broken(x - 1, y) || is_broken(x + 1, y) || is_broken(x, y - 1) || is_broken(x, y + 1);
            const Rgba& color = out.clamped(x, y);
            for (const double value : {color.r, color.g, color.b})
                EXPECT_TRUE(value >= (is_beside ? -65504 : 0) && value <= (is_beside ? 65504 : 1)) << x << "," << y;
        }
}

TEST(EffectFxaa, BelongsBehindTheCurve) {
    const Domains accepts = effect_info(Fxaa{}).accepts;
    EXPECT_TRUE(accepts.contains(Domain::Encoded) && accepts.contains(Domain::DisplayLinear));
    EXPECT_FALSE(accepts.contains(Domain::SceneLinear));
}

}  // namespace
}  // namespace darkroom
