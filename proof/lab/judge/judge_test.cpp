// SPDX-License-Identifier: MIT
#include "lab/judge/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace darkroom {
namespace {

constexpr std::uint32_t width = 32, height = 24;
constexpr Matrix no_turn{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

ShownCodes even_codes(float code) {
    ShownCodes out(width, height);
    std::fill(out.values.begin(), out.values.end(), code);
    return out;
}

/// A wall at 10 m, nothing moves.
FrameFile still_frame() {
    FrameFile frame;
    frame.depth = Plane<1>(width, height);
    std::fill(frame.depth->values.begin(), frame.depth->values.end(), 10.0F);
    frame.velocity = Plane<2>(width, height);
    frame.camera.world_to_camera = frame.camera.previous_world_to_camera = no_turn;
    frame.camera.projection = perspective(60, double(width) / height);
    return frame;
}

RegionMap map_of(RegionFinder& finder, const FrameFile& frame, const ShownCodes& codes) {
    Result<RegionMap> map = finder.find(frame, codes);
    EXPECT_TRUE(map) << map.error().text;
    return std::move(*map);
}

std::size_t at(std::uint32_t x, std::uint32_t y) { return std::size_t{y} * width + x; }

TEST(ImageJudge, CodesAreThoseOfTheMapThatIsSaid) {
    Picture light(3, 1);
    const std::array<float, 12> pixels{1, 0.25F, 0, 1, -2, NAN, INFINITY, 0, 3, 3, 3, 1};
    std::copy(pixels.begin(), pixels.end(), light.pixels.begin());
    const ShownCodes codes = codes_of_light(light);
    const auto code = [](double t) {
        return std::nearbyint(255 * (t <= 0.0031308 ? 12.92 * t : 1.055 * std::pow(t, 1 / 2.4) - 0.055));
    };
    EXPECT_EQ(codes.at(0, 0)[0], code(0.5));
    EXPECT_EQ(codes.at(0, 0)[1], code(0.125));
    EXPECT_EQ(codes.at(0, 0)[2], 0);
    EXPECT_EQ(codes.at(1, 0)[0], 0) << "below 0";
    EXPECT_EQ(codes.at(1, 0)[1], 0) << "NaN";
    EXPECT_EQ(codes.at(1, 0)[2], 255) << "infinite";
    EXPECT_EQ(codes.at(2, 0)[1], code(0.75));
    Picture encoded(1, 1);
    encoded.pixels = {0.5F, 2, -1, 1};
    EXPECT_EQ(codes_of_display(encoded).values, (std::vector<float>{128, 255, 0}));
}

TEST(ImageJudge, ErrorsAndFlickerAreTheirArithmetic) {
    RegionFinder finder;
    Judge judge;
    const ShownCodes truth = even_codes(100);
    // Two codes too bright, then two too dark: the error changes by four.
    for (const auto& [number, code] : {std::pair(5, 102.0F), std::pair(6, 98.0F)})
        ASSERT_TRUE(judge.add(number, truth, even_codes(code), map_of(finder, still_frame(), truth)));
    EXPECT_NEAR(judge.verdict().error.psnr(), 20 * std::log10(255.0 / 2), 1e-9);
    EXPECT_NEAR(judge.verdict().flicker.psnr(), 20 * std::log10(255.0 / 4), 1e-9);
    ASSERT_EQ(judge.verdict().frames.size(), 2U);
    EXPECT_EQ(judge.verdict().frames[1].number, 6);
    EXPECT_GT(judge.verdict().flip_mean, 0);
    EXPECT_TRUE(std::isnan(judge.verdict().regions[0].psnr())) << "an even wall has no edges";
    Judge same;
    ASSERT_TRUE(same.add(1, truth, truth, map_of(finder, still_frame(), truth)));
    EXPECT_TRUE(std::isinf(same.verdict().error.psnr()));
    EXPECT_EQ(same.verdict().flip_mean, 0);
}

TEST(ImageJudge, EdgesAndThinThingsAreFoundByDepth) {
    FrameFile frame = still_frame();
    for (std::uint32_t y = 0; y < height; ++y) {
        *frame.depth->at(8, y) = 5;                                             // a wire
        for (std::uint32_t x = 20; x < width; ++x) *frame.depth->at(x, y) = 5;  // the edge of a wall
    }
    RegionFinder finder;
    const RegionMap map = map_of(finder, frame, even_codes(9));
    EXPECT_TRUE(map.has(at(8, 12), JudgedRegion::Thin));
    EXPECT_TRUE(map.has(at(10, 12), JudgedRegion::Thin));
    EXPECT_FALSE(map.has(at(11, 12), JudgedRegion::Thin));
    EXPECT_FALSE(map.has(at(20, 12), JudgedRegion::Thin)) << "one side alone is farther";
    EXPECT_TRUE(map.has(at(20, 12), JudgedRegion::Edges));
    EXPECT_TRUE(map.has(at(19, 12), JudgedRegion::Edges));
    EXPECT_FALSE(map.has(at(18, 12), JudgedRegion::Edges));
    EXPECT_FALSE(map.has(at(22, 12), JudgedRegion::Edges));
}

TEST(ImageJudge, MovingTextureMovesAndHasContrast) {
    FrameFile frame = still_frame();
    ShownCodes codes = even_codes(50);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; x += 2) codes.at(x, y)[1] = y < 12 ? 66.0F : 65.0F;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) frame.velocity->at(x, y)[0] = 0.6F;
    RegionFinder finder;
    const RegionMap map = map_of(finder, frame, codes);
    EXPECT_TRUE(map.has(at(5, 5), JudgedRegion::MovingTexture));
    EXPECT_FALSE(map.has(at(20, 5), JudgedRegion::MovingTexture)) << "still";
    EXPECT_FALSE(map.has(at(5, 20), JudgedRegion::MovingTexture)) << "too even";
}

