// SPDX-License-Identifier: MIT
#pragma once
// Gaussian blur in double precision: the plain sum over a square of pixels, weighted by exp(-(x^2 + y^2) / (2 sigma^2))
// as the product of its two lines; the edge is repeated, and the pixel's own alpha kept. Wide blurs: the smaller
// picture's lines, by the same sum.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/gaussian_blur.hpp>
#include <darkroom/reference.hpp>
#include <vector>

#include "shared/halve_reference.hpp"
#include "shared/sample_reference.hpp"

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

/// The weights of taps, texel by texel.
inline std::vector<double> gaussian_blur_reference_weights(const GaussianBlurTaps& taps) {
    std::vector<double> weights{static_cast<double>(taps.centre_weight)};
    for (std::size_t i = 0; i < taps.count; ++i) {
        const double weight = taps.weights[i], fraction = taps.fractions[i];
        weights.push_back(weight * (1 - fraction));
        weights.push_back(weight * fraction);
    }
    return weights;
}

inline ReferenceImage gaussian_blur_reference_line(const ReferenceImage& image, const std::vector<double>& weights,
                                                   std::int64_t step_x, std::int64_t step_y) {
    const auto radius = static_cast<std::int64_t>(weights.size()) - 1;
    // Half precision ends at 65504.
    const auto limited = [](double value) { return std::clamp(value, -65504.0, 65504.0); };
    ReferenceImage out(image.width, image.height);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            Rgba sum{0, 0, 0, 0};
            for (std::int64_t i = -radius; i <= radius; ++i)
                sum = weighed_sum_reference(sum, clean_reference(image.clamped(x + i * step_x, y + i * step_y)),
                                            weights[static_cast<std::size_t>(std::abs(i))]);
            out.at(x, y) = {limited(sum.r), limited(sum.g), limited(sum.b), limited(clean_reference(image.at(x, y)).a)};
        }
    return out;
}

/// Every weight at every pixel, whatever the radius.
inline ReferenceImage gaussian_blur_reference_naive(const GaussianBlur& blur, const ReferenceImage& image) {
    const std::vector<double> weights = gaussian_blur_reference_weights(blur);
    return gaussian_blur_reference_line(gaussian_blur_reference_line(image, weights, 1, 0), weights, 0, 1);
}

inline ReferenceImage gaussian_blur_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const GaussianBlur blur = gaussian_blur_in_pixels(*static_cast<const GaussianBlur*>(parameters), picture.height);
    const std::uint32_t level = gaussian_blur_level(blur);
    if (level == 0) return gaussian_blur_reference_naive(blur, picture);
    ReferenceImage image = picture;
    for (std::uint32_t i = 0; i < level; ++i) image = halve_reference(image);
    const auto weights = [&](std::uint32_t whole, std::uint32_t part) {
        return gaussian_blur_reference_weights(gaussian_blur_taps(blur, static_cast<double>(whole) / part));
    };
    image = gaussian_blur_reference_line(image, weights(picture.width, image.width), 1, 0);
    image = gaussian_blur_reference_line(image, weights(picture.height, image.height), 0, 1);
    for (std::uint32_t i = level; i-- > 0;) {
        ReferenceImage larger(std::max(picture.width >> i, 1u), std::max(picture.height >> i, 1u));
        for (std::uint32_t y = 0; y < larger.height; ++y)
            for (std::uint32_t x = 0; x < larger.width; ++x) {
                larger.at(x, y) = sample_reference(image, (x + 0.5) / larger.width, (y + 0.5) / larger.height);
                larger.at(x, y).a = std::clamp(clean_reference(picture.clamped(x, y)).a, -65504.0, 65504.0);
            }
        image = std::move(larger);
    }
    return image;
}

}  // namespace darkroom
