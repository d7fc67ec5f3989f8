// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/radial_blur.hpp>

#include <darkroom/composer.hpp>

#include "compose/test_stacks/support.hpp"
#include "radial_blur/radial_blur_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectRadialBlur, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const float strength : {0.3f, 1.0f, 4.0f}) {
        SCOPED_TRACE(strength);
        // Where a tap falls between two pixels depends on uv in single precision: 1e-4 of a step between neighbours.
        const RadialBlur parameters{strength};
        const ReferenceImage expected = test::reference_of(parameters, picture);
        const ReferenceImage filtered = test::reference_of(parameters, test::filter_loss(picture));
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const auto fill = [&](Composer& composer) { composer.add(parameters); };
            const ReferenceImage out = test::develop(fill, picture, {.kernels = stage});
            EXPECT_LE(test::worst_difference(out, expected, filtered), 4e-4);
        }
    }
}

TEST(EffectRadialBlur, TheMiddleIsSharpAndCornersAreMeans) {
    ReferenceImage picture(64, 64);
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) picture.at(x, y) = {(x + y) % 2 == 0 ? 1.0 : 0.0, 0.5, 0, 1};
    const RadialBlur parameters{2.0f};
    const ReferenceImage out = test::reference_of(parameters, picture);
    EXPECT_EQ(out.at(32, 32).r, picture.at(32, 32).r);
    EXPECT_NEAR(out.at(2, 60).r, 0.5, 0.3);
    EXPECT_NEAR(out.at(2, 60).g, 0.5, 1e-12);
}

TEST(EffectRadialBlur, UpToAThousandthItIsOff) {
    const RadialBlur off{0.001f}, on{0.002f};
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

}  // namespace
}  // namespace darkroom
