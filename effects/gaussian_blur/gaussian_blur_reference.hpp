// SPDX-License-Identifier: MIT
#pragma once
// Gaussian blur in double precision: the plain sum over a square of pixels, weighted by exp(-(x^2 + y^2) / (2 sigma^2))
// as the product of its two lines; the edge is repeated, and the pixel's own alpha kept.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/gaussian_blur.hpp>
#include <darkroom/reference.hpp>
#include <vector>

namespace darkroom {

/// Weights of pixels 0 .. radius to one side, normalised so that the whole line sums to 1.
inline std::vector<double> gaussian_blur_reference_weights(const GaussianBlur& blur) {
    const double sigma = blur.sigma > 0 ? static_cast<double>(blur.sigma) : blur.radius / 3.0;
    std::vector<double> weights{1.0};
    double sum = 1.0;
    for (int i = 1; i <= blur.radius; ++i) {
        weights.push_back(std::exp(-static_cast<double>(i) * i / (2.0 * sigma * sigma)));
        sum += 2.0 * weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

inline ReferenceImage gaussian_blur_reference_line(const ReferenceImage& image, const std::vector<double>& weights,
                                                   std::int64_t step_x, std::int64_t step_y) {
    // NaN is black, and half precision ends at 65504.
    const auto clean = [](double value) { return std::isnan(value) ? 0.0 : std::clamp(value, -65504.0, 65504.0); };
    const auto radius = static_cast<std::int64_t>(weights.size()) - 1;
    ReferenceImage out(image.width, image.height);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            Rgba sum{0, 0, 0, clean(image.at(x, y).a)};
            for (std::int64_t i = -radius; i <= radius; ++i) {
                const Rgba& color = image.clamped(x + i * step_x, y + i * step_y);
                const double weight = weights[static_cast<std::size_t>(std::abs(i))];
                sum.r += clean(color.r) * weight;
                sum.g += clean(color.g) * weight;
                sum.b += clean(color.b) * weight;
            }
            out.at(x, y) = sum;
        }
    return out;
}

inline ReferenceImage gaussian_blur_reference(const void* parameters, const ReferenceInput& input) {
    const std::vector<double> weights = gaussian_blur_reference_weights(*static_cast<const GaussianBlur*>(parameters));
    return gaussian_blur_reference_line(gaussian_blur_reference_line(*input.picture, weights, 1, 0), weights, 0, 1);
}

}  // namespace darkroom