// A board before the wall goes away: what it hid is new, and a frame older with every frame.
TEST(ImageJudge, WhatWasHiddenIsFoundAndGrowsOlder) {
    RegionFinder finder;
    Judge judge;
    const ShownCodes truth = even_codes(100);
    FrameFile hiding = still_frame();
    for (std::uint32_t y = 4; y < 12; ++y)
        for (std::uint32_t x = 4; x < 12; ++x) *hiding.depth->at(x, y) = 4;
    ASSERT_TRUE(judge.add(0, truth, truth, map_of(finder, hiding, truth)));
    for (int age = 0; age < 3; ++age) {
        const RegionMap map = map_of(finder, still_frame(), truth);
        EXPECT_EQ(map.has(at(6, 6), JudgedRegion::Disoccluded), age == 0);
        EXPECT_EQ(map.age(at(6, 6)), age);
        EXPECT_EQ(map.age(at(20, 20)), max_recovery_frames);
        // The former colour fades by half with each frame.
        ShownCodes test = truth;
        for (std::uint32_t y = 4; y < 11; ++y)
            for (std::uint32_t x = 4; x < 11; ++x) test.at(x, y)[0] += std::ldexp(32.0F, -age);
        ASSERT_TRUE(judge.add(1 + age, truth, test, map));
    }
    const auto& recovery = judge.verdict().recovery;
    EXPECT_NEAR(recovery[1].psnr() - recovery[0].psnr(), 20 * std::log10(2.0), 1e-9);
    EXPECT_NEAR(recovery[2].psnr() - recovery[1].psnr(), 20 * std::log10(2.0), 1e-9);
    EXPECT_EQ(recovery[3].samples, 0U);
}

// The camera goes forward: the whole wall comes nearer, and nothing was hidden.
TEST(ImageJudge, AWalkDisoccludesNothingOfAWall) {
    RegionFinder finder;
    FrameFile before = still_frame(), now = still_frame();
    std::fill(before.depth->values.begin(), before.depth->values.end(), 11.0F);
    // A metre nearer now than then, of a point at 10 m.
    (*now.camera.world_to_camera)[14] = 1;
    const ShownCodes codes = even_codes(1);
    map_of(finder, before, codes);
    const RegionMap map = map_of(finder, now, codes);
    for (std::uint32_t y = 1; y + 1 < height; ++y)
        for (std::uint32_t x = 1; x + 1 < width; ++x) EXPECT_FALSE(map.has(at(x, y), JudgedRegion::Disoccluded));
}

TEST(ImageJudge, ATruthWithoutLayersIsRefused) {
    RegionFinder finder;
    FrameFile frame = still_frame();
    frame.velocity.reset();
    EXPECT_FALSE(finder.find(frame, even_codes(1)));
}

/// An edge through the middle that every pixel is the mean of, `samples` places a side, blurred by a Gaussian.
Plane<1> slanted(double degrees, double sigma, bool is_turned) {
    constexpr std::uint32_t side = 64, samples = 8;
    const double slope = std::tan(degrees * std::numbers::pi / 180);
    Plane<1> out(side, side);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            double sum = 0;
            for (std::uint32_t i = 0; i < samples * samples; ++i) {
                const double px = x + (i % samples + 0.5) / samples - side / 2.0,
                             py = y + (i / samples + 0.5) / samples - side / 2.0;
                const double distance = (px - slope * py) / std::hypot(1, slope);
                sum += sigma > 0 ? 0.5 * std::erfc(-distance / (sigma * std::numbers::sqrt2)) : (distance > 0 ? 1 : 0);
            }
            *(is_turned ? out.at(y, x) : out.at(x, y)) = static_cast<float>(0.1 + 0.8 * sum / (samples * samples));
        }
    return out;
}

/// Where sinc(f) * exp(-2 (pi sigma f)^2) is a half: a pixel's square and the blur, along the normal of an edge that is
/// nearly upright.
double expected_mtf50(double sigma) {
    double low = 1e-3, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double f = (low + high) / 2, x = std::numbers::pi * f;
        (std::sin(x) / x * std::exp(-2 * std::pow(x * sigma, 2)) > 0.5 ? low : high) = f;
    }
    return low;
}

TEST(ImageJudge, TheSharpnessOfAnEdgeIsThatOfItsBlur) {
    for (const bool is_turned : {false, true})
        for (const double degrees : {5.0, -7.0, 12.0})
            for (const double sigma : {0.0, 0.5, 1.0}) {
                const Result<EdgeSharpness> found = edge_sharpness(slanted(degrees, sigma, is_turned));
                ASSERT_TRUE(found) << found.error().text;
                EXPECT_NEAR(found->mtf50, expected_mtf50(sigma), 0.05 * expected_mtf50(sigma))
                    << degrees << ' ' << sigma << ' ' << is_turned;
                EXPECT_NEAR(std::abs(found->angle_degrees), std::abs(degrees), 0.3);
            }
}

TEST(ImageJudge, WhatIsNoSlantedEdgeIsRefused) {
    EXPECT_FALSE(edge_sharpness(Plane<1>(8, 64)));
    EXPECT_FALSE(edge_sharpness(Plane<1>(64, 64))) << "no contrast";
    EXPECT_FALSE(edge_sharpness(slanted(0, 0, false)));
    EXPECT_FALSE(edge_sharpness(slanted(44, 0, false)));
}

}  // namespace
}  // namespace darkroom
