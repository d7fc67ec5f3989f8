// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/ui_echo.hpp>

#include "shared/test_readings.hpp"
#include "ui_echo/ui_echo_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectUiEcho, AboveOneIsLargerAndAlphaIsTheLargerOne) {
    // A spot at u = 0.75; its ghost of twice the size lies at 1.
    const ReferenceSampler read = [](double u, double) {
        return std::abs(u - 0.75) < 0.01 ? Rgba{1, 1, 1, 0.8} : Rgba{0, 0, 0, 0};
    };
    const UiEcho parameters{.strength = 0.5f, .size = 2};
    const Rgba ghost = ui_echo_reference(&parameters, {0.25, 0, 0, 0.3}, {.u = 1, .v = 0.5}, read);
    EXPECT_NEAR(ghost.r, 0.75, 1e-12);
    EXPECT_NEAR(ghost.a, 0.4, 1e-12);
    const Rgba none = ui_echo_reference(&parameters, {0.25, 0, 0, 0.3}, {.u = 0.8, .v = 0.5}, read);
    EXPECT_EQ(none.r, 0.25);
    EXPECT_EQ(none.a, 0.3);
}

TEST(EffectUiEcho, IsBentAsGreenIs) {
    double seen = 0;
    const ReferenceSampler read = [&](double u, double) { return seen = u, Rgba{}; };
    const UiEcho parameters{.strength = 1};
    (void)ui_echo_reference(&parameters, {}, {.u = 1, .v = 0.5, .barrel = {9, -0.4, 9}}, read);
    EXPECT_NEAR(seen, 0.5 * (1 - 0.4 * 0.25) + 0.5, 1e-7);
}

TEST(EffectUiEcho, GpuMatchesReference) {
    test::expect_reading_is_the_reference(
        {UiEcho{.strength = 0.5f}, UiEcho{.strength = 4, .size = 0.3f}, UiEcho{.strength = 1, .size = 3}}, 2e-2);
}

}  // namespace
}  // namespace darkroom
