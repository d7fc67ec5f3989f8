// SPDX-License-Identifier: MIT
#pragma once
// Bloom in double precision: the pyramid of Jorge Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
// Warfare" (2014), tap by tap, and the sum with the picture. Nothing is rounded to half precision between levels.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <darkroom/effects/bloom.hpp>
#include <darkroom/reference.hpp>
#include <vector>

#include "shared/finite_reference.hpp"

namespace darkroom {

inline Rgba bloom_reference_sum(const Rgba& a, const Rgba& b, double weight) {
    return {a.r + b.r * weight, a.g + b.g * weight, a.b + b.b * weight, a.a};
}

/// Bilinear, the edge repeated.
inline Rgba bloom_reference_tap(const ReferenceImage& image, double u, double v) {
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const auto left = static_cast<std::int64_t>(std::floor(x)), top = static_cast<std::int64_t>(std::floor(y));
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    Rgba out{0, 0, 0, 1};
    out = bloom_reference_sum(out, image.clamped(left, top), (1 - fx) * (1 - fy));
    out = bloom_reference_sum(out, image.clamped(left + 1, top), fx * (1 - fy));
    out = bloom_reference_sum(out, image.clamped(left, top + 1), (1 - fx) * fy);
    return bloom_reference_sum(out, image.clamped(left + 1, top + 1), fx * fy);
}

/// NaN is black, light is not negative, and half precision ends at 65504.
inline Rgba bloom_reference_clean(const Rgba& color) {
    return {finite_light_reference(color.r), finite_light_reference(color.g), finite_light_reference(color.b), 1};
}

/// The factor that the soft threshold gives to a colour whose largest channel is `brightness`.
inline double bloom_reference_threshold(double brightness, double threshold, double soft_threshold) {
    const double knee = threshold * soft_threshold;
    const double s = std::clamp(brightness - threshold + knee, 0.0, 2.0 * knee);
    const double soft = s * s / (4.0 * knee + 1e-5);
    return std::max(soft, brightness - threshold) / std::max(brightness, 1e-5);
}

/// Five overlapping boxes of four bilinear taps each around a place, 0 .. 1 of both sides, whose steps are `step`; the
/// rows of the outer and of the inner taps are so many of them away. With `firefly_filter` every box is weighted by
/// 1 / (1 + luminance) (Brian Karis, "Tone mapping", 2013), and the sum divided by the sum of the weights.
struct BloomPlace {
    double u = 0, v = 0;
};
inline Rgba bloom_reference_boxes(const ReferenceImage& image, BloomPlace place, BloomPlace step, double outer,
                                  double inner, bool firefly_filter) {
    struct Box {
        double left, right, top, bottom, weight;
    };
    const std::array boxes{Box{-1, 1, -inner, inner, 0.5}, Box{-2, 0, -outer, 0, 0.125}, Box{0, 2, -outer, 0, 0.125},
                           Box{-2, 0, 0, outer, 0.125}, Box{0, 2, 0, outer, 0.125}};
    Rgba sum{0, 0, 0, 1};
    double weights = 0;
    for (const Box& box : boxes) {
        Rgba mean{0, 0, 0, 1};
        for (const double dy : {box.top, box.bottom})
            for (const double dx : {box.left, box.right}) {
                const Rgba tap = bloom_reference_tap(image, place.u + dx * step.u, place.v + dy * step.v);
                mean = bloom_reference_sum(mean, bloom_reference_clean(tap), 0.25);
            }
        const double luminance = 0.2126 * mean.r + 0.7152 * mean.g + 0.0722 * mean.b;
        const double weight = box.weight / (firefly_filter ? 1.0 + luminance : 1.0);
        sum = bloom_reference_sum(sum, mean, weight);
        weights += weight;
    }
    return bloom_reference_sum({0, 0, 0, 1}, sum, 1.0 / weights);
}

/// The half-size level. Where both sides of the one above are odd, the rows of taps lie elsewhere: see
/// bloom_taps.glsl.
inline ReferenceImage bloom_reference_down(const ReferenceImage& image) {
    ReferenceImage out(std::max(image.width / 2, 1u), std::max(image.height / 2, 1u));
    const bool is_odd = (image.width & image.height & 1u) != 0;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) =
                bloom_reference_boxes(image, {(x + 0.5) / out.width, (y + 0.5) / out.height},
                                      {0.5 / out.width, 0.5 / out.height}, is_odd ? 1 : 2, is_odd ? 1.5 : 1, false);
    return out;
}

/// The first level: cells two texels apart, as if the picture had one column and one row more where those are odd, of
/// each what `bright` leaves; then the half-size image of them by bilinear taps.
template <class Bright>
ReferenceImage bloom_reference_first(const ReferenceImage& image, bool firefly_filter, const Bright& bright) {
    ReferenceImage cells((image.width + 1) / 2, (image.height + 1) / 2),
        out(std::max(image.width / 2, 1u), std::max(image.height / 2, 1u));
    const BloomPlace texel{1.0 / image.width, 1.0 / image.height};
    for (std::uint32_t y = 0; y < cells.height; ++y)
        for (std::uint32_t x = 0; x < cells.width; ++x)
            cells.at(x, y) = bright(bloom_reference_boxes(image, {(2 * x + 1) * texel.u, (2 * y + 1) * texel.v}, texel,
                                                          2, 1, firefly_filter));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = bloom_reference_tap(cells, (x + 0.5) * image.width / out.width / 2 / cells.width,
                                               (y + 0.5) * image.height / out.height / 2 / cells.height);
    return out;
}

