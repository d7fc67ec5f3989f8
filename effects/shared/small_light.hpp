// SPDX-License-Identifier: MIT
#pragma once
// The light above a threshold in a small picture, and its blur: what halation, flares, streaks and dirt are made of.
// How small it is, and in double precision what their kernels make.

#include <vulkan/vulkan.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <darkroom/pass_builder.hpp>
#include <darkroom/reference.hpp>
#include <span>
#include <string>
#include <vector>

#include "shared/halve_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

/// What part of each side the small picture has: a quarter about 1080 lines, and less of more, so that it has as many
/// texels.
inline std::uint32_t bright_part(VkExtent2D extent) {
    std::uint32_t part = 4;
    while (part < 32 && extent.height >= part * 405) part *= 2;
    return part;
}

/// The pass that makes the small picture; `constants` say the threshold, as custom[0].x.
inline PassImage add_bright_light(PassBuilder& builder, PassImage source, std::uint32_t part,
                                  ConstantsFunction constants) {
    return builder.add({.name = "bright",
                        .shader = "shared/glow/bright_light.glsl",
                        .inputs = {{.name = "bright_source", .image = source}},
                        .output = builder.create({.name = "bright", .denominator = part}),
                        .custom_vectors = 1,
                        .constants = constants});
}

/// A bilinear tap of two texels of a row of `from`, by what of them lies under texel `at` of a row of `to` that covers
/// the same: where it lies, 0 .. 1, and its share of the mean. shared/area.glsl.
struct AreaTap {
    double place = 0, share = 0;
};
inline std::vector<AreaTap> area_taps_reference(std::uint32_t at, std::uint32_t from, std::uint32_t to) {
    const double ratio = static_cast<double>(from) / to, begin = at * ratio, end = begin + ratio;
    std::vector<AreaTap> out;
    for (double own = std::floor(begin); own < end; own += 2) {
        const double first = std::min(end, own + 1) - std::max(begin, own);
        const double second = std::max(std::min(end, own + 2) - std::max(begin, own + 1), 0.0);
        out.push_back({(own + 0.5 + second / (first + second)) / from, (first + second) / ratio});
    }
    return out;
}

