// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/perturb.hpp>

#include <darkroom/composer.hpp>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "perturb/perturb_reference.hpp"

namespace darkroom {
namespace {

using Evaluation = PerturbEvaluation;

/// Smooth, so that a small difference of a coordinate is a small one of a colour.
ReferenceImage waves(std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            out.at(x, y) = {0.5 + 0.4 * std::sin(x * 0.2), 0.5 + 0.4 * std::cos(y * 0.15), 0.01 * x,
                            y % 7 == 0 ? 0.5 : 1};
    return test::round_to_float(out);
}

Perturb strong(Evaluation evaluation) {
    return {.strength = {5, 3, 1.5f, 2},
            .time_distortion = {0.2f, 0.7f},
            .ring_strength = 6,
            .ring_center = {0.4f, 0.6f},
            .ring_width = 0.2f,
            .ring_speed = 0.5f,
            .evaluation = evaluation,
            .grid = {12, 9},
            .reach = Reach::Pixels};
}

ReferenceImage developed(const Perturb& parameters, const ReferenceImage& picture, test::RunOptions options = {}) {
    options.target_domain = Domain::SceneLinear;
    return test::develop([&](Composer& composer) { composer.add(parameters); }, picture, options);
}
ReferenceImage reference(const Perturb& parameters, const ReferenceImage& picture, double time) {
    return perturb_reference(&parameters, {.picture = &picture, .source = &picture, .time = time});
}

TEST(EffectPerturb, GpuMatchesReference) {
    for (const Evaluation evaluation :
         {Evaluation::Pixel, Evaluation::SineTable, Evaluation::Vertex, Evaluation::Cpu}) {
        for (const auto& [width, height] : {std::pair{83u, 47u}, {1u, 1u}, {3u, 90u}}) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(evaluation) << ' ' << width << 'x' << height);
            const ReferenceImage picture = waves(width, height);
            const ReferenceImage expected = reference(strong(evaluation), picture, 0.6);
            // A filtered grid is wrong by filter_step of shifts of up to 11 pixels in either direction.
            const bool has_grid = evaluation == Evaluation::Vertex || evaluation == Evaluation::Cpu;
            ReferenceImage filtered = reference(strong(evaluation), test::filter_loss(picture), 0.6);
            for (Rgba& p : filtered.pixels)
                if (has_grid) p = {12 * p.r, 12 * p.g, 12 * p.b, 12 * p.a};
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage out = developed(strong(evaluation), picture, {.kernels = stage, .time = 0.6});
                // Of 256 entries, a table's sine is wrong by 8e-5, and the grid's half precision by 2^-11 of a shift:
                // hundredths of a pixel, times the steepest edge, that of alpha.
                const bool is_exact = evaluation == Evaluation::Pixel;
                EXPECT_LE(test::worst_difference(out, expected, filtered), is_exact ? 2e-4 : 4e-3);
            }
        }
    }
}

TEST(EffectPerturb, AllEvaluationsAgreeAsTheGridGrows) {
    const ReferenceImage picture = waves(160, 90);
    const ReferenceImage exact = developed(strong(Evaluation::Pixel), picture, {.time = 0.6});
    // Both are filtered, of neighbours that are half of alpha apart.
    EXPECT_LE(test::worst_difference(developed(strong(Evaluation::SineTable), picture, {.time = 0.6}), exact),
              1e-3 + 2 * 2 * gpu::test::filter_step() * 0.5);
    double before = 1;
    for (const float cells : {4.0f, 8.0f, 16.0f, 64.0f}) {
        Perturb vertex = strong(Evaluation::Vertex);
        vertex.grid = {cells, cells};
        const double error = test::worst_difference(developed(vertex, picture, {.time = 0.6}), exact);
        EXPECT_LT(error, before);
        before = error;
        if (cells > 16) continue;
        vertex.evaluation = Evaluation::Cpu;
        EXPECT_NEAR(test::worst_difference(developed(vertex, picture, {.time = 0.6}), exact), error, 4e-3);
    }
    EXPECT_LT(before, 0.02) << "an interpolated grid of 64 x 64";
}

TEST(EffectPerturb, PhasesLoopWithoutASeam) {
    Perturb at_start = strong(Evaluation::Pixel), at_end = at_start;
    at_start.time_distortion = {0, 0.25f};
    at_end.time_distortion = {1, 0.25f};
    const ReferenceImage picture = waves(40, 30);
    EXPECT_EQ(test::worst_difference(reference(at_start, picture, 0.1), reference(at_end, picture, 0.1)), 0);
    at_start.speed = {0.5f, 2};
    EXPECT_NEAR(perturb_frame(at_start, 1.9999).phase_x, 1, 1e-3);
    EXPECT_NEAR(perturb_frame(at_start, 2.0001).phase_x, 0, 1e-3);
    const PerturbFrame late = perturb_frame(at_start, 1e7 + 0.5), early = perturb_frame(at_start, 0.5);
    EXPECT_NEAR(late.phase_x, early.phase_x, 1e-6) << "a whole number of turns later, after four months";
}

