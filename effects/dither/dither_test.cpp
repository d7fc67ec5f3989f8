// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/dither.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "compose/test_stacks/support.hpp"
#include "dither/dither_reference.hpp"

namespace darkroom {
namespace {

constexpr std::uint32_t side = dither_tile_size;
constexpr double code = 1.0 / 255.0;

/// As older looks have it: its mean stays before rounding, and it moves.
Dither older(float intensity) { return {.intensity = intensity, .ends = DitherEnds::Unrounded, .moves = true}; }

ReferenceImage dithered(const ReferenceImage& picture, const Dither& parameters, double time = 0,
                        std::uint64_t frame = 0) {
    return effect_info(parameters)
        .reference(&parameters, {.picture = &picture, .source = &picture, .time = time, .frame_index = frame});
}

TEST(EffectDither, EachChannelHoldsEveryRankOnce) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::set<float> values;
        for (const DitherTexel& texel : dither_tile()) values.insert(texel[channel]);
        EXPECT_EQ(values.size(), std::size_t{side} * side) << channel;
    }
}

TEST(EffectDither, NoiseIsTriangular) {
    constexpr std::size_t bins = 16;
    std::array<int, bins> counts{};
    for (const DitherTexel& texel : dither_tile()) ++counts[static_cast<std::size_t>((texel[0] + 1.0f) / 2.0f * bins)];
    for (std::size_t bin = 0; bin < bins; ++bin) {
        // The density 1 - |n| over a bin of width 2 / bins, at its middle.
        const double middle = (double(bin) + 0.5) / bins * 2.0 - 1.0;
        EXPECT_NEAR(counts[bin], side * side * (1.0 - std::abs(middle)) * 2.0 / bins, 2.0) << bin;
    }
}

TEST(EffectDither, MeanStaysEvenAtTheEnds) {
    for (const double value : {0.0, 0.001, 0.1, 0.5, 0.997, 1.0}) {
        const ReferenceImage out = dithered(test::uniform(side, side, {value, value, value}), older(0.2f));
        Rgba sum{0, 0, 0};
        for (const Rgba& color : out.pixels) {
            sum.r += color.r;
            sum.g += color.g;
            sum.b += color.b;
            EXPECT_TRUE(color.r >= 0.0 && color.r <= 1.0) << color.r;
        }
        for (const double mean : {sum.r, sum.g, sum.b}) EXPECT_NEAR(mean / (side * side), value, 1e-9) << value;
    }
}

// Of the rounded picture, in codes, from black to white and outside of both.
TEST(EffectDither, TheMeanOfCodesStaysAtEveryValue) {
    const auto mean_error = [](double value, const Dither& parameters) {
        const ReferenceImage out = dithered(test::uniform(side, side, {value, value, value}), parameters);
        double sum = 0;
        for (const Rgba& color : out.pixels) sum += std::round(std::clamp(color.g, 0.0, 1.0) / code);
        return std::abs(sum / (side * side) - value / code);
    };
    double older_worst = 0;
    for (int i = 0; i <= 255 * 16; ++i) {
        const double value = i * code / 16;
        EXPECT_LE(mean_error(value, {}), 0.02) << value / code;
        if (i < 64 || i > 255 * 16 - 64) {
            for (const float wide : {0.015f, 0.03f})
                EXPECT_LE(mean_error(value, {.intensity = wide}), 0.03) << value / code;
        }
        if (i < 64) older_worst = std::max(older_worst, mean_error(value, older(2.0f / 255.0f)));
    }
    EXPECT_GT(older_worst, 0.2) << "which narrowing alone does not do";
}

// A ramp of 8 codes, 32 pixels each: without noise runs of 32 equal codes.
TEST(EffectDither, NoRunOfEqualCodesIsLong) {
    ReferenceImage ramp(256, side);
    for (std::uint32_t y = 0; y < ramp.height; ++y)
        for (std::uint32_t x = 0; x < ramp.width; ++x) {
            const double value = (100 + x / 32.0) * code;
            ramp.at(x, y) = {value, value, value};
        }
    const auto longest = [](const ReferenceImage& picture) {
        std::uint32_t most = 0;
        for (std::uint32_t y = 0; y < picture.height; ++y) {
            std::uint32_t run = 1;
            for (std::uint32_t x = 1; x < picture.width; ++x) {
                const bool is_same = std::round(picture.at(x, y).g / code) == std::round(picture.at(x - 1, y).g / code);
                run = is_same ? run + 1 : 1;
                most = std::max(most, run);
            }
        }
        return most;
    };
    EXPECT_EQ(longest(ramp), 32U);
    EXPECT_LT(longest(dithered(ramp, {})), 26U);
}

TEST(EffectDither, StandsStillUnlessItIsAskedToMove) {
    const ReferenceImage grey = test::uniform(side, side, {0.5, 0.5, 0.5});
    EXPECT_EQ(test::worst_difference(dithered(grey, {}, 1.0, 1), dithered(grey, {}, 1.0, 2)), 0.0);
    const auto frame = [&](std::uint64_t index) {
        return test::develop([](Composer& composer) { composer.add(Dither{}); }, grey,
                             {.time = 3.0, .frame_index = index});
    };
    EXPECT_EQ(test::worst_difference(frame(1), frame(2)), 0.0);
}

