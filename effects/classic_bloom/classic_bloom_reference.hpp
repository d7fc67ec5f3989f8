// SPDX-License-Identifier: MIT
#pragma once
// Classic bloom in double precision: extract, lines, columns and sum, tap by tap.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/classic_bloom.hpp>
#include <darkroom/reference.hpp>

#include "shared/halve_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

/// Texels of the small picture to one side, and the middle one: of the widest glow of 4320 lines. Of more
/// lines the widest is no wider.
inline constexpr std::size_t classic_bloom_capacity = 66;

/// In the picture's own pixels.
inline double classic_bloom_radius(const ClassicBloom& bloom, std::uint32_t height) {
    return std::min(pixels_of(bloom.reach, bloom.radius, height), 4.0 * (classic_bloom_capacity - 1));
}
inline std::int32_t classic_bloom_taps(double radius) { return static_cast<std::int32_t>(std::ceil(radius / 4)); }

/// Weights of texels 0 .. radius / 4 of the small picture, four pixels apart, to one side: a Gaussian whose variance is
/// that of the whole, (radius / 3)^2 pixels, less what the other steps add: 5/4 the mean of four pixels, 3 and 3/4
/// the bilinear filters to half and to full size.
inline std::array<double, classic_bloom_capacity> classic_bloom_weights(double radius) {
    std::array<double, classic_bloom_capacity> weights{};
    const double variance = std::max((radius * radius / 9.0 - 5.0) / 16.0, 0.01);
    double sum = 0;
    for (std::int32_t i = 0; i <= classic_bloom_taps(radius); ++i) {
        double& weight = weights[static_cast<std::size_t>(i)];
        weight = std::exp(-0.5 * i * i / variance);
        sum += i == 0 ? weight : 2 * weight;
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

inline Rgba classic_bloom_reference_bright(const Rgba& color, const ClassicBloom& bloom) {
    const Rgba light{std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0), 1};
    const double threshold = double{bloom.threshold};
    const double luminance = 0.2126 * light.r + 0.7152 * light.g + 0.0722 * light.b;
    const double brightness = std::max({light.r, light.g, light.b});
    const double kept = bloom.source_kind == ClassicBloomSource::HighPass
                            ? (luminance >= threshold ? 1.0 : 0.0)
                            : std::max(brightness - threshold, 0.0) / std::max(brightness, 1e-6);
    return {light.r * kept, light.g * kept, light.b * kept, 1};
}

/// A quarter of each side: the mean of four bilinear taps, of each what glows.
inline ReferenceImage classic_bloom_reference_extract(const ReferenceImage& picture, const ReferenceImage& source,
                                                      const ClassicBloom& bloom) {
    const auto cleaned = [](ReferenceImage image) {
        for (Rgba& color : image.pixels) color = clean_reference(color);
        return image;
    };
    const ReferenceImage from = cleaned(picture), by = cleaned(source);
    ReferenceImage out(std::max(picture.width / 4, 1u), std::max(picture.height / 4, 1u), {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (const double dy : {0.25, 0.75})
                for (const double dx : {0.25, 0.75}) {
                    const double u = (x + dx) / out.width, v = (y + dy) / out.height;
                    const Rgba tap = sample_reference(by, u, v);
                    const bool is_layer = bloom.source_kind == ClassicBloomSource::Layer;
                    const Rgba color = is_layer ? sample_reference(from, u, v) : tap;
                    const Rgba light{std::max(color.r, 0.0), std::max(color.g, 0.0), std::max(color.b, 0.0), 1};
                    out.at(x, y) =
                        is_layer
                            ? weighed_sum_reference(out.at(x, y), light, 0.25 * std::clamp(tap.r, 0.0, 1.0))
                            : weighed_sum_reference(out.at(x, y), classic_bloom_reference_bright(tap, bloom), 0.25);
                }
    return out;
}

/// Taps `step_x`, `step_y` of the picture apart, into one of width x height.
inline ReferenceImage classic_bloom_reference_line(const ReferenceImage& image, std::uint32_t width,
                                                   std::uint32_t height, double step_x, double step_y, double radius) {
    const auto weights = classic_bloom_weights(radius);
    const std::int32_t taps = classic_bloom_taps(radius);
    ReferenceImage out(width, height, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::int32_t i = -taps; i <= taps; ++i)
                out.at(x, y) = weighed_sum_reference(
                    out.at(x, y),
                    sample_reference(image, (x + 0.5) / width + i * step_x, (y + 0.5) / height + i * step_y),
                    weights[static_cast<std::size_t>(std::abs(i))]);
    return out;
}

inline ReferenceImage classic_bloom_reference(const void* parameters, const ReferenceInput& input) {
    const auto& bloom = *static_cast<const ClassicBloom*>(parameters);
    ReferenceImage out = *input.picture;
    const double radius = classic_bloom_radius(bloom, out.height);
    const ReferenceImage small = classic_bloom_reference_extract(*input.picture, *input.source, bloom);
    const ReferenceImage wide = classic_bloom_reference_line(
        small, std::max(out.width / 2, 1u), std::max(out.height / 2, 1u), 1.0 / small.width, 0, radius);
    const ReferenceImage glow = classic_bloom_reference_line(wide, out.width, out.height, 0, 2.0 / wide.height, radius);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = weighed_sum_reference(out.pixels[i], glow.pixels[i], double{bloom.intensity});
    return out;
}

}  // namespace darkroom
