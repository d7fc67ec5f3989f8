// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/chromatic_aberration.hpp>

#include <darkroom/composer.hpp>

#include "chromatic_aberration/chromatic_aberration_reference.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

TEST(EffectChromaticAberration, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    for (const float amount : {0.5f, 8.0f}) {
        const ChromaticAberration parameters{amount};
        const ReferenceImage expected = test::reference_of(parameters, picture);
        const ReferenceImage filtered = test::reference_of(parameters, test::filter_loss(picture));
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const auto fill = [&](Composer& composer) { composer.add(parameters); };
            EXPECT_LE(test::worst_difference(test::develop(fill, picture, {.kernels = stage}), expected, filtered),
                      1e-4);
        }
    }
}

// A bright column at u = 0.9 is seen red where uv + offset hits it, blue where uv - offset does: 0.012 of 0.4 apart.
TEST(EffectChromaticAberration, PartsRedAndBlueByTheDocumentedDistance) {
    constexpr std::uint32_t width = 1000;
    ReferenceImage picture(width, 1, {0, 0, 0, 1});
    picture.at(900, 0) = {1, 1, 1, 1};
    const ReferenceImage out = test::reference_of(ChromaticAberration{1.0f}, picture);
    const auto centroid = [&](double Rgba::*channel) {
        double sum = 0, moment = 0;
        for (std::uint32_t x = 0; x < width; ++x) {
            sum += out.at(x, 0).*channel;
            moment += x * (out.at(x, 0).*channel);
        }
        return moment / sum;
    };
    EXPECT_NEAR(centroid(&Rgba::g), 900, 1e-9);
    EXPECT_NEAR(centroid(&Rgba::r), 900 - 0.012 * 400, 0.1);
    EXPECT_NEAR(centroid(&Rgba::b), 900 + 0.012 * 400, 0.1);
}

TEST(EffectChromaticAberration, UpToAThousandthItIsOff) {
    const ChromaticAberration off{0.001f}, on{0.002f};
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

}  // namespace
}  // namespace darkroom
