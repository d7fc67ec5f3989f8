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

/// PCG in three dimensions: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
inline std::array<std::uint32_t, 3> film_grain_hash(std::array<std::uint32_t, 3> value) {
    auto& [x, y, z] = value;
    for (std::uint32_t& number : value) number = number * 1664525u + 1013904223u;
    const auto mix = [&] {
        x += y * z;
        y += z * x;
        z += x * y;
    };
    mix();
    for (std::uint32_t& number : value) number ^= number >> 16u;
    mix();
    return value;
}

/// Side of the triangles at whose corners the tile begins anew, in texels.
inline constexpr double film_grain_lattice = 64;
struct FilmGrainCorner {
    double weight = 0;
    std::array<std::uint32_t, 2> shift{};
};
/// Heitz and Neyret, "High-Performance By-Example Noise using a Histogram-Preserving Blending Operator", 2018, section
/// 4. The squares of the weights have a sum of 1, which keeps the deviation. The frame's number is a dimension of the
/// hash: added to a place it would make each frame the one before, moved.
inline std::array<FilmGrainCorner, 3> film_grain_corners(double u, double v, std::uint32_t number) {
    // In steps along two sides of a triangle, one of which is level.
    const double down = v / film_grain_lattice / std::sqrt(0.75), across = u / film_grain_lattice - down / 2;
    const double column = std::floor(across), row = std::floor(down), x = across - column, y = down - row;
    const bool is_upper = x + y > 1;
    const std::array<double, 3> shares = is_upper ? std::array{x + y - 1, 1 - y, 1 - x} : std::array{1 - x - y, x, y};
    constexpr std::array<std::array<double, 2>, 3> lower{{{0, 0}, {1, 0}, {0, 1}}}, upper{{{1, 1}, {1, 0}, {0, 1}}};
    const double length = std::hypot(shares[0], shares[1], shares[2]);
    std::array<FilmGrainCorner, 3> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [dx, dy] = (is_upper ? upper : lower)[i];
        const auto whole = [](double place) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(place)); };
        const auto hash = film_grain_hash({whole(column + dx), whole(row + dy), number});
        out[i] = {shares[i] / length, {hash[0] & (film_grain_tile_size - 1), hash[1] & (film_grain_tile_size - 1)}};
    }
    return out;
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
            const auto corners = film_grain_corners(u, v, number);
            const auto own = [&](std::size_t channel) {
                const auto [dx, dy] = film_grain_beside[channel];
                std::array<double, 3> tones{};
                for (const FilmGrainCorner& corner : corners) {
                    const auto texel =
                        film_grain_texel_reference(tile, u + dx + corner.shift[0], v + dy + corner.shift[1]);
                    for (std::size_t tone = 0; tone < 3; ++tone) tones[tone] += corner.weight * texel[tone];
                }
                return tones;
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
