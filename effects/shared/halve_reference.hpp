// SPDX-License-Identifier: MIT
#pragma once
// shared/halve.glsl in double precision: a tent of two texels' half-width around the centre of each output.

#include <algorithm>
#include <cmath>
#include <darkroom/reference.hpp>

namespace darkroom {

/// NaN is black, and infinity the largest number of half precision.
inline Rgba clean_reference(const Rgba& color) {
    const auto clean = [](double value) {
        return std::isnan(value) ? 0.0 : std::isinf(value) ? std::copysign(65504.0, value) : value;
    };
    return {clean(color.r), clean(color.g), clean(color.b), clean(color.a)};
}

inline Rgba weighed_sum_reference(const Rgba& sum, const Rgba& color, double weight) {
    return {sum.r + color.r * weight, sum.g + color.g * weight, sum.b + color.b * weight, sum.a};
}

/// Alpha is 1.
inline ReferenceImage halve_reference(const ReferenceImage& image) {
    ReferenceImage out(std::max(image.width / 2, 1u), std::max(image.height / 2, 1u));
    const auto tent = [](double distance) { return std::max(0.0, 1.0 - std::abs(distance) / 2.0) / 2.0; };
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double centre_x = (x + 0.5) * image.width / out.width - 0.5;
            const double centre_y = (y + 0.5) * image.height / out.height - 0.5;
            Rgba sum{0, 0, 0, 1};
            for (double j = std::floor(centre_y) - 1; j <= centre_y + 2; ++j)
                for (double i = std::floor(centre_x) - 1; i <= centre_x + 2; ++i) {
                    const Rgba& texel = image.clamped(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j));
                    sum = weighed_sum_reference(sum, clean_reference(texel), tent(i - centre_x) * tent(j - centre_y));
                }
            out.at(x, y) = sum;
        }
    return out;
}

}  // namespace darkroom
