// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/film_grain.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "compose/test_stacks/support.hpp"
#include "film_grain/film_grain_av1.hpp"
#include "film_grain/film_grain_reference.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

constexpr double code = 1.0 / 255;
constexpr FilmGrainModel film = FilmGrainModel::Film, av1 = FilmGrainModel::Av1;

ReferenceImage grained(const FilmGrain& grain, const ReferenceImage& picture, std::uint64_t frame = 0) {
    return film_grain_reference(&grain, {.picture = &picture, .source = &picture, .frame_index = frame});
}
ReferenceImage grey(std::uint32_t width, std::uint32_t height, double value) {
    return test::uniform(width, height, {value, value, value, 1});
}
/// The picture is code values already, as the interface's is.
ReferenceImage developed(const FilmGrain& grain, const ReferenceImage& picture, KernelStage stage = KernelStage::Auto,
                         std::uint64_t frame = 0) {
    return test::develop([&](Composer& composer) { composer.add(grain, {.input = ui_layer}); }, picture,
                         {.kernels = stage,
                          .time = 1,
                          .frame_index = frame,
                          .ui = &picture,
                          .ui_format = VK_FORMAT_R32G32B32A32_SFLOAT});
}

/// Some drivers round a filtered fetch of 8 bits to 8 bits, three of which are mixed; a step of the filter elsewhere.
/// Of the three corners, whose weights have a sum of up to sqrt(3).
double allowed(const FilmGrain& grain) {
    const FilmGrainFrame frame = film_grain_frame(grain, 61);
    return std::sqrt(3.0) * *std::ranges::max_element(frame.gains) * (1.5 / 255 + 2 * gpu::test::filter_step());
}

struct Spread {
    double mean = 0, deviation = 0;
};
Spread spread_of(const ReferenceImage& picture, double Rgba::*channel) {
    double sum = 0, squares = 0;
    for (const Rgba& color : picture.pixels) sum += color.*channel;
    const double mean = sum / static_cast<double>(picture.pixels.size());
    for (const Rgba& color : picture.pixels) squares += (color.*channel - mean) * (color.*channel - mean);
    return {mean, std::sqrt(squares / static_cast<double>(picture.pixels.size()))};
}
/// Half of each side, by the mean of four pixels.
ReferenceImage halved(const ReferenceImage& picture) {
    ReferenceImage out(picture.width / 2, picture.height / 2);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y).g = (picture.at(2 * x, 2 * y).g + picture.at(2 * x + 1, 2 * y).g +
                              picture.at(2 * x, 2 * y + 1).g + picture.at(2 * x + 1, 2 * y + 1).g) /
                             4;
    return out;
}

/// FNV-1a over the low 16 bits of each number.
template <class Numbers>
std::uint64_t digest(const Numbers& numbers) {
    std::uint64_t hash = 14695981039346656037U;
    for (const int number : numbers) hash = (hash ^ static_cast<std::uint16_t>(number)) * 1099511628211U;
    return hash;
}

