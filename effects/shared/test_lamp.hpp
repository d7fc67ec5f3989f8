// SPDX-License-Identifier: MIT
#pragma once
// One lamp moved over a picture, for effects that spread light by a small picture: what they add of it does not depend
// on where it lies, whatever the ratio of the two sizes is.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "compose/test_stacks/support.hpp"

namespace darkroom::test {

/// What `added` makes of a picture of one pixel of light 1, in all, at each place along a row and a column
/// that is farther than `border` from the edges, is within 2 % of `share`.
inline void expect_lamps_count_alike(double share, std::uint32_t border,
                                     const std::function<ReferenceImage(const ReferenceImage&)>& added) {
    constexpr std::array<VkExtent2D, 5> sizes{{{128, 96}, {131, 97}, {125, 102}, {134, 103}, {127, 99}}};
    for (const VkExtent2D size : sizes)
        for (const bool is_down : {false, true})
            for (std::uint32_t at = border; at < (is_down ? size.height : size.width) - border; ++at) {
                ReferenceImage picture = uniform(size.width, size.height, {0, 0, 0, 1});
                picture.at(is_down ? size.width / 2 : at, is_down ? at : size.height / 2) = {1, 1, 1, 1};
                double sum = 0;
                for (const Rgba& color : added(picture).pixels) sum += color.g;
                EXPECT_NEAR(sum, share, 0.02 * share)
                    << size.width << 'x' << size.height << (is_down ? " row " : " column ") << at;
            }
}

}  // namespace darkroom::test
