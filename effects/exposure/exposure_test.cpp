// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/exposure.hpp>

#include <array>

#include "compose/test_stacks/support.hpp"
#include "exposure/exposure_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectExposure, IsAMultiplier) {
    const Rgba out = exposure_reference({0.25, -1.0, 3.0, 0.5}, {}, {.exposure = 2.0f});
    EXPECT_DOUBLE_EQ(out.r, 0.5);
    EXPECT_DOUBLE_EQ(out.g, -2.0);
    EXPECT_DOUBLE_EQ(out.b, 6.0);
    EXPECT_EQ(out.a, 0.5);
}

TEST(EffectExposure, OneChangesNothingAndIsOff) {
    const Exposure one, two{.exposure = 2.0f};
    EXPECT_TRUE(effect_info(one).is_identity(&one));
    EXPECT_FALSE(effect_info(two).is_identity(&two));
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(Exposure{}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

// One stop up and one down are exact in floats.
TEST(EffectExposure, GpuUpAndDownIsThePicture) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 7));
    const auto fill = [](Composer& composer) {
        composer.add(Exposure{.exposure = 4.0f});
        composer.add(Exposure{.exposure = 0.25f});
    };
    EXPECT_EQ(test::worst_difference(test::develop(fill, picture), picture), 0.0);
}

TEST(EffectExposure, GpuZeroIsBlack) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(16, 16, 2));
    const auto fill = [](Composer& composer) { composer.add(Exposure{.exposure = 0.0f}); };
    EXPECT_EQ(test::worst_difference(test::develop(fill, picture), test::uniform(16, 16, {0, 0, 0, 1})), 0.0);
}

TEST(EffectExposure, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(67, 41, 1));
    for (const float exposure : {0.1f, 1.5f, 1024.0f}) {
        SCOPED_TRACE(exposure);
        test::expect_gpu_matches_reference(Exposure{.exposure = exposure}, picture);
    }
}

TEST(EffectExposure, AcceptsSceneLinearOnly) {
    const Domains accepts = effect_info(Exposure{}).accepts;
    EXPECT_TRUE(accepts.contains(Domain::SceneLinear));
    EXPECT_FALSE(accepts.contains(Domain::DisplayLinear) || accepts.contains(Domain::Encoded));
}

}  // namespace
}  // namespace darkroom
