// SPDX-License-Identifier: MIT
#pragma once
// A tile of grain, which repeats without a seam, for three tones: a quarter, half and three quarters of the encoded
// range. Made once by a fixed seed.

#include <array>
#include <cstdint>
#include <darkroom/effects/film_grain.hpp>
#include <vector>

namespace darkroom {

inline constexpr std::uint32_t film_grain_tile_size = 256;
inline constexpr std::array<double, 3> film_grain_tones{0.25, 0.5, 0.75};

/// Of the film: radius of a disc, and standard deviation of the filter that looks at them, in texels.
inline constexpr double film_grain_radius = 1.2, film_grain_filter = 0.8;
/// Places across a texel at which it is asked whether a disc covers them.
inline constexpr std::uint32_t film_grain_places = 4;

struct FilmGrainTile {
    /// Row by row: red, green and blue are the tones in steps of 1/255, alpha is unused.
    std::vector<std::array<std::uint8_t, 4>> texels;
    /// Of the texels, in [0, 1].
    std::array<double, 3> means{}, deviations{};
    /// Of the middle tone: correlation of a texel with the next one across, and down.
    double across = 0, down = 0;
    /// Of the middle tone: the sum of the correlations with all texels around, which is how many of them a grain takes.
    double area = 1;
    /// Texels to a grain's size.
    double texels_a_grain = 1;
};

[[nodiscard]] const FilmGrainTile& film_grain_tile(FilmGrainModel model);

}  // namespace darkroom
