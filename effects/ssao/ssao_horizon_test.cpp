// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>
#include <set>

#include "ssao/ssao_reference.hpp"
#include "ssao/ssao_scenes.hpp"

namespace darkroom {
namespace {

using test::box;
using test::BoxView;

/// Twice the integral of cos(t - n) sin t, from the view vector to t = h: equation 7 of Jimenez et al., one side.
double equation_seven(double h, double n) { return (std::cos(n) + 2 * h * std::sin(n) - std::cos(2 * h - n)) / 2; }

TEST(Ssao, ArcsAndSectorsFollowEquationSeven) {
    using std::numbers::pi;
    for (int degrees = -85; degrees <= 85; degrees += 5) {
        const double n = degrees * pi / 180, sine = std::sin(n), whole = equation_seven(n + pi / 2, n);
        EXPECT_NEAR(ssao_arc(sine), whole, 0.01) << degrees;
        EXPECT_EQ(ssao_sector(-sine, sine), 0) << "the surface's own plane";
        EXPECT_NEAR(ssao_sector(1, sine), ssao_sectors, 1e-9) << "the view vector";
        for (double h = 0; h < n + pi / 2; h += 0.02) {
            const double below = 1 - equation_seven(h, n) / whole;
            EXPECT_NEAR(ssao_sector(std::cos(h), sine) / ssao_sectors, below, degrees > 75 ? 0.05 : 0.021)
                << degrees << ", " << h;
        }
    }
}

TEST(Ssao, APixelMeetsTheWholeTileWithinSixteenFrames) {
    std::set<std::uint32_t> met;
    std::set<float> shares;
    for (std::uint64_t frame = 32; frame < 48; ++frame) {
        met.insert(ssao_tile(1, frame));
        if (frame < 36) shares.insert(ssao_noise()[ssao_tile(1, frame)][3]);
        EXPECT_EQ(ssao_tile(0, frame), 0u) << "while time stands still, the picture does";
    }
    EXPECT_EQ(met.size(), 16u);
    EXPECT_EQ(shares.size(), 4u);
}

TEST(EffectSsao, NoiseFollowsTheFrameIfItIsAskedTo) {
    const BoxView view = test::view_of(test::stairs_scene(), 83, 47);
    const ReferenceImage picture = test::uniform(83, 47, {1, 1, 1, 1});
    Ssao ssao{.radius = 1.5f, .method = SsaoMethod::GroundTruth, .resolution = SsaoResolution::Full};
    test::RunOptions options = view.options();
    const ReferenceImage still = test::visibility_of(ssao, options);
    options.time = 0.5;
    options.frame_index = 22;
    EXPECT_EQ(test::worst_difference(test::visibility_of(ssao, options), still), 0) << "a still picture stands still";
    ssao.moves = true;
    const ReferenceImage made = test::visibility_of(ssao, options);
    const ReferenceImage expected = test::scene_reference_of(ssao, picture, options);
    double sum = 0;
    for (std::size_t i = 0; i < made.pixels.size(); ++i) sum += std::abs(made.pixels[i].r - expected.pixels[i].r);
    EXPECT_LT(sum / double(made.pixels.size()), 0.0015);
    EXPECT_GT(test::worst_difference(made, still), 0.01);
}

/// A thin post, and a wall a metre behind it.
BoxView post_view() {
    return test::view_of({.name = "post",
                          .boxes = {box(-50, -50, -5, 100, 100, 1), box(-0.05, -50, -3, 0.1, 100, 0.1)},
                          .eye = {0, 0, 0},
                          .target = {0, 0, -1}},
                         192, 64);
}

double darkest_of_the_wall(const BoxView& view, const Ssao& ssao) {
    const ReferenceImage out = test::visibility_of(ssao, view.options());
    double darkest = 1;
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        if (view.depth.pixels[i].r > 3.5) darkest = std::min(darkest, out.pixels[i].r);
    return darkest;
}

TEST(EffectSsao, ThinThingsDoNotDarkenWhatStandsFarBehind) {
    const BoxView view = post_view();
    for (const SsaoResolution resolution : {SsaoResolution::Half, SsaoResolution::Full}) {
        Ssao ssao{
            .radius = 3, .thickness = 0.1f, .samples = 64, .method = SsaoMethod::GroundTruth, .resolution = resolution};
        const double thin = darkest_of_the_wall(view, ssao);
        ssao.thickness = 0;
        const double deep = darkest_of_the_wall(view, ssao);
        ssao.thickness = 1000;
        EXPECT_EQ(darkest_of_the_wall(view, ssao), deep) << "0 is as deep as it goes";
        EXPECT_LT(deep, 0.85) << int(resolution);
        EXPECT_GT(thin, 0.9) << int(resolution);
    }
}

// Rays spread by the cosine are points spread evenly over a unit disk; a wall hides those beyond the share of the
// radius at which it stands: a segment of the disk.
TEST(EffectSsao, OcclusionOfAWallReachesTheRadius) {
    const BoxView view = test::view_of({.name = "foot",
                                        .boxes = {box(-50, -1, -50, 100, 1, 100), box(-50, 0, -9, 100, 50, 4)},
                                        .eye = {0, 3, 0},
                                        .target = {0, 0.5, -5}},
                                       64, 192);
    const Ssao ssao{.radius = 2, .samples = 64, .method = SsaoMethod::GroundTruth, .resolution = SsaoResolution::Full};
    const ReferenceImage out = test::visibility_of(ssao, view.options());
    int near = 0, far = 0;
    for (std::uint32_t y = 2; y < 190; ++y) {
        const Double3 at = view.point(32, y);
        const double share = std::min((at[2] + 5) / 2, 1.0);
        if (at[1] > 0.01 || share < 0.1) continue;
        const double hidden = (std::acos(share) - share * std::sqrt(1 - share * share)) / std::numbers::pi;
        EXPECT_NEAR(out.at(32, y).r, 1 - hidden, 0.03) << "at " << share << " of the radius";
        ++(share < 0.5 ? near : far);
    }
    EXPECT_GT(near, 10);
    EXPECT_GT(far, 10);
}

}  // namespace
}  // namespace darkroom