/// The mean of what lies under a texel, of each tap what exceeds the threshold: c max(b - threshold, 0) / b,
/// b = max(r, g, b). Not a number and negative light count as 0.
inline ReferenceImage bright_reference(const ReferenceImage& picture, double threshold, std::uint32_t part) {
    ReferenceImage from = picture;
    for (Rgba& color : from.pixels) {
        color = clean_reference(color);
        color = {std::clamp(color.r, -65504.0, 65504.0), std::clamp(color.g, -65504.0, 65504.0),
                 std::clamp(color.b, -65504.0, 65504.0), 1};
    }
    ReferenceImage out(std::max(picture.width / part, 1u), std::max(picture.height / part, 1u), {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (const AreaTap& down : area_taps_reference(y, picture.height, out.height))
                for (const AreaTap& across : area_taps_reference(x, picture.width, out.width)) {
                    const Rgba tap = sample_reference(from, across.place, down.place);
                    const Rgba light{std::max(tap.r, 0.0), std::max(tap.g, 0.0), std::max(tap.b, 0.0), 1};
                    const double brightness = std::max({light.r, light.g, light.b});
                    const double kept = std::max(brightness - threshold, 0.0) / std::max(brightness, 1e-6);
                    out.at(x, y) = weighed_sum_reference(out.at(x, y), light, kept * across.share * down.share);
                }
    return out;
}

inline ReferenceImage bright_reference(const ReferenceImage& picture, double threshold) {
    return bright_reference(picture, threshold, bright_part({picture.width, picture.height}));
}

/// Texels to one side that a Gaussian has at most: an even number, two to a tap.
inline constexpr std::size_t light_reach = 40;

/// Weights of texels 0, 1, 2 ..., which with those of the other side sum to 1.
inline std::array<double, light_reach + 1> light_weights(double variance) {
    std::array<double, light_reach + 1> weights{};
    const auto reach = std::min(static_cast<std::size_t>(std::ceil(3 * std::sqrt(variance))), light_reach);
    double sum = 0;
    for (std::size_t i = 0; i <= reach; ++i) {
        weights[i] = std::exp(-0.5 * static_cast<double>(i * i) / variance);
        sum += i == 0 ? weights[i] : 2 * weights[i];
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// The vectors of a kernel that blurs along one axis: a texel's step, the middle's weight, how many pairs of texels
/// follow; then two pairs a vector, each a bilinear tap: how many steps away, and what it counts.
inline constexpr std::uint32_t light_line_vectors = 1 + light_reach / 4;
inline void fill_light_line(std::span<PassVector> out, VkExtent2D extent, bool is_down, double variance) {
    const auto weights = light_weights(variance);
    float pairs = 0;
    for (std::size_t i = 0; i < light_reach / 2; ++i) {
        const double first = weights[2 * i + 1], second = weights[2 * i + 2], both = first + second;
        const double place = both > 0 ? static_cast<double>(2 * i + 1) + second / both : 0;
        out[1 + i / 2][i % 2 * 2] = static_cast<float>(place);
        out[1 + i / 2][i % 2 * 2 + 1] = static_cast<float>(both);
        if (both > 0) pairs = static_cast<float>(i + 1);
    }
    out[0] = {is_down ? 0 : 1 / static_cast<float>(extent.width), is_down ? 1 / static_cast<float>(extent.height) : 0,
              static_cast<float>(weights[0]), pairs};
}

/// The pass; `constants` are by fill_light_line().
inline PassImage add_light_line(PassBuilder& builder, PassImage source, const std::string& name, std::uint32_t part,
                                ConstantsFunction constants) {
    return builder.add({.name = name,
                        .shader = "shared/glow/light_line.glsl",
                        .inputs = {{.name = "line_source", .image = source}},
                        .output = builder.create({.name = name, .denominator = part}),
                        .custom_vectors = light_line_vectors,
                        .constants = constants});
}

/// The mean of what is inside the image.
inline ReferenceImage blur_light_reference(const ReferenceImage& image, double variance) {
    const auto weights = light_weights(variance);
    constexpr auto reach = static_cast<std::int64_t>(light_reach);
    ReferenceImage across(image.width, image.height, {0, 0, 0, 1}), out = across;
    for (const bool is_down : {false, true})
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const std::int64_t own = is_down ? y : x, end = is_down ? image.height : image.width;
                const std::int64_t first = std::max(own - reach, std::int64_t{0}),
                                   behind = std::min(own + reach + 1, end);
                double inside = 0;
                for (std::int64_t i = first; i < behind; ++i)
                    inside += weights[static_cast<std::size_t>(std::abs(i - own))];
                Rgba& sum = (is_down ? out : across).at(x, y);
                for (std::int64_t i = first; i < behind; ++i)
                    sum = weighed_sum_reference(sum, is_down ? across.clamped(x, i) : image.clamped(i, y),
                                                weights[static_cast<std::size_t>(std::abs(i - own))] / inside);
            }
    return out;
}

/// The pass that makes a picture with a quarter of the sides.
inline PassImage add_quarter_light(PassBuilder& builder, PassImage source, std::uint32_t part) {
    return builder.add({.name = "quarter",
                        .shader = "shared/glow/quarter_light.glsl",
                        .inputs = {{.name = "quarter_source", .image = source}},
                        .output = builder.create({.name = "quarter", .denominator = part})});
}

/// Of about a quarter of the sides: the mean of what lies under a texel.
inline ReferenceImage quarter_light_reference(const ReferenceImage& image, std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(std::max(width, 1u), std::max(height, 1u), {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (const AreaTap& down : area_taps_reference(y, image.height, out.height))
                for (const AreaTap& across : area_taps_reference(x, image.width, out.width))
                    out.at(x, y) = weighed_sum_reference(
                        out.at(x, y), sample_reference(image, across.place, down.place), across.share * down.share);
    return out;
}

}  // namespace darkroom
