// SPDX-License-Identifier: MIT
#include "film_grain/film_grain_tile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>

#include "film_grain/film_grain_av1.hpp"

namespace darkroom {

namespace {

constexpr std::uint32_t side = film_grain_tile_size, places = film_grain_places, fine_side = side * places;
constexpr std::size_t tones = film_grain_tones.size();

/// Of a picture of this side, a power of two.
std::size_t wrapped(std::int64_t x, std::int64_t y, std::int64_t length) {
    return static_cast<std::size_t>((y & (length - 1)) * length + (x & (length - 1)));
}

/// Which of the discs, in the order they come, is the first that covers a place. The tone u is the share of places that
/// the first -log(1 - u) / (pi radius^2) discs a texel cover, so one process holds all tones (Newson et al., equation
/// 2).
std::vector<std::uint32_t> first_discs(std::uint32_t count) {
    // The numbers of this engine are the same everywhere; those of distributions are not.
    std::mt19937 random(20170601);
    const auto place = [&] { return static_cast<double>(random()) * 0x1p-32 * fine_side; };
    constexpr double reach = film_grain_radius * places;
    std::vector<std::uint32_t> first(std::size_t{fine_side} * fine_side, std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t disc = 0; disc < count; ++disc) {
        const double x = place(), y = place();
        for (auto row = static_cast<std::int64_t>(y - reach); row <= static_cast<std::int64_t>(y + reach); ++row)
            for (auto column = static_cast<std::int64_t>(x - reach); column <= static_cast<std::int64_t>(x + reach);
                 ++column) {
                const double dx = static_cast<double>(column) + 0.5 - x, dy = static_cast<double>(row) + 0.5 - y;
                if (dx * dx + dy * dy > reach * reach) continue;
                std::uint32_t& earliest = first[wrapped(column, row, fine_side)];
                earliest = std::min(earliest, disc);
            }
    }
    return first;
}

/// Along one axis and then the other.
std::vector<double> filtered(std::vector<double> picture) {
    constexpr std::int64_t taps = 4;
    std::array<double, taps + 1> weights{};
    double sum = 0;
    for (std::int64_t i = 0; i <= taps; ++i) {
        const double t = static_cast<double>(i) / film_grain_filter;
        double& weight = weights[static_cast<std::size_t>(i)];
        weight = std::exp(-0.5 * t * t);
        sum += i == 0 ? weight : 2 * weight;
    }
    for (double& weight : weights) weight /= sum;
    std::vector<double> out(picture.size());
    for (const bool is_down : {false, true}) {
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x) {
                double value = 0;
                for (std::int64_t i = -taps; i <= taps; ++i)
                    value += weights[static_cast<std::size_t>(std::abs(i))] *
                             picture[is_down ? wrapped(x, y + i, side) : wrapped(x + i, y, side)];
                out[wrapped(x, y, side)] = value;
            }
        picture = out;
    }
    return picture;
}

FilmGrainTile film() {
    const auto discs_of = [](double tone) {
        const double a_texel = -std::log(1 - tone) / (std::numbers::pi * film_grain_radius * film_grain_radius);
        return static_cast<std::uint32_t>(std::lround(a_texel * side * side));
    };
    const std::vector<std::uint32_t> first = first_discs(discs_of(film_grain_tones.back()));
    constexpr double share = 1.0 / (places * places);
    FilmGrainTile tile{.texels = std::vector<std::array<std::uint8_t, 4>>(std::size_t{side} * side),
                       .texels_a_grain = 2 * film_grain_radius};
    for (std::size_t tone = 0; tone < tones; ++tone) {
        const std::uint32_t count = discs_of(film_grain_tones[tone]);
        std::vector<double> covered(tile.texels.size());
        for (std::size_t y = 0; y < fine_side; ++y)
            for (std::size_t x = 0; x < fine_side; ++x)
                covered[y / places * side + x / places] += first[y * fine_side + x] < count ? share : 0;
        covered = filtered(std::move(covered));
        for (std::size_t i = 0; i < covered.size(); ++i)
            tile.texels[i][tone] = static_cast<std::uint8_t>(std::lround(255 * covered[i]));
    }
    return tile;
}

FilmGrainTile av1() {
    // A soft grain: each number is drawn to its neighbours above and to the left.
    constexpr std::array<std::int8_t, 4> coefficients{-8, 38, 6, 38};
    constexpr std::int32_t blocks = side / av1_grain_block;
    const std::vector<std::int16_t> picture =
        av1_grain_picture({.grain_seed = 1738, .ar_coeff_lag = 1, .ar_coeffs_y = coefficients}, blocks, blocks, true);
    FilmGrainTile tile;
    tile.texels.reserve(picture.size());
    for (const std::int16_t grain : picture) {
        const auto value = static_cast<std::uint8_t>(grain + 128);
        tile.texels.push_back({value, value, value, 0});
    }
    return tile;
}

/// What a tile tells of itself.
FilmGrainTile measured(FilmGrainTile tile) {
    const auto count = static_cast<double>(tile.texels.size());
    for (std::size_t tone = 0; tone < tones; ++tone) {
        double sum = 0, squares = 0;
        for (const auto& texel : tile.texels) {
            sum += texel[tone] / 255.0;
            squares += texel[tone] / 255.0 * texel[tone] / 255.0;
        }
        tile.means[tone] = sum / count;
        tile.deviations[tone] = std::sqrt(squares / count - tile.means[tone] * tile.means[tone]);
    }
    std::vector<double> grain;
    grain.reserve(tile.texels.size());
    for (const auto& texel : tile.texels) grain.push_back(texel[1] / 255.0 - tile.means[1]);
    const double variance = tile.deviations[1] * tile.deviations[1];
    const auto correlation = [&](std::int64_t dx, std::int64_t dy) {
        double sum = 0;
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x)
                sum += grain[wrapped(x, y, side)] * grain[wrapped(x + dx, y + dy, side)];
        return sum / count / variance;
    };
    tile.across = correlation(1, 0);
    tile.down = correlation(0, 1);
    // Both directions of a line through the middle are the same.
    constexpr std::int64_t reach = 6;
    tile.area = 1;
    for (std::int64_t dy = 0; dy <= reach; ++dy)
        for (std::int64_t dx = dy == 0 ? 1 : -reach; dx <= reach; ++dx) tile.area += 2 * correlation(dx, dy);
    return tile;
}

}  // namespace

const FilmGrainTile& film_grain_tile(FilmGrainModel model) {
    if (model == FilmGrainModel::Av1) {
        static const FilmGrainTile tile = measured(av1());
        return tile;
    }
    static const FilmGrainTile tile = measured(film());
    return tile;
}

}  // namespace darkroom
