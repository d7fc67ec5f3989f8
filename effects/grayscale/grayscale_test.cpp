// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/grayscale.hpp>

#include "compose/test_stacks/support.hpp"
#include "grayscale/grayscale_reference.hpp"

namespace darkroom {
namespace {

double luminance(const Rgba& color) { return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b; }

TEST(EffectGrayscale, PrimariesHaveTheirLuminance) {
    EXPECT_DOUBLE_EQ(grayscale_reference({1, 0, 0, 1}, {}, {}).b, 0.2126);
    EXPECT_DOUBLE_EQ(grayscale_reference({0, 1, 0, 1}, {}, {}).r, 0.7152);
    EXPECT_DOUBLE_EQ(grayscale_reference({0, 0, 1, 1}, {}, {}).g, 0.0722);
}

TEST(EffectGrayscale, KeepsGreyAndLuminanceAndAlpha) {
    for (const float amount : {0.0f, 0.3f, 1.0f}) {
        EXPECT_NEAR(grayscale_reference({0.4, 0.4, 0.4, 0.2}, {}, {amount}).g, 0.4, 1e-12);
        const Rgba color{0.9, 0.1, 4.0, 0.2};
        const Rgba out = grayscale_reference(color, {}, {amount});
        EXPECT_NEAR(luminance(out), luminance(color), 1e-12) << amount;
        EXPECT_EQ(out.a, 0.2);
    }
}

TEST(EffectGrayscale, GpuLeavesThePictureAtZero) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Grayscale{.amount = 0.0f}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

TEST(EffectGrayscale, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const float amount : {0.3f, 1.0f}) {
        SCOPED_TRACE(amount);
        test::expect_gpu_matches_reference(Grayscale{.amount = amount}, picture);
    }
}

}  // namespace
}  // namespace darkroom