TEST(EffectPerturb, TheSinesMoveByTheirStrengthInPixels) {
    ReferenceImage ramp(64, 8);
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) ramp.at(x, y) = {x / 64.0, 0, 0, 1};
    // A quarter turn everywhere: sin is 1, so each pixel shows what lies 5 pixels to its right.
    Perturb shift{.strength = {5, 0, 0, 0}, .time_distortion = {0.25f, 0}, .reach = Reach::Pixels};
    EXPECT_NEAR(reference(shift, ramp, 0).at(20, 4).r, 25 / 64.0, 1e-6);
    // Pixels of a picture of 1080 lines: of 8 lines, 5 are 675 of those.
    shift.strength.x = 5 * 1080 / 8.0f;
    shift.reach = Reach::Height;
    EXPECT_NEAR(reference(shift, ramp, 0).at(20, 4).r, 25 / 64.0, 1e-6);
}

// Half way between the last entry and the first: sin is -0.012, the last entry -0.025, a quarter of a pixel less.
TEST(EffectPerturb, TheSineTableHasNoSeam) {
    ReferenceImage ramp(64, 8);
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) ramp.at(x, y) = {x / 64.0, y / 8.0, 0, 1};
    const Perturb shift{.strength = {20, 20, 0, 0},
                        .time_distortion = {0.998f, 0.998f},
                        .evaluation = Evaluation::SineTable,
                        .reach = Reach::Pixels};
    const ReferenceImage expected = reference(shift, ramp, 0);
    EXPECT_NEAR(expected.at(20, 4).r, (20 - 20 * 0.01257) / 64, 1e-4);
    EXPECT_NEAR(developed(shift, ramp).at(20, 4).r, expected.at(20, 4).r, 1e-3);
    EXPECT_NEAR(developed(shift, ramp).at(20, 4).g, expected.at(20, 4).g, 2e-3);
}

TEST(EffectPerturb, TheRingRunsOutwardAndDies) {
    const ReferenceImage picture = waves(120, 80);
    const Perturb ring{
        .strength = {0, 0, 0, 0}, .ring_strength = 8, .ring_width = 0.1f, .ring_speed = 0.5f, .ring_period = 1};
    const auto moved_at = [&](double time) {
        const ReferenceImage out = reference(ring, picture, time);
        double nearest = 1e9, farthest = 0, strongest = 0;
        for (std::uint32_t y = 0; y < 80; ++y)
            for (std::uint32_t x = 0; x < 120; ++x) {
                const double change = std::abs(out.at(x, y).r - picture.at(x, y).r);
                strongest = std::max(strongest, change);
                if (change < 1e-6) continue;
                const double radius = std::hypot(x + 0.5 - 60, y + 0.5 - 40) / 80;
                nearest = std::min(nearest, radius);
                farthest = std::max(farthest, radius);
            }
        return std::array{nearest, farthest, strongest};
    };
    const auto early = moved_at(0.4), late = moved_at(0.8);
    EXPECT_GT(early[0], 0.1 - 0.02);
    EXPECT_LT(early[1], 0.3 + 0.02);
    EXPECT_GT(late[0], early[0]);
    EXPECT_LT(late[2], early[2]);
}

TEST(EffectPerturb, AnImageDisplacesAndRepeats) {
    const ReferenceImage picture = waves(64, 64);
    Resources resources;
    const ResourceImage image{
        .width = 2, .height = 2, .rgba = {1, 0.5f, 0, 1, 0, 0.5f, 0, 1, 0.5f, 1, 0, 1, 0.5f, 0, 0, 1}};
    for (const Evaluation evaluation : {Evaluation::Pixel, Evaluation::Vertex}) {
        Perturb parameters{.strength = {0, 0, 0, 0},
                           .time_distortion = {0.3f, 0.1f},
                           .distortion_strength = 4,
                           .evaluation = evaluation,
                           .grid = {64, 64},
                           .reach = Reach::Pixels};
        ReferenceImage expected;
        const ReferenceImage out = test::develop(
            [&](Composer& composer) {
                const auto made = composer.define(image);
                ASSERT_TRUE(made);
                parameters.distortion = *made;
                composer.add(parameters);
                expected = perturb_reference(
                    &parameters, {.picture = &picture, .source = &picture, .resources = &composer.resources()});
            },
            picture, {.target_domain = Domain::SceneLinear});
        EXPECT_LE(test::worst_difference(out, expected), 4e-3);
        EXPECT_GT(test::worst_difference(out, picture), 0.1);
    }
}

TEST(EffectPerturb, WhatMovesNothingIsOff) {
    const Perturb on;
    const EffectInfo& info = effect_info(on);
    for (const Perturb& still : {Perturb{.amount = 0}, Perturb{.strength = {0, 0, 3, 3}}})
        EXPECT_TRUE(info.is_identity(&still));
    EXPECT_FALSE(info.is_identity(&on));
    const Perturb many{.evaluation = Evaluation::Cpu, .grid = {64, 32}};
    EXPECT_EQ(info.conflict(&many), "grid of 2145 vertices: with evaluation = cpu at most 1000 are allowed");
}

}  // namespace
}  // namespace darkroom