// What dav1d 1.0.0 (Debian's source package) makes of the same parameters: generate_grain_y_c(), and fgy_32x32xn_c() of
// a flat picture of 12 bits with a scaling of 128 and a shift of 8.
TEST(EffectFilmGrain, TheTemplateOfAv1IsBitExact) {
    constexpr std::array<std::int8_t, 24> coefficients{2, -3, 5, -4, 6,  -2, 1,  -1, 4, -7, 12, -9,
                                                       5, -2, 3, -8, 14, 30, 11, -6, 2, -4, 9,  28};
    struct Witness {
        int depth, lag, first, middle, last;
        std::uint64_t digest;
    };
    constexpr Witness witnesses[] = {
        {8, 0, -24, -15, 10, 0x7d157630b04f7bdaU},     {8, 1, 13, 16, -10, 0x25333d1fcd7b3bf7U},
        {8, 2, 58, 18, -48, 0xfa37d6db0d130614U},      {8, 3, 4, -4, -33, 0x25bb56d138f31db5U},
        {10, 0, -96, -61, 41, 0xaf631386f81c21c5U},    {10, 1, 52, 67, -38, 0x8cfe35514c8e06b5U},
        {10, 2, 231, 74, -194, 0xf192da89360bba2aU},   {10, 3, 14, -16, -130, 0xc646fb32b46838b8U},
        {12, 0, -384, -244, 164, 0xeed64da50fe4135dU}, {12, 1, 206, 266, -154, 0x75f441d8f1c8ef72U},
        {12, 2, 924, 295, -776, 0xc21b4d106b6e7674U},  {12, 3, 56, -67, -522, 0xac8d14848a4609d7U},
    };
    constexpr std::uint64_t pictures[] = {0xfb950894acd392b4U, 0x2b74c774f972b4a4U, 0xbf6f346c3a0bf743U,
                                          0x43ac527477626b99U};
    for (const Witness& witness : witnesses) {
        SCOPED_TRACE(testing::Message() << witness.depth << " bits, lag " << witness.lag);
        const auto count = static_cast<std::size_t>(2 * witness.lag * (witness.lag + 1));
        const Av1Grain grain{.grain_seed = 1234 + 77 * static_cast<std::uint32_t>(witness.lag),
                             .bit_depth = witness.depth,
                             .grain_scale_shift = witness.lag & 1,
                             .ar_coeff_lag = witness.lag,
                             .ar_coeffs_y = std::span(coefficients).last(count)};
        const Av1Template luma = av1_grain_template(grain);
        EXPECT_EQ(luma.front(), witness.first);
        EXPECT_EQ(luma[40 * av1_grain_width + 40], witness.middle);
        EXPECT_EQ(luma.back(), witness.last);
        EXPECT_EQ(digest(luma), witness.digest);
        if (witness.depth != 12) continue;
        std::vector<std::int16_t> picture = av1_grain_picture(grain, 8, 8, false);
        for (std::int16_t& value : picture) value = static_cast<std::int16_t>((value * 128 + 128) >> 8);
        EXPECT_EQ(digest(picture), pictures[witness.lag]);
    }
}

/// Part of a disc of radius 1 that another one, `distance` away, covers.
double overlap(double distance) {
    const double half = distance / 2;
    return half >= 1 ? 0 : 2 / std::numbers::pi * (std::acos(half) - half * std::sqrt(1 - half * half));
}

/// Covariance of the film's tile at a tone with itself, so many texels away: that of a Boolean model of discs, which
/// cover a place with probability u and two places with 2 u - 1 + (1 - u)^(2 - overlap), seen through the filter.
double boolean_covariance(double tone, int dx, int dy) {
    constexpr int places = film_grain_places, taps = 4, length = places * (2 * taps + 1);
    std::array<double, length> filter{};
    double sum = 0;
    for (int i = 0; i < length; ++i) {
        const double t = (i / places - taps) / film_grain_filter;
        sum += filter[static_cast<std::size_t>(i)] = std::exp(-0.5 * t * t);
    }
    std::array<double, 2 * length - 1> twice{};
    for (std::size_t i = 0; i < length; ++i)
        for (std::size_t j = 0; j < length; ++j) twice[length - 1 + i - j] += filter[i] * filter[j] / (sum * sum);
    double out = 0;
    for (std::size_t j = 0; j < twice.size(); ++j)
        for (std::size_t i = 0; i < twice.size(); ++i) {
            const double x = dx + (static_cast<double>(i) - length + 1) / places;
            const double y = dy + (static_cast<double>(j) - length + 1) / places;
            const double both = std::pow(1 - tone, 2 - overlap(std::hypot(x, y) / film_grain_radius));
            out += twice[i] * twice[j] * (both - (1 - tone) * (1 - tone));
        }
    return out;
}

TEST(EffectFilmGrain, TheFilmIsABooleanModel) {
    const FilmGrainTile& tile = film_grain_tile(film);
    constexpr int side = film_grain_tile_size;
    for (std::size_t tone = 0; tone < 3; ++tone) {
        SCOPED_TRACE(film_grain_tones[tone]);
        EXPECT_NEAR(tile.means[tone], film_grain_tones[tone], 0.01);
        const double variance = boolean_covariance(film_grain_tones[tone], 0, 0);
        for (const auto& [dx, dy] : {std::array{0, 0}, std::array{1, 0}, std::array{0, 1}, std::array{1, 1},
                                     std::array{2, -1}, std::array{0, 3}, std::array{3, 3}, std::array{6, 0}}) {
            double sum = 0;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    const auto at = [&](int column, int row) {
                        const int place = (row & (side - 1)) * side + (column & (side - 1));
                        return tile.texels[static_cast<std::size_t>(place)][tone] / 255.0 - tile.means[tone];
                    };
                    sum += at(x, y) * at(x + dx, y + dy);
                }
            EXPECT_NEAR(sum / (side * side) / variance, boolean_covariance(film_grain_tones[tone], dx, dy) / variance,
                        0.04)
                << dx << ", " << dy;
        }
    }
}

