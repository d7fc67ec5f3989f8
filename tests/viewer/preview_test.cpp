// SPDX-License-Identifier: MIT
// How coarse a picture is while it moves, and what a stored frame is then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <vector>

#include "viewer/scale_choice.hpp"
#include "viewer/source/small_frame.hpp"

namespace app {
namespace {

const std::vector<double> halves{1, 0.5, 0.25};
const std::vector<double> small_steps{1, 0.85, 0.7, 0.6, 0.5, 0.4, 1.0 / 3};
constexpr double most = 1.0 / 15;

using Cost = std::function<double(double scale)>;

/// Pictures that take what `cost` says of their scale.
double after(ScaleChoice& choice, int pictures, const Cost& cost) {
    for (int i = 0; i < pictures; ++i) choice.add(cost(choice.scale()));
    return choice.scale();
}
/// How often it is another scale.
int changes(ScaleChoice& choice, int pictures, const Cost& cost) {
    int out = 0;
    for (int i = 0; i < pictures; ++i) {
        const double before = choice.scale();
        out += after(choice, 1, cost) != before ? 1 : 0;
    }
    return out;
}
Cost of_pixels(double whole, double fixed = 0) {
    return [=](double scale) { return fixed + whole * scale * scale; };
}

TEST(ScaleChoice, IsAsFineAsTimeAllows) {
    ScaleChoice fast(halves, most), slow(halves, most), slowest(halves, most);
    EXPECT_EQ(after(fast, 100, of_pixels(0.05)), 1);
    EXPECT_EQ(after(slow, 100, of_pixels(0.2)), 0.5);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.5)), 0.25);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.1)), 0.5);
    EXPECT_EQ(after(slowest, 100, of_pixels(0.02)), 1);
}

TEST(ScaleChoice, OnePictureThatTakesLongChangesNothing) {
    ScaleChoice choice(halves, most);
    for (int i = 0; i < 100; ++i) choice.add(i % 5 == 0 ? 1.0 : 0.02);
    EXPECT_EQ(choice.scale(), 1);
}

TEST(ScaleChoice, DoesNotAlternate) {
    for (const double whole : {0.05, 0.07, 0.1, 0.2, 0.26, 0.3, 0.5}) {
        ScaleChoice choice(halves, most);
        (void)after(choice, 50, of_pixels(whole));
        EXPECT_EQ(changes(choice, 100, of_pixels(whole)), 0) << whole;
    }
}

