// SPDX-License-Identifier: MIT
#include "panels/show/scopes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace darkroom::panels {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

ScopeData of_bytes(std::uint32_t width, const std::vector<std::uint8_t>& bytes) {
    return measure({.width = width, .height = static_cast<std::uint32_t>(bytes.size() / 4 / width), .bytes = bytes});
}

ScopeData of_colors(const std::vector<std::array<float, 3>>& colors, bool is_linear = false) {
    std::vector<float> floats;
    for (const auto& [r, g, b] : colors) floats.insert(floats.end(), {r, g, b, 1});
    return measure(
        {.width = static_cast<std::uint32_t>(colors.size()), .height = 1, .floats = floats, .is_linear = is_linear});
}

/// The levels that a column has, of a channel.
std::vector<std::size_t> levels_at(const Waveform& waveform, ScopeChannel channel, std::size_t column) {
    std::vector<std::size_t> levels;
    for (std::size_t level = 0; level < Waveform::levels; ++level)
        if (waveform.counts[channel][level * Waveform::columns + column] > 0) levels.push_back(level);
    return levels;
}

TEST(PanelScopeData, EveryPixelIsCountedOnceAChannel) {
    std::vector<std::uint8_t> bytes(std::size_t{37} * 23 * 4);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7919 / 13);
    const ScopeData data = of_bytes(37, bytes);
    EXPECT_EQ(data.pixels, 37U * 23U);
    EXPECT_EQ(data.broken, 0U);
    for (std::size_t i = 0; i < scope_channels; ++i) {
        const auto& bins = data.histogram.counts[i];
        EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), 0U), data.pixels);
        const auto& cells = data.waveform.counts[i];
        EXPECT_EQ(std::accumulate(cells.begin(), cells.end(), 0U), data.pixels);
        EXPECT_LE(*std::ranges::max_element(cells), data.waveform.most);
    }
    const auto& cells = data.vectorscope.counts;
    EXPECT_EQ(std::accumulate(cells.begin(), cells.end(), 0U), data.pixels);
    EXPECT_EQ(*std::ranges::max_element(cells), data.vectorscope.most);
}

TEST(PanelScopeData, ACodeHasItsOwnBin) {
    std::vector<std::uint8_t> bytes;
    for (int code = 0; code < 256; ++code)
        for (const int value : {code, 255 - code, 9, 0}) bytes.push_back(static_cast<std::uint8_t>(value));
    const Histogram histogram = of_bytes(256, bytes).histogram;
    for (std::size_t code = 0; code < 256; ++code) {
        EXPECT_EQ(histogram.counts[ScopeRed][code], 1U) << code;
        EXPECT_EQ(histogram.counts[ScopeGreen][code], 1U) << code;
        EXPECT_EQ(histogram.counts[ScopeBlue][code], code == 9 ? 256U : 0U) << code;
    }
}

TEST(PanelScopeData, LumaIsWeighted) {
    const Histogram histogram = of_colors({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0.5f, 0.5f}}).histogram;
    for (const std::size_t bin : {54U, 182U, 18U, 128U}) EXPECT_EQ(histogram.counts[ScopeLuma][bin], 1U) << bin;
}

TEST(PanelScopeData, CountsWhatIsClippedAndBroken) {
    const ScopeData data = of_colors({{0, 0.5f, 1}, {-3, 0.2f, 7}, {0.001f, 0.999f, 0.5f}, {not_a_number, 0, 0}});
    EXPECT_EQ(data.pixels, 3U);
    EXPECT_EQ(data.broken, 1U);
    EXPECT_EQ(data.histogram.black, (std::array{2U, 0U, 0U, 0U}));
    EXPECT_EQ(data.histogram.white, (std::array{0U, 0U, 2U, 0U}));
    EXPECT_EQ(data.histogram.counts[ScopeRed][0], 3U);
    EXPECT_EQ(data.histogram.counts[ScopeBlue][255], 2U);
}

TEST(PanelScopeData, LinearLightIsEncoded) {
    const Histogram histogram = of_colors({{0.18f, 1, 0.001f}}, true).histogram;
    EXPECT_EQ(histogram.counts[ScopeRed][118], 1U);  // sRGB of 0.18 is 0.4614
    EXPECT_EQ(histogram.counts[ScopeBlue][3], 1U);
    EXPECT_EQ(histogram.white[ScopeGreen], 1U);
}

TEST(PanelScopeData, WaveformsKeepPlaceAndLevel) {
    // Black on the left, 0.25 in the middle, white on the right.
    std::vector<std::array<float, 3>> row(320);
    for (std::size_t x = 0; x < row.size(); ++x) row[x] = {x < 120 ? 0.0f : 0.25f, x < 200 ? 0.5f : 1.0f, 0.125f};
    const Waveform waveform = of_colors(row).waveform;
    for (std::size_t column = 0; column < Waveform::columns; ++column) {
        EXPECT_EQ(levels_at(waveform, ScopeRed, column), std::vector<std::size_t>{column < 60 ? 0U : 25U}) << column;
        EXPECT_EQ(levels_at(waveform, ScopeGreen, column), std::vector<std::size_t>{column < 100 ? 50U : 100U});
    }
    EXPECT_EQ(waveform.most, 2U);
}

TEST(PanelScopeData, NarrowPicturesAreSpreadOverTheColumns) {
    const Waveform waveform = of_colors({{0, 0, 0}, {1, 1, 1}}).waveform;
    EXPECT_EQ(levels_at(waveform, ScopeLuma, 0), std::vector<std::size_t>{0});
    EXPECT_EQ(levels_at(waveform, ScopeLuma, Waveform::columns / 2), std::vector<std::size_t>{100});
}

TEST(PanelScopeData, GreyIsInTheMiddleOfTheVectorscope) {
    const auto [cb, cr] = color_difference({0.3f, 0.3f, 0.3f});
    EXPECT_NEAR(cb, 0, 1e-6f);
    EXPECT_NEAR(cr, 0, 1e-6f);
    // The primaries' own difference reaches the edge (BT.709-6, 3.3).
    EXPECT_NEAR(color_difference({1, 0, 0})[1], 0.5f, 1e-4f);
    EXPECT_NEAR(color_difference({0, 0, 1})[0], 0.5f, 1e-4f);
    EXPECT_NEAR(color_difference({1, 1, 0})[0], -0.5f, 1e-4f);
    const Vectorscope scope = of_colors({{1, 0, 0}}).vectorscope;
    EXPECT_EQ(std::ranges::find(scope.counts, 1U) - scope.counts.begin(), 37);  // top row, left of the middle
}

TEST(PanelScopeData, PicturesThatAreTooShortAreCountedAsFarAsTheyGo) {
    const std::vector<std::uint8_t> bytes(4 * 10);
    EXPECT_EQ(measure({.width = 100, .height = 100, .bytes = bytes}).pixels, 10U);
    EXPECT_EQ(measure({.width = 0, .height = 5, .bytes = bytes}).pixels, 0U);
    EXPECT_EQ(measure({}).pixels, 0U);
}

}  // namespace
}  // namespace darkroom::panels