TEST(EffectFilmGrain, EveryToneKeepsItsMean) {
    for (const FilmGrainModel model : {film, av1}) {
        // A pixel a texel: each texel is seen once.
        const auto size = static_cast<float>(film_grain_tile(model).texels_a_grain * 1080 / film_grain_tile_size);
        for (const double value : {0.0, 0.01, 0.04, 0.15, 0.25, 0.4, 0.6, 0.8, 0.93, 0.98, 1.0}) {
            const ReferenceImage out = grained({.amount = 0.06f, .size = size, .model = model},
                                               grey(film_grain_tile_size, film_grain_tile_size, value));
            EXPECT_NEAR(spread_of(out, &Rgba::g).mean, value, 0.1 * code) << value;
        }
    }
}

TEST(EffectFilmGrain, TheAmountIsTheDeviationAtEverySizeAndColor) {
    const ReferenceImage middle = grey(96, 1080, 0.5);
    for (const FilmGrainModel model : {film, av1})
        for (const float size : {0.7f, 1.5f, 3.1f})
            for (const float color : {0.0f, 0.5f}) {
                const ReferenceImage out =
                    grained({.amount = 0.04f, .size = size, .color = color, .model = model}, middle);
                for (const auto channel : {&Rgba::r, &Rgba::g, &Rgba::b})
                    EXPECT_NEAR(spread_of(out, channel).deviation / 0.04, 1, 0.06) << size << ", " << color;
            }
}

// A picture of half the lines is the one of all lines, made smaller.
TEST(EffectFilmGrain, ItIsTheSameAtEveryResolution) {
    for (const FilmGrainModel model : {film, av1})
        for (const float size : {1.0f, 1.5f, 4.0f}) {
            const FilmGrain grain{.amount = 0.04f, .size = size, .model = model};
            const auto deviation = [&](const ReferenceImage& picture) {
                return spread_of(picture, &Rgba::g).deviation;
            };
            const double half = deviation(grained(grain, grey(96, 540, 0.5)));
            EXPECT_NEAR(deviation(halved(grained(grain, grey(192, 1080, 0.5)))) / half, 1, 0.1) << size;
            const double full = deviation(grained(grain, grey(96, 1080, 0.5)));
            EXPECT_NEAR(deviation(halved(grained(grain, grey(192, 2160, 0.5)))) / full, 1, 0.1) << size;
        }
}

/// Part of the grain's power along the lines that lies beyond a frequency, in waves a pixel.
double power_beyond(const ReferenceImage& picture, double frequency, double mean) {
    double all = 0, beyond = 0;
    const auto width = static_cast<double>(picture.width);
    for (std::uint32_t wave = 1; wave <= picture.width / 2; ++wave) {
        double power = 0;
        for (std::uint32_t y = 0; y < picture.height; y += 4) {
            std::complex<double> sum;
            for (std::uint32_t x = 0; x < picture.width; ++x)
                sum += (picture.at(x, y).g - mean) * std::polar(1.0, 2 * std::numbers::pi * wave * x / width);
            power += std::norm(sum);
        }
        all += power;
        if (wave > frequency * width) beyond += power;
    }
    return beyond / all;
}

TEST(EffectFilmGrain, ItsSpectrumEndsWhereItsSizeSays) {
    for (const float size : {2.5f, 4.0f, 8.0f}) {
        const ReferenceImage out = grained({.size = size}, grey(128, 1080, 0.5));
        EXPECT_LT(power_beyond(out, 0.5 / double{size}, 0.5), 0.08) << size;
        EXPECT_GT(power_beyond(out, 0.1 / double{size}, 0.5), 0.4) << size << ": neither is it coarser";
    }
}

