// SPDX-License-Identifier: MIT
#pragma once
// Box blur in double precision: the mean of the (2 radius + 1)^2 pixels around each, as often as asked; the edge is
// repeated, and the pixel's own alpha kept.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/box_blur.hpp>
#include <darkroom/reference.hpp>

#include "shared/halve_reference.hpp"

namespace darkroom {

/// The pixels at the ends of a radius that is not whole count in part.
inline ReferenceImage box_blur_reference_line(const ReferenceImage& image, double radius, std::int64_t step_x,
                                              std::int64_t step_y) {
    const auto ends = static_cast<std::int64_t>(std::ceil(radius));
    const auto limited = [](double value) { return std::clamp(value, -65504.0, 65504.0); };
    ReferenceImage out(image.width, image.height);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            Rgba mean{0, 0, 0, 0};
            for (std::int64_t i = -ends; i <= ends; ++i)
                mean = weighed_sum_reference(
                    mean, clean_reference(image.clamped(x + i * step_x, y + i * step_y)),
                    std::clamp(radius + 1 - std::abs(static_cast<double>(i)), 0.0, 1.0) / (2 * radius + 1));
            out.at(x, y) = {limited(mean.r), limited(mean.g), limited(mean.b),
                            limited(clean_reference(image.at(x, y)).a)};
        }
    return out;
}

inline ReferenceImage box_blur_reference(const void* parameters, const ReferenceInput& input) {
    const auto& blur = *static_cast<const BoxBlur*>(parameters);
    ReferenceImage image = *input.picture;
    const double radius = pixels_of(blur.reach, blur.radius, image.height);
    for (std::int32_t i = 0; i < blur.iterations; ++i)
        image = box_blur_reference_line(box_blur_reference_line(image, radius, 1, 0), radius, 0, 1);
    return image;
}

}  // namespace darkroom