TEST(ScaleChoice, KeepsThePixelsWhereFewerGainNothing) {
    ScaleChoice choice(halves, most);
    int coarse = 0;
    for (int i = 0; i < 200; ++i) coarse += after(choice, 1, [](double) { return 0.3; }) < 1 ? 1 : 0;
    EXPECT_EQ(choice.scale(), 1);
    EXPECT_LT(coarse, 10);
    EXPECT_LE(changes(choice, 100'000, [](double) { return 0.3; }), 20) << "and tries it ever more seldom";
}

// Whatever a picture costs at each scale, as long as fewer pixels cost less.
TEST(ScaleChoice, ComesToRestAtAScaleThatFits) {
    std::mt19937 random(3);
    for (int run = 0; run < 2000; ++run) {
        std::map<double, double> costs;
        double cost = most * std::exp(std::uniform_real_distribution(-2.0, 3.0)(random));
        for (const double scale : small_steps) {
            costs[scale] = cost;
            cost /= std::uniform_real_distribution(1.1, 2.5)(random);
        }
        const auto of = [&](double scale) { return costs.at(scale); };
        ScaleChoice choice(small_steps, most);
        const double settled = after(choice, 300, of);
        EXPECT_EQ(changes(choice, 2000, of), 0) << run;
        EXPECT_TRUE(of(settled) <= most || settled == small_steps.back()) << run;
    }
}

TEST(ScaleChoice, IsTheFinestWhereTimeFollowsPixels) {
    std::mt19937 random(4);
    for (int run = 0; run < 2000; ++run) {
        const Cost of = of_pixels(most * std::exp(std::uniform_real_distribution(-2.0, 4.0)(random)));
        ScaleChoice choice(small_steps, most);
        const double settled = after(choice, 300, of);
        const auto finer = std::ranges::find(small_steps, settled);
        if (finer == small_steps.begin()) continue;
        EXPECT_GT(of(*std::prev(finer)), 0.8 * most) << run;
    }
}

TEST(ScaleChoice, FollowsALoadAndNoNoise) {
    std::mt19937 random(5);
    std::uniform_real_distribution noise(0.95, 1.05);
    ScaleChoice choice(small_steps, most);
    const auto under = [&](double load) {
        return [&, load](double scale) { return noise(random) * load * (0.01 + 0.04 * scale * scale); };
    };
    EXPECT_EQ(after(choice, 100, under(1)), 1);
    const double loaded = after(choice, 100, under(2));
    EXPECT_LT(loaded, 0.8);
    EXPECT_GT(loaded, 0.6);
    EXPECT_LE(changes(choice, 2000, under(2)), 4);
    EXPECT_EQ(after(choice, 200, under(1)), 1);
}

TEST(SmallFrame, HasThePixelsInTheMiddleAndShorterMotion) {
    constexpr std::uint32_t width = 5, height = 3;
    std::vector<float> depth, velocity;
    std::vector<std::uint16_t> color;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            depth.push_back(static_cast<float>(10 * y + x));
            velocity.insert(velocity.end(), {static_cast<float>(x) / 3, -4});
            for (int i = 0; i < 4; ++i) color.push_back(static_cast<std::uint16_t>(100 * y + x));
        }
    darkroom::DevelopInput input{.extent = {width, height}, .depth = depth, .velocity = velocity};
    input.color_halves = color;
    const std::vector<float> exposure{0.25F};
    input.exposure = exposure;
    const SmallFrame small(input, {3, 2});
    EXPECT_EQ(small.input().extent.width, 3U);
    EXPECT_EQ(small.input().extent.height, 2U);
    const darkroom::UploadLayers& layers = small.layers();
    const std::vector<float> expected{0, 2, 4, 20, 22, 24};
    EXPECT_TRUE(std::ranges::equal(layers[1].values, expected));
    for (const std::size_t i : {0U, 1U, 3U}) {
        EXPECT_EQ(layers[i].extent.width, 3U) << layers[i].name;
        EXPECT_EQ(layers[i].extent.height, 2U) << layers[i].name;
    }
    EXPECT_EQ(layers[6].extent.width, 1U);
    EXPECT_TRUE(std::ranges::equal(layers[6].values, exposure)) << "one texel for the whole frame";
    EXPECT_EQ(layers[0].halves.size(), 6U * 4);
    EXPECT_EQ(layers[0].halves[4], 2);
    EXPECT_EQ(layers[0].format, darkroom::layers_of(input)[0].format);
    EXPECT_FLOAT_EQ(layers[3].values[2], 2.0F / 3 * 3 / 5);
    EXPECT_FLOAT_EQ(layers[3].values[1], -4.0F * 2 / 3);
}

TEST(SmallFrame, MotionThatIsHalfStaysHalf) {
    // 1, -2^-14, twice the smallest number, infinity.
    const std::vector<std::uint16_t> velocity{0x3c00, 0x8400, 0x3c00, 0x8400, 0x0002, 0x7c00, 0x0002, 0x7c00};
    const std::vector<std::uint16_t> color(32);
    darkroom::DevelopInput input{.extent = {4, 2}};
    input.color_halves = color;
    std::vector<std::uint16_t> rows = velocity;
    rows.insert(rows.end(), velocity.begin(), velocity.end());
    input.velocity_halves = rows;
    const SmallFrame half(input, {2, 1}), whole(input, {4, 2});
    EXPECT_TRUE(
        std::ranges::equal(half.layers()[3].halves, std::vector<std::uint16_t>{0x3800, 0x8200, 0x0001, 0x7c00}));
    EXPECT_TRUE(std::ranges::equal(whole.layers()[3].halves, rows));
    // Floats that are all halves, one of which is none when it is shorter.
    const std::vector<float> values{0x3p-24F, 1, 0x3p-24F, 1, 0x3p-24F, 1, 0x3p-24F, 1};
    darkroom::DevelopInput floats{.extent = {4, 1}, .velocity = values};
    floats.color_halves = std::span(color).first(16);
    const SmallFrame one(floats, {1, 1});
    EXPECT_EQ(one.layers()[3].format, darkroom::layers_of(floats)[3].format);
    EXPECT_TRUE(std::ranges::equal(one.layers()[3].halves, std::vector<std::uint16_t>{0x0001, 0x3c00}));
}

TEST(SmallFrame, CodesAreOfTheSamePixels) {
    const std::vector<std::uint8_t> codes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    darkroom::DevelopInput input{.extent = {2, 2}, .color_channels = 3};
    input.color_codes = codes;
    const SmallFrame small(input, {1, 1});
    EXPECT_TRUE(std::ranges::equal(small.layers()[0].codes, std::vector<std::uint8_t>{10, 11, 12}));
    EXPECT_TRUE(std::ranges::equal(small.input().color_codes, std::vector<std::uint8_t>{10, 11, 12}));
}

}  // namespace
}  // namespace app
