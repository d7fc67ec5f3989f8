// SPDX-License-Identifier: MIT
#pragma once
// Arena bloom in double precision: bright part, four levels, weights and power of the behaviour that was measured.

#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/arena_bloom.hpp>
#include <darkroom/reference.hpp>

#include "shared/halve_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

inline constexpr std::uint32_t arena_bloom_levels = 4, arena_bloom_max_levels = 6;
inline constexpr std::array<double, arena_bloom_levels> arena_bloom_published_weights{0.32, 0.10, 0.20, 0.25};

/// Halvings by which a picture of this height needs more than one of 1080 lines.
inline double arena_bloom_shift(std::uint32_t height) { return std::log2(std::max(height, 1u) / 1080.0); }

/// Halvings that frames of at most this extent use.
inline std::uint32_t arena_bloom_level_count(VkExtent2D extent) {
    const double more = std::ceil(std::max(arena_bloom_shift(extent.height), 0.0));
    return arena_bloom_levels + std::min(static_cast<std::uint32_t>(more), arena_bloom_max_levels - arena_bloom_levels);
}

/// Of each level: the published weights of a picture of 1080 lines, each shared out between the two levels that are
/// nearest to its width here. None is narrower than the first.
inline std::array<double, arena_bloom_max_levels> arena_bloom_weights(std::uint32_t height) {
    std::array<double, arena_bloom_max_levels> out{};
    const double last = arena_bloom_level_count({height, height}) - 1;
    for (std::size_t level = 0; level < arena_bloom_levels; ++level) {
        const double place = std::clamp(static_cast<double>(level) + arena_bloom_shift(height), 0.0, last);
        const auto wide = static_cast<std::size_t>(std::ceil(place)), fine = static_cast<std::size_t>(place);
        out[fine] += arena_bloom_published_weights[level] * (1 - (place - std::floor(place)));
        out[wide] += arena_bloom_published_weights[level] * (place - std::floor(place));
    }
    return out;
}

/// What glows of a colour.
inline Rgba arena_bloom_reference_bright(Rgba color, ArenaBloomSource source) {
    const double limit = source == ArenaBloomSource::Masked ? 1.0 : 65504.0;
    for (double Rgba::*channel : {&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a})
        color.*channel = std::clamp(color.*channel, 0.0, limit);
    const double largest = std::max({color.r, color.g, color.b, 0.001});
    const double gain =
        std::max(largest - 0.925 * 0.5, 0.0) * 6.0 * (source == ArenaBloomSource::Masked ? color.a : 1.0);
    const auto part = [&](double value) { return std::min(value / largest * gain, 65504.0); };
    return {part(color.r), part(color.g), part(color.b), 1};
}

/// At a quarter of each side, of the mean of four bilinear taps.
inline ReferenceImage arena_bloom_reference_quarter(const ReferenceImage& image, ArenaBloomSource source) {
    ReferenceImage clean = image, out(std::max(image.width / 4, 1u), std::max(image.height / 4, 1u));
    for (Rgba& color : clean.pixels) color = clean_reference(color);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba mean{0, 0, 0, 0};
            for (const double dy : {0.25, 0.75})
                for (const double dx : {0.25, 0.75}) {
                    const Rgba tap = sample_reference(clean, (x + dx) / out.width, (y + dy) / out.height);
                    mean = weighed_sum_reference(mean, tap, 0.25);
                    mean.a += 0.25 * tap.a;
                }
            out.at(x, y) = arena_bloom_reference_bright(mean, source);
        }
    return out;
}

/// What is added to the picture, at a quarter of each side.
inline ReferenceImage arena_bloom_reference_glow(const ReferenceImage& image, const ArenaBloom& bloom) {
    std::array<double, arena_bloom_max_levels> weights{};
    std::ranges::copy(arena_bloom_published_weights, weights.begin());
    if (bloom.reach == Reach::Height) weights = arena_bloom_weights(image.height);
    ReferenceImage level = arena_bloom_reference_quarter(image, bloom.source_kind),
                   out(level.width, level.height, {0, 0, 0, 1});
    for (const double weight : weights) {
        level = halve_reference(level);
        for (std::uint32_t y = 0; y < out.height; ++y)
            for (std::uint32_t x = 0; x < out.width; ++x)
                out.at(x, y) = weighed_sum_reference(
                    out.at(x, y), sample_reference(level, (x + 0.5) / out.width, (y + 0.5) / out.height), weight);
    }
    const auto raised = [](double value) { return std::pow(std::clamp(value, 0.0, 1.0), 2.2); };
    for (Rgba& color : out.pixels) color = {raised(color.r), raised(color.g), raised(color.b), 1};
    return out;
}

inline ReferenceImage arena_bloom_reference(const void* parameters, const ReferenceInput& input) {
    const auto& bloom = *static_cast<const ArenaBloom*>(parameters);
    ReferenceImage out = *input.picture;
    const ReferenceImage glow = arena_bloom_reference_glow(*input.source, bloom);
    ReferenceImage half(std::max(out.width / 2, 1u), std::max(out.height / 2, 1u));
    for (std::uint32_t y = 0; y < half.height; ++y)
        for (std::uint32_t x = 0; x < half.width; ++x)
            half.at(x, y) = sample_reference(glow, (x + 0.5) / half.width, (y + 0.5) / half.height);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = weighed_sum_reference(out.at(x, y),
                                                 sample_reference(half, (x + 0.5) / out.width, (y + 0.5) / out.height),
                                                 double{bloom.intensity});
    return out;
}

}  // namespace darkroom
