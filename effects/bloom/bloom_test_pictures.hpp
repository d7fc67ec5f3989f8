// SPDX-License-Identifier: MIT
#pragma once
// What the tests of bloom share. Not part of the library.

#include <darkroom/effects/bloom.hpp>
#include <numeric>

#include "compose/test_stacks/support.hpp"

namespace darkroom::test {

/// By pixels, as was published.
inline Bloom published(Bloom bloom = {}) {
    bloom.reach = Reach::Pixels;
    return bloom;
}

inline ReferenceImage impulse(std::uint32_t width, std::uint32_t height, std::uint32_t x, std::uint32_t y,
                              double value) {
    ReferenceImage image(width, height);
    image.at(x, y) = {value, value, value, 1};
    return image;
}

inline double red_sum(const ReferenceImage& image) {
    return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0,
                           [](double sum, const Rgba& color) { return sum + color.r; });
}

/// The glow alone, in the additive mode: everything glows, no firefly filter.
inline Bloom everything_glows(std::int32_t levels) {
    return published({.intensity = 1, .threshold = 0, .soft_threshold = 0, .firefly_filter = false, .levels = levels});
}

}  // namespace darkroom::test