TEST(EffectFilmGrain, TonesHaveTheirOwnStrength) {
    for (const FilmGrainModel model : {film, av1}) {
        const auto deviation = [&](const FilmGrain& grain, double value) {
            return spread_of(grained(grain, grey(64, 1080, value)), &Rgba::g).deviation;
        };
        const FilmGrain dark{.shadows = 2, .midtones = 1, .highlights = 0, .model = model}, even{.model = model};
        EXPECT_NEAR(deviation(dark, 0.25) / deviation(even, 0.25), 2, 1e-3);
        EXPECT_NEAR(deviation(dark, 0.5) / deviation(even, 0.5), 1, 1e-3);
        EXPECT_EQ(deviation(dark, 0.75), 0);
        for (const double value : {0.0, 1.0, -0.5, 1.5}) EXPECT_EQ(deviation(even, value), 0) << value;
    }
}

TEST(EffectFilmGrain, ColorPartsTheChannels) {
    const auto correlation = [](float color) {
        const ReferenceImage out = grained({.color = color}, grey(96, 1080, 0.5));
        double product = 0, power = 0;
        for (const Rgba& pixel : out.pixels) {
            product += (pixel.r - 0.5) * (pixel.g - 0.5);
            power += (pixel.g - 0.5) * (pixel.g - 0.5);
        }
        return product / power;
    };
    EXPECT_DOUBLE_EQ(correlation(0), 1);
    EXPECT_NEAR(correlation(0.5f), std::sqrt(0.5), 0.05);
    EXPECT_NEAR(correlation(1), 0, 0.05);
}

TEST(EffectFilmGrain, StandsStillUnlessItIsAnimated) {
    const ReferenceImage picture = test::round_to_float(grey(64, 64, 0.5));
    const FilmGrain still, moving{.animated = true};
    EXPECT_EQ(test::worst_difference(developed(still, picture, KernelStage::Auto, 1),
                                     developed(still, picture, KernelStage::Auto, 2)),
              0);
    const ReferenceImage first = developed(moving, picture, KernelStage::Auto, 1);
    const ReferenceImage second = developed(moving, picture, KernelStage::Auto, 2);
    EXPECT_GT(test::worst_difference(first, second), 0.01);
    double product = 0, power = 0;
    for (std::size_t i = 0; i < first.pixels.size() && i < second.pixels.size(); ++i) {
        product += (first.pixels[i].g - 0.5) * (second.pixels[i].g - 0.5);
        power += (first.pixels[i].g - 0.5) * (first.pixels[i].g - 0.5);
    }
    EXPECT_LT(std::abs(product / power), 0.15);
    EXPECT_LE(test::worst_difference(second, grained(moving, picture, 2)), allowed(moving));
    EXPECT_NEAR(spread_of(second, &Rgba::g).mean, spread_of(grained(moving, picture, 2), &Rgba::g).mean, 0.1 * code);
}

/// The largest correlation of the green of two pictures, one moved by any whole number of pixels and wrapped.
double largest_correlation(const ReferenceImage& a, const ReferenceImage& b) {
    const auto grain_of = [](const ReferenceImage& picture, std::uint32_t times) {
        const double mean = spread_of(picture, &Rgba::g).mean;
        std::vector<float> rows;
        for (std::uint32_t y = 0; y < picture.height; ++y)
            for (std::uint32_t x = 0; x < times * picture.width; ++x)
                rows.push_back(static_cast<float>(picture.at(x % picture.width, y).g - mean));
        return rows;
    };
    const std::vector<float> left = grain_of(a, 1), right = grain_of(b, 2);
    double largest = 0;
    for (std::uint32_t dy = 0; dy < a.height; ++dy)
        for (std::uint32_t dx = 0; dx < a.width; ++dx) {
            float sum = 0;
            for (std::uint32_t y = 0; y < a.height; ++y) {
                const float* const row = &left[std::size_t{y} * a.width];
                const float* const moved = &right[std::size_t{(y + dy) % a.height} * 2 * a.width + dx];
                for (std::uint32_t x = 0; x < a.width; ++x) sum += row[x] * moved[x];
            }
            largest = std::max(largest, std::abs(double{sum}));
        }
    return largest / static_cast<double>(a.pixels.size()) /
           (spread_of(a, &Rgba::g).deviation * spread_of(b, &Rgba::g).deviation);
}

