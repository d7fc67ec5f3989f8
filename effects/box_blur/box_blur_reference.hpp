// SPDX-License-Identifier: MIT
#pragma once
// Box blur in double precision: the mean of the (2 radius + 1)^2 pixels around each, as often as asked; the edge is
// repeated, and the pixel's own alpha kept.

#include <algorithm>
#include <darkroom/effects/box_blur.hpp>
#include <darkroom/reference.hpp>

#include "shared/halve_reference.hpp"

namespace darkroom {

inline ReferenceImage box_blur_reference_line(const ReferenceImage& image, std::int64_t radius, std::int64_t step_x,
                                              std::int64_t step_y) {
    const auto limited = [](double value) { return std::clamp(value, -65504.0, 65504.0); };
    ReferenceImage out(image.width, image.height);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            Rgba mean{0, 0, 0, 0};
            for (std::int64_t i = -radius; i <= radius; ++i)
                mean = weighed_sum_reference(mean, clean_reference(image.clamped(x + i * step_x, y + i * step_y)),
                                             1.0 / static_cast<double>(2 * radius + 1));
            out.at(x, y) = {limited(mean.r), limited(mean.g), limited(mean.b),
                            limited(clean_reference(image.at(x, y)).a)};
        }
    return out;
}

inline ReferenceImage box_blur_reference(const void* parameters, const ReferenceInput& input) {
    const auto& blur = *static_cast<const BoxBlur*>(parameters);
    ReferenceImage image = *input.picture;
    for (std::int32_t i = 0; i < blur.iterations; ++i)
        image = box_blur_reference_line(box_blur_reference_line(image, blur.radius, 1, 0), blur.radius, 0, 1);
    return image;
}

}  // namespace darkroom
