// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/vignette.hpp>

#include <array>

#include "compose/test_stacks/support.hpp"
#include "vignette/vignette_reference.hpp"

namespace darkroom {
namespace {

double factor_at(double u, double v, const Vignette& parameters) {
    return vignette_reference({1, 1, 1, 0.5}, {.x = 0, .y = 0, .u = u, .v = v}, parameters).g;
}

TEST(EffectVignette, TheCornerLosesTheIntensityAndTheCentreNothing) {
    for (const float intensity : {0.3f, 0.75f, 1.0f}) {
        for (const float smoothness : {0.5f, 2.0f, 6.0f}) {
            const Vignette parameters{.intensity = intensity, .smoothness = smoothness};
            EXPECT_NEAR(factor_at(0, 1, parameters), 1 - double{intensity}, 1e-12);
            EXPECT_EQ(factor_at(0.5, 0.5, parameters), 1.0);
        }
    }
    // Half way to a corner, d = 0.5: 1 - 0.25 * 0.8.
    EXPECT_NEAR(factor_at(0.25, 0.25, {.intensity = 0.8f, .smoothness = 2.0f}), 0.8, 1e-7);
}

TEST(EffectVignette, FallsFromTheCentreToTheEdgeAndIsSymmetric) {
    const Vignette parameters{.intensity = 0.6f, .smoothness = 1.5f};
    double before = 2;
    for (double u = 0.5; u <= 1.0; u += 0.01) {
        const double factor = factor_at(u, 0.3, parameters);
        EXPECT_LT(factor, before) << u;
        EXPECT_NEAR(factor, factor_at(1 - u, 0.7, parameters), 1e-12);
        before = factor;
    }
}

TEST(EffectVignette, LargerSmoothnessKeepsMoreOfTheMiddle) {
    EXPECT_LT(factor_at(0.3, 0.4, {.intensity = 1, .smoothness = 1}),
              factor_at(0.3, 0.4, {.intensity = 1, .smoothness = 3}));
}

TEST(EffectVignette, ZeroIsOff) {
    const Vignette off{.intensity = 0.0f}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Vignette{.intensity = 0.0f}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

// A single pixel is the centre; of a line, the long axis alone counts.
TEST(EffectVignette, GpuOnTinyPictures) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 7u}, {9u, 1u}, {2u, 2u}}) {
        const ReferenceImage picture = test::uniform(width, height, {1, 0.5, 0.25, 0.75});
        const Vignette parameters{.intensity = 1.0f};
        const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(parameters); }, picture);
        EXPECT_LE(test::worst_half_ulps(out, test::reference_of(parameters, picture)), 2.0) << width << "x" << height;
    }
}

TEST(EffectVignette, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const Vignette& parameters :
         {Vignette{}, Vignette{.intensity = 0.9f, .smoothness = 0.1f}, Vignette{.intensity = 0.9f, .smoothness = 16.0f},
          Vignette{.intensity = 0.5f, .smoothness = 3.3f}}) {
        SCOPED_TRACE(parameters.smoothness);
        test::expect_gpu_matches_reference(parameters, picture);
    }
}

// pow() as exp2 of a logarithm (Vulkan specification, "Precision of Individual Operations"); 0 to a small power is 0.
TEST(EffectVignette, GpuTakesThePowerToFiveDigits) {
    const ReferenceImage white = test::uniform(131, 77, {1, 1, 1, 1});
    for (const float smoothness : {0.1f, 0.7f, 2.0f, 5.3f, 16.0f}) {
        const Vignette parameters{.intensity = 1.0f, .smoothness = smoothness};
        const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(parameters); }, white,
                                                 {.wait_for_lean_kernels = true});
        EXPECT_LE(test::worst_difference(out, test::reference_of(parameters, white)), 2e-5) << smoothness;
    }
}

}  // namespace
}  // namespace darkroom
