// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/negative.hpp>

#include "compose/test_stacks/support.hpp"
#include "negative/negative_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectNegative, IsOneMinusTheColor) {
    const Rgba out = negative_reference({0.25, 1.0, 3.0, 0.5}, {}, {});
    EXPECT_DOUBLE_EQ(out.r, 0.75);
    EXPECT_DOUBLE_EQ(out.g, 0.0);
    EXPECT_DOUBLE_EQ(out.b, -2.0);
    EXPECT_EQ(out.a, 0.5);
}

TEST(EffectNegative, TwiceIsThePicture) {
    const ReferenceImage picture = test::random_display(32, 32, 4);
    const ReferenceImage twice = test::reference_of(Negative{}, test::reference_of(Negative{}, picture));
    EXPECT_LE(test::worst_difference(twice, picture), 1e-15);
}

TEST(EffectNegative, GpuLeavesThePictureAtZero) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Negative{.amount = 0.0f}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

TEST(EffectNegative, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const float amount : {0.25f, 0.5f, 1.0f}) {
        SCOPED_TRACE(amount);
        test::expect_gpu_matches_reference(Negative{.amount = amount}, picture);
    }
}

}  // namespace
}  // namespace darkroom