TEST(EffectDither, AmplitudeIsHalfTheIntensity) {
    const ReferenceImage out = dithered(test::uniform(side, side, {0.5, 0.5, 0.5}), {.intensity = 0.1f});
    double widest = 0.0;
    for (const Rgba& color : out.pixels) widest = std::max(widest, std::abs(color.g - 0.5));
    EXPECT_LE(widest, 0.05);
    EXPECT_GE(widest, 0.048);
}

TEST(EffectDither, OutsideTheRangeNothingChanges) {
    const Rgba color{-0.5, 1.5, 60000.0};
    const ReferenceImage out = dithered(test::uniform(side, side, color), {.intensity = 1.0f});
    for (const Rgba& pixel : out.pixels) {
        EXPECT_EQ(pixel.r, color.r);
        EXPECT_EQ(pixel.g, color.g);
        EXPECT_EQ(pixel.b, color.b);
    }
}

// Blue: the low frequencies, which the eye sees, hold little of the power. White noise would give 1.
TEST(EffectDither, LowFrequenciesAreSuppressed) {
    double power = 0.0;
    for (const DitherTexel& texel : dither_tile()) power += double{texel[1]} * double{texel[1]};
    constexpr int radius = 6;
    double low = 0.0;
    int count = 0;
    for (int v = -radius; v <= radius; ++v) {
        for (int u = -radius; u <= radius; ++u) {
            if (u * u + v * v > radius * radius) continue;
            std::complex<double> sum;
            for (std::uint32_t i = 0; i < side * side; ++i) {
                const double phase = 2.0 * std::numbers::pi * (u * double(i % side) + v * double(i / side)) / side;
                sum += double{dither_tile()[i][1]} * std::polar(1.0, phase);
            }
            low += std::norm(sum);
            ++count;
        }
    }
    EXPECT_LT(low / count / power, 0.05);
}

TEST(EffectDither, ChannelsAreUncorrelated) {
    for (const auto& [first, second] : {std::array{0, 1}, std::array{1, 2}, std::array{0, 2}}) {
        double product = 0.0, power = 0.0;
        for (const DitherTexel& texel : dither_tile()) {
            product += double{texel[first]} * double{texel[second]};
            power += double{texel[first]} * double{texel[first]};
        }
        EXPECT_LT(std::abs(product / power), 0.05) << first << " and " << second;
    }
}

// A gradient of four codes over 256 pixels. Without noise the mean of a 16-pixel strip is wrong by up to half a code.
TEST(EffectDither, GradientsShowNoSteps) {
    ReferenceImage gradient(256, side);
    for (std::uint32_t y = 0; y < gradient.height; ++y) {
        for (std::uint32_t x = 0; x < gradient.width; ++x) {
            const double value = 0.2 + 4.0 * code * x / gradient.width;
            gradient.at(x, y) = {value, value, value};
        }
    }
    const auto worst_strip = [&](const ReferenceImage& picture) {
        double worst = 0.0;
        for (std::uint32_t start = 0; start < gradient.width; start += 16) {
            double shown = 0.0, meant = 0.0;
            for (std::uint32_t y = 0; y < gradient.height; ++y) {
                for (std::uint32_t x = start; x < start + 16; ++x) {
                    shown += std::round(picture.at(x, y).g / code);
                    meant += gradient.at(x, y).g / code;
                }
            }
            worst = std::max(worst, std::abs(shown - meant) / (16.0 * gradient.height));
        }
        return worst;
    };
    EXPECT_GT(worst_strip(gradient), 0.3);
    EXPECT_LT(worst_strip(dithered(gradient, {})), 0.03);
}

TEST(EffectDither, MovesOnlyWhileTimeRuns) {
    const ReferenceImage grey = test::uniform(side, side, {0.5, 0.5, 0.5});
    EXPECT_EQ(test::worst_difference(dithered(grey, older(0.1f), 0.0, 1), dithered(grey, older(0.1f), 0.0, 2)), 0.0);
    EXPECT_GT(test::worst_difference(dithered(grey, older(0.1f), 1.0, 1), dithered(grey, older(0.1f), 1.0, 2)), 0.01);
    std::set<std::uint32_t> offsets;
    for (std::uint64_t frame = 0; frame < 256; ++frame) {
        const DitherOffset offset = dither_offset(1.0, frame);
        offsets.insert(offset.y * side + offset.x);
    }
    EXPECT_GE(offsets.size(), 250u) << "frames share their noise";
}

TEST(EffectDither, GpuLeavesThePictureAtZero) {
    const ReferenceImage picture = test::round_to_float(test::random_display(32, 32, 5));
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Dither{.intensity = 0.0f}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

TEST(EffectDither, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(131, 97, 1));
    for (const float intensity : {0.004f, 0.03f, 1.0f}) {
        SCOPED_TRACE(intensity);
        test::expect_gpu_matches_reference(Dither{.intensity = intensity}, picture);
        test::expect_gpu_matches_reference(older(intensity), picture);
    }
}

TEST(EffectDither, GpuMovesAsTheReferenceDoes) {
    const ReferenceImage picture = test::round_to_float(test::random_display(131, 97, 1));
    for (const std::uint64_t frame : {1u, 77u, 4000000000u}) {
        const ReferenceImage out = test::develop([](Composer& composer) { composer.add(older(0.2f)); }, picture,
                                                 {.time = 3.0, .frame_index = frame});
        EXPECT_LE(test::worst_half_ulps(out, dithered(picture, older(0.2f), 3.0, frame)), 2.0) << frame;
    }
}

}  // namespace
}  // namespace darkroom
