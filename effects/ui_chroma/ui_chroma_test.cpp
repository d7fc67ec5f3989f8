// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/ui_chroma.hpp>

#include "compose/test_support.hpp"
#include "ui_chroma/ui_chroma_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectUiChroma, PartsRedAndBlueAboutGreenLessOnTallerPictures) {
    const UiChroma parameters{.strength = 0.01f};
    for (const std::uint32_t height : {540u, 1080u, 2160u}) {
        const ReferencePlace place = ui_chroma_reference(&parameters, {.barrel = {0.3, 0.3, 0.3}, .height = height});
        EXPECT_NEAR(place.barrel[0], 0.3 + 0.01 * 1080 / height, 1e-9);
        EXPECT_EQ(place.barrel[1], 0.3);
        EXPECT_NEAR(place.barrel[2], 0.3 - 0.01 * 1080 / height, 1e-9);
    }
}

// What differs is how finely a sampler places texels: 1/256 of one, in each direction.
TEST(EffectUiChroma, GpuMatchesReference) {
    for (const auto& [width, height] : {std::pair{67u, 41u}, {1u, 1u}, {1u, 7u}, {64u, 36u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 3));
        for (const UiChroma& parameters : {UiChroma{.strength = 0.002f}, UiChroma{.strength = 0.02f}}) {
            const ReferenceImage expected = test::reference_of(parameters, picture);
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage out =
                    test::develop([&](Composer& composer) { composer.add(parameters); }, picture, {.kernels = stage});
                EXPECT_LE(test::worst_difference(out, expected), 8e-3) << width << "x" << height;
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