/// Height at which a glow by height is that by pixels.
constexpr double bloom_known_height = 1080;

/// The part of an octave of widths that the last level of a glow by height stands for: 1 at 1080 lines and at any of
/// their halves and doubles, and where a picture has too few levels.
inline double bloom_last_part(const Bloom& bloom, VkExtent2D extent) {
    if (bloom.reach != Reach::Height || extent.height == 0) return 1;
    const double octaves = bloom.levels - std::log2(bloom_known_height / extent.height);
    const double before = std::ceil(octaves - 1e-9) - 1;
    const int sides = std::bit_width(std::min(extent.width, extent.height));
    return before < 1 || before + 1 > sides - 4 ? 1 : std::min(octaves - before, 1.0);
}

/// How much of its tent the last level is brought up by, of bilinear taps alone: its glow is as wide as that part.
inline double bloom_last_tent(const Bloom& bloom, VkExtent2D extent) {
    return std::pow(std::clamp(2 * bloom_last_part(bloom, extent) - 1, 0.0, 1.0), 1.4);
}

/// `fine` plus `gain` times the coarser level, filtered by the 3x3 tent of bilinear taps one of its texels apart, or by
/// a share of it.
inline void bloom_reference_add_up(ReferenceImage& fine, const ReferenceImage& coarse, double gain, double share = 1) {
    const std::array tent{0.25 * share, 1 - 0.5 * share, 0.25 * share};
    for (std::uint32_t y = 0; y < fine.height; ++y)
        for (std::uint32_t x = 0; x < fine.width; ++x)
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const double u = (x + 0.5) / fine.width + static_cast<double>(i) / coarse.width;
                    const double v = (y + 0.5) / fine.height + static_cast<double>(j) / coarse.height;
                    const double weight = tent[static_cast<std::size_t>(i + 1)] * tent[static_cast<std::size_t>(j + 1)];
                    fine.at(x, y) =
                        bloom_reference_sum(fine.at(x, y), bloom_reference_tap(coarse, u, v), weight * gain);
                }
}

/// What the kernels store levels times, at most 1: then the sum that is made in a level's place is at most that of all
/// levels, and stays as finite.
inline double bloom_stored_weight(const BloomWeights& levels) {
    double behind = 0, most = 1;
    for (std::uint32_t i = levels.count; i-- > 0;) {
        behind += levels.weights[i];
        if (behind > 0) most = std::min(most, levels.weights[i] * levels.total() / behind);
    }
    return most;
}

/// Level 0 when all is added up: what the picture is given. There is at least one level.
inline ReferenceImage bloom_reference_pyramid(const ReferenceImage& source, const Bloom& bloom,
                                              const BloomWeights& levels) {
    const bool is_additive = bloom.mode == BloomMode::Additive;
    // Whatever halves are rounded to, the sum of all levels stays below 65504.
    const double most = 65504 * (1 - (levels.count - 1) / 1024.0), total = levels.total();
    const double last_tent = bloom_last_tent(bloom, {source.width, source.height});
    const double limit = is_additive ? most / std::max(total, 1.0) : most;
    const auto bright = [&](const Rgba& color) {
        const double brightness = std::max({color.r, color.g, color.b});
        const double factor =
            is_additive ? bloom_reference_threshold(brightness, bloom.threshold, bloom.soft_threshold) : 1;
        const auto limited = [&](double value) { return std::min(value * factor, limit); };
        return Rgba{limited(color.r), limited(color.g), limited(color.b), 1};
    };
    std::vector<ReferenceImage> pyramid{bloom_reference_first(source, is_additive && bloom.firefly_filter, bright)};
    while (pyramid.size() < levels.count) pyramid.push_back(bloom_reference_down(pyramid.back()));
    for (std::size_t level = levels.count; level-- > 0;) {
        for (Rgba& color : pyramid[level].pixels)
            color = bloom_reference_sum({0, 0, 0, 1}, color, levels.weights[level] / (is_additive ? 1 : total));
        if (level + 1 < levels.count)
            bloom_reference_add_up(pyramid[level], pyramid[level + 1], 1, level + 2 == levels.count ? last_tent : 1);
    }
    return pyramid[0];
}

inline ReferenceImage bloom_reference(const void* parameters, const ReferenceInput& input) {
    const Bloom& bloom = *static_cast<const Bloom*>(parameters);
    ReferenceImage out = *input.picture;
    const BloomWeights levels = bloom_weights(bloom, {input.source->width, input.source->height});
    if (levels.count == 0) return out;
    const ReferenceImage glow = bloom_reference_pyramid(*input.source, bloom, levels);
    const bool is_additive = bloom.mode == BloomMode::Additive;
    const double intensity = is_additive ? bloom.intensity : std::min(bloom.intensity, 1.0f);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& color = out.at(x, y);
            const double keep = is_additive ? 1.0 : 1.0 - intensity;
            const Rgba base{color.r * keep, color.g * keep, color.b * keep, color.a};
            color = bloom_reference_sum(base, bloom_reference_tap(glow, (x + 0.5) / out.width, (y + 0.5) / out.height),
                                        intensity);
        }
    return out;
}

}  // namespace darkroom
