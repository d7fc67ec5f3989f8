// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/ui_warp.hpp>

#include "shared/test_readings.hpp"
#include "ui_warp/ui_warp_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectUiWarp, ScalesThenMovesThenBends) {
    const UiWarp parameters{.strength = -0.4f, .offset = {0.1f, -0.05f}};
    const ReferencePlace place = ui_warp_reference(&parameters, {.u = 0.75, .v = 0.25});
    EXPECT_NEAR(place.u, 0.25 * 1.2 + 0.5 + 0.1, 1e-7);
    EXPECT_NEAR(place.v, -0.25 * 1.2 + 0.5 - 0.05, 1e-7);
    for (const double strength : place.barrel) EXPECT_NEAR(strength, -0.4, 1e-7);
    const ReferenceUv bent = barrel_reference(1, 1, -0.4);
    EXPECT_NEAR(bent.u, 0.5 * (1 - 0.4 * 0.5) + 0.5, 1e-12) << "a corner is half a square away";
    EXPECT_NEAR(barrel_reference(0.5, 0.5, 3).u, 0.5, 0);
}

TEST(EffectUiWarp, NothingIsNeutral) {
    const UiWarp off, moved{.offset = {0, 0.01f}};
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(moved).is_identity(&moved));
}

TEST(EffectUiWarp, GpuMatchesReference) {
    test::expect_reading_is_the_reference(
        {UiWarp{.strength = -0.5f}, UiWarp{.strength = 4, .offset = {0.2f, -0.3f}}, UiWarp{.offset = {1, 1}}}, 8e-3);
}

}  // namespace
}  // namespace darkroom
