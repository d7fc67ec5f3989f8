// SPDX-License-Identifier: MIT
#pragma once
// What is no number in a picture, for effects that spread light: it reaches no other pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compose/test_stacks/support.hpp"

namespace darkroom::test {

/// Grey, with a pixel of NaN at (20, 20) and one of both infinities at (40, 12).
inline ReferenceImage grey_with_no_numbers() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = uniform(64, 48, {0.5, 0.5, 0.5, 1});
    picture.at(20, 20) = {nan, nan, nan, 1};
    picture.at(40, 12) = {infinity, -infinity, 0, 1};
    return picture;
}

/// Of that picture, developed: is every other pixel a number?
inline void expect_contained(const ReferenceImage& out) {
    ASSERT_EQ(out.pixels.size(), 64U * 48U);
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            if ((x == 20 && y == 20) || (x == 40 && y == 12)) continue;
            const Rgba& color = out.at(x, y);
            EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b)) << x << ", " << y;
        }
}

}  // namespace darkroom::test
