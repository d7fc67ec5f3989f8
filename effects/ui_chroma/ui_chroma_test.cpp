// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/ui_chroma.hpp>

#include "shared/test_readings.hpp"
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

TEST(EffectUiChroma, GpuMatchesReference) {
    test::expect_reading_is_the_reference({UiChroma{.strength = 0.002f}, UiChroma{.strength = 0.02f}}, 8e-3);
}

}  // namespace
}  // namespace darkroom