// Neither is one frame another one, moved. A pixel is 16 texels here, so that there are many tiles.
TEST(EffectFilmGrain, FramesKnowNothingOfEachOther) {
    for (const FilmGrainModel model : {film, av1}) {
        const auto size = static_cast<float>(film_grain_tile(model).texels_a_grain * 1080 / 90 / 16);
        const FilmGrain grain{.size = size, .model = model, .animated = true};
        const ReferenceImage middle = grey(160, 90, 0.5), frame = grained(grain, middle, 7);
        EXPECT_NEAR(largest_correlation(frame, frame), 1, 1e-3);
        for (const std::uint64_t other : {8, 9, 263})
            EXPECT_LT(largest_correlation(frame, grained(grain, middle, other)), 0.06);
    }
}

TEST(EffectFilmGrain, ThereAreNoSeams) {
    for (const FilmGrainModel model : {film, av1})
        for (const float size : {1.5f, 6.0f}) {
            const ReferenceImage out = grained({.size = size, .color = 0, .model = model}, grey(1000, 1080, 0.5));
            std::vector<double> across(out.width), down(out.height);
            for (std::uint32_t y = 1; y < out.height; ++y)
                for (std::uint32_t x = 1; x < out.width; ++x) {
                    across[x] += std::abs(out.at(x, y).g - out.at(x - 1, y).g);
                    down[y] += std::abs(out.at(x, y).g - out.at(x, y - 1).g);
                }
            for (std::vector<double>* const steps : {&across, &down}) {
                double sum = 0;
                for (const double step : *steps) sum += step;
                EXPECT_LT(*std::ranges::max_element(*steps) / sum * static_cast<double>(steps->size() - 1), 1.5)
                    << size;
            }
        }
}

TEST(EffectFilmGrain, GpuMatchesReference) {
    ReferenceImage picture = test::round_to_float(test::random_display(127, 61, 1));
    for (Rgba& color : picture.pixels) color.a = 1;
    picture.at(3, 4) = {-0.5, 1.5, 30000, 1};
    for (const FilmGrain& grain :
         {FilmGrain{}, FilmGrain{.amount = 0.25f, .size = 0.5f, .color = 1, .shadows = 4, .model = av1},
          FilmGrain{.amount = 0.1f, .size = 16, .color = 0, .highlights = 0}})
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage out = developed(grain, picture, stage), expected = grained(grain, picture);
            ASSERT_EQ(out.pixels.size(), expected.pixels.size());
            EXPECT_LE(test::worst_difference(out, expected), allowed(grain)) << grain.size;
            EXPECT_EQ(out.at(3, 4).r, -0.5);
            EXPECT_EQ(out.at(3, 4).b, 30000);
        }
}

TEST(EffectFilmGrain, GpuLeavesThePictureAtZero) {
    const ReferenceImage picture = test::round_to_float(test::random_display(32, 32, 5));
    EXPECT_EQ(test::worst_difference(developed({.amount = 0}, picture), picture), 0);
}

TEST(EffectFilmGrain, GpuNanStaysWhereItIs) {
    ReferenceImage picture = grey(32, 32, 0.5);
    picture.at(9, 9) = {std::numeric_limits<double>::quiet_NaN(), 0.5, std::numeric_limits<double>::infinity(), 1};
    const ReferenceImage out = developed({}, picture), clean = developed({}, grey(32, 32, 0.5));
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 32; ++x)
            if (x != 9 || y != 9) {
                EXPECT_EQ(out.at(x, y).r, clean.at(x, y).r) << x << ", " << y;
            }
}

// Light is encoded for it, and decoded behind it.
TEST(EffectFilmGrain, WorksOnCodesInALinearStack) {
    const double code_value = 0.5, light = std::pow((code_value + 0.055) / 1.055, 2.4);
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(FilmGrain{}); }, test::round_to_float(grey(64, 64, light)),
                      {.target_domain = Domain::SceneLinear});
    const ReferenceImage expected = grained({}, grey(64, 64, code_value));
    ASSERT_EQ(out.pixels.size(), expected.pixels.size());
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        EXPECT_NEAR(out.pixels[i].g, std::pow((expected.pixels[i].g + 0.055) / 1.055, 2.4), allowed({}) + 0.0005);
}

}  // namespace
}  // namespace darkroom
