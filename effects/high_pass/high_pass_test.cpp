// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/effects/high_pass.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "high_pass/high_pass_reference.hpp"

namespace darkroom {
namespace {

ReferenceImage developed(const HighPass& parameters, const ReferenceImage& picture) {
    return test::develop([&](Composer& composer) { composer.add(parameters); }, picture);
}

TEST(EffectHighPass, BelowTheThresholdIsBlackAndAboveIsUntouched) {
    const HighPass parameters{.threshold = 0.5f};
    const Rgba below = high_pass_reference({0.49, 0.49, 0.49, 0.3}, {}, parameters);
    EXPECT_EQ(below.r + below.g + below.b, 0.0);
    EXPECT_EQ(below.a, 0.3);
    const Rgba above = high_pass_reference({0.1, 0.9, 7, 0.3}, {}, parameters);
    EXPECT_EQ(above.r, 0.1);
    EXPECT_EQ(above.g, 0.9);
    EXPECT_EQ(above.b, 7.0);
    // Luminance counts, not the largest channel: blue of 2 has 0.144.
    EXPECT_EQ(high_pass_reference({0, 0, 2, 1}, {}, parameters).b, 0.0);
    EXPECT_EQ(high_pass_reference({0, 2, 0, 1}, {}, parameters).g, 2.0);
}

TEST(EffectHighPass, TheKneeRisesSmoothlyToTheThreshold) {
    const HighPass parameters{.threshold = 1.0f, .knee = 0.5f};
    const auto kept = [&](double grey) { return high_pass_reference({grey, grey, grey, 1}, {}, parameters).r / grey; };
    EXPECT_EQ(kept(0.5), 0.0);
    EXPECT_NEAR(kept(0.75), 0.5, 1e-12);
    EXPECT_EQ(kept(1.0), 1.0);
    double before = 0;
    for (double grey = 0.5; grey < 1.2; grey += 0.01) {
        EXPECT_GE(kept(grey), before);
        before = kept(grey);
    }
}

TEST(EffectHighPass, GpuHardEdgeIsExact) {
    // Greys around the threshold, one place of single precision apart.
    ReferenceImage picture(3, 1);
    const float threshold = 1.0f;
    const double just_below = double{std::nextafter(threshold, 0.0f)};
    picture.at(0, 0) = {0, just_below * 0.999, 0, 1};
    picture.at(1, 0) = {2, 2, 2, 0.25};
    picture.at(2, 0) = {0, 0, 13, 1};
    const ReferenceImage out = developed({.threshold = threshold}, picture);
    EXPECT_EQ(out.at(0, 0).g, 0.0);
    EXPECT_EQ(out.at(1, 0).r, 2.0);
    EXPECT_EQ(out.at(1, 0).a, 0.25);
    EXPECT_EQ(out.at(2, 0).b, 0.0);
}

TEST(EffectHighPass, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const HighPass& parameters :
         {HighPass{}, HighPass{.threshold = 0.3f}, HighPass{.threshold = 500},
          HighPass{.threshold = 0.8f, .knee = 0.6f}, HighPass{.threshold = 0, .knee = 1}}) {
        SCOPED_TRACE(parameters.threshold);
        test::expect_gpu_matches_reference(parameters, picture);
    }
}

TEST(EffectHighPass, GpuNanBecomesBlackAndInfinityStays) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture(4, 4, {2, 2, 2, 1});
    picture.at(1, 1) = {nan, 1, 1, 1};
    picture.at(2, 2) = {infinity, 1, 1, 1};
    const ReferenceImage out = developed({}, picture);
    EXPECT_EQ(out.at(1, 1).r + out.at(1, 1).g, 0.0);
    EXPECT_EQ(out.at(2, 2).g, 1.0);
    EXPECT_EQ(out.at(0, 0).r, 2.0);
}

}  // namespace
}  // namespace darkroom
