// SPDX-License-Identifier: MIT
#pragma once
// Film grain in double precision: c' = c + g(c) n(x), where n is the tile of grain around its mean, between tones and
// between texels linear, the latter made up for what that takes of its deviation.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <darkroom/effects/film_grain.hpp>
#include <darkroom/reference.hpp>

#include "film_grain/film_grain_tile.hpp"

namespace darkroom {

/// What a frame makes of the parameters.
struct FilmGrainFrame {
    float texels_a_pixel = 1;
    std::array<double, 3> gains{};  ///< of the tones
};

inline FilmGrainFrame film_grain_frame(const FilmGrain& grain, std::uint32_t height) {
    const FilmGrainTile& tile = film_grain_tile(grain.model);
    const double size_texels = tile.texels_a_grain / double{grain.size};
    // Variance of the mean of so many texels, of which a grain takes `area`; a pixel sees no less than one.
    const auto variance = [&](double texels_a_pixel) {
        return tile.area / (tile.area + std::max(texels_a_pixel * texels_a_pixel - 1, 0.0));
    };
    const double texels_a_pixel = size_texels * 1080 / height;
    const double strength =
        double{grain.amount} / tile.deviations[1] * std::sqrt(variance(texels_a_pixel) / variance(size_texels));
    return {static_cast<float>(texels_a_pixel),
            {strength * double{grain.shadows}, strength * double{grain.midtones}, strength * double{grain.highlights}}};
}

/// Which grain a frame has: 16 bits, which a float holds.
inline std::uint32_t film_grain_number(const FilmGrain& grain, std::uint64_t frame_index) {
    return grain.animated ? static_cast<std::uint32_t>(frame_index & 0xFFFF) : 0u;
}

/// What moves the tile from cell to cell and from frame to frame, as two numbers: PCG in two dimensions (Jarzynski and
/// Olano, "Hash Functions for GPU Rendering", 2020).
inline std::array<std::uint32_t, 2> film_grain_hash(std::uint32_t x, std::uint32_t y) {
    x = x * 1664525u + 1013904223u;
    y = y * 1664525u + 1013904223u;
    for (int round = 0; round < 2; ++round) {
        x += y * 1664525u;
        y += x * 1664525u;
        x ^= x >> 16u;
        y ^= y >> 16u;
    }
    return {x, y};
}

/// Red and blue read the tile so many texels beside green.
inline constexpr std::array<std::array<double, 2>, 3> film_grain_beside{{{89, 151}, {0, 0}, {167, 61}}};

/// The tones at a place of the tile, in texels, around their means.
inline std::array<double, 3> film_grain_texel_reference(const FilmGrainTile& tile, double x, double y) {
    constexpr std::int64_t mask = film_grain_tile_size - 1;
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
    const auto at = [&](std::int64_t dx, std::int64_t dy, std::size_t tone) {
        const std::int64_t column = (static_cast<std::int64_t>(left) + dx) & mask;
        const std::int64_t row = (static_cast<std::int64_t>(top) + dy) & mask;
        return tile.texels[static_cast<std::size_t>(row * film_grain_tile_size + column)][tone] / 255.0;
    };
    // Variance of a mix of two whose correlation is known.
    const double kept = (1 - 2 * (1 - tile.across) * fx * (1 - fx)) * (1 - 2 * (1 - tile.down) * fy * (1 - fy));
    std::array<double, 3> out{};
    for (std::size_t tone = 0; tone < 3; ++tone) {
        const double mixed = (at(0, 0, tone) * (1 - fx) + at(1, 0, tone) * fx) * (1 - fy) +
                             (at(0, 1, tone) * (1 - fx) + at(1, 1, tone) * fx) * fy;
        out[tone] = (mixed - tile.means[tone]) / std::sqrt(kept);
    }
    return out;
}

inline ReferenceImage film_grain_reference(const void* parameters, const ReferenceInput& input) {
    const FilmGrain& grain = *static_cast<const FilmGrain*>(parameters);
    ReferenceImage out = *input.picture;
    const FilmGrainTile& tile = film_grain_tile(grain.model);
    const FilmGrainFrame frame = film_grain_frame(grain, out.height);
    const double color = double{grain.color}, level = std::sqrt(color * color + (1 - color) * (1 - color));
    const std::uint32_t number = film_grain_number(grain, input.frame_index);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) * double{frame.texels_a_pixel}, v = (y + 0.5) * double{frame.texels_a_pixel};
            const double column = std::floor(u / film_grain_tile_size), row = std::floor(v / film_grain_tile_size);
            const auto shift =
                film_grain_hash(static_cast<std::uint32_t>(column) + number, static_cast<std::uint32_t>(row));
            const double start_x = u - column * film_grain_tile_size + (shift[0] & (film_grain_tile_size - 1));
            const double start_y = v - row * film_grain_tile_size + (shift[1] & (film_grain_tile_size - 1));
            const auto own = [&](std::size_t channel) {
                const auto [dx, dy] = film_grain_beside[channel];
                return film_grain_texel_reference(tile, start_x + dx, start_y + dy);
            };
            const auto shared = own(1);
            constexpr double Rgba::*channels[] = {&Rgba::r, &Rgba::g, &Rgba::b};
            for (std::size_t channel = 0; channel < 3; ++channel) {
                double& value = out.at(x, y).*channels[channel];
                const auto apart = own(channel);
                double noise = 0;
                for (std::size_t tone = 0; tone < 3; ++tone) {
                    const double mixed =
                        channel == 1 ? shared[tone] : ((1 - color) * shared[tone] + color * apart[tone]) / level;
                    noise += std::max(1 - std::abs(4 * value - 1 - static_cast<double>(tone)), 0.0) *
                             frame.gains[tone] * mixed;
                }
                const double room = std::max(std::min(value, 1 - value), 0.0);
                value += std::clamp(noise, -room, room);
            }
        }
    return out;
}

}  // namespace darkroom
