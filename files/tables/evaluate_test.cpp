// SPDX-License-Identifier: MIT
#include "tables/evaluate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <sstream>

#include "image/test_files.hpp"
#include "tables/cube_file.hpp"
#include "tables/table_image.hpp"
#include "tables/test_tables.hpp"

namespace darkroom {
namespace {

constexpr std::array both{TableInterpolation::Tetrahedral, TableInterpolation::Trilinear};

/// Random entries for random ranges.
ColorTable random_table(std::uint32_t size, std::uint32_t shaper_size) {
    std::mt19937 random(size * 1000 + shaper_size);
    std::uniform_real_distribution<float> any(-1, 2);
    ColorTable table{.shaper_size = shaper_size,
                     .shaper_min = {-1, 0, 0.5f},
                     .shaper_max = {1, 2, 0.75f},
                     .size = size,
                     .min = {-1, -2, 0},
                     .max = {2, 2, 0.5f}};
    table.shaper.resize(std::size_t{shaper_size} * 3);
    table.cube.resize(std::size_t{size} * size * size * 3);
    for (std::vector<float>* const list : {&table.shaper, &table.cube})
        for (float& value : *list) value = any(random);
    return table;
}

TEST(TablesEvaluate, EntriesAreExact) {
    const ColorTable table = random_table(7, 0);
    for (std::size_t b = 0; b < 7; ++b)
        for (std::size_t g = 0; g < 7; ++g)
            for (std::size_t r = 0; r < 7; ++r) {
                TableColor at{double(r) / 6, double(g) / 6, double(b) / 6};
                for (std::size_t i = 0; i < 3; ++i)
                    at[i] = double{table.min[i]} + at[i] * (double{table.max[i]} - double{table.min[i]});
                const float* const entry = &table.cube[((b * 7 + g) * 7 + r) * 3];
                for (const auto how : both)
                    EXPECT_LE(test::distance(evaluate(table, at, how), {entry[0], entry[1], entry[2]}), 1e-14);
            }
}

TEST(TablesEvaluate, BetweenEntriesItIsContinuousAndLinearOnTheDiagonal) {
    const ColorTable table = random_table(5, 0);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 20000; ++i) {
        TableColor a{3 * unit(random) - 1, 4 * unit(random) - 2, unit(random) / 2}, b = a;
        for (double& value : b) value += 1e-9;
        for (const auto how : both) EXPECT_LE(test::distance(evaluate(table, a, how), evaluate(table, b, how)), 1e-6);
    }
    // Of the first cell: a quarter of the way from black to white, by tetrahedra.
    const ColorTable cube{.size = 2, .cube = {0, 0, 0, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 1, 2, 3}};
    EXPECT_EQ(evaluate(cube, {0.25, 0.25, 0.25}), (TableColor{0.25, 0.5, 0.75}));
    EXPECT_EQ(evaluate(cube, {0.5, 0.5, 0.5}, TableInterpolation::Trilinear), (TableColor{6.875, 7, 7.125}));
}

// What lies behind the last entry of a table that a host brings is not its own.
TEST(TablesEvaluate, OneEntryIsReadAlone) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    ColorTable cube{.size = 1, .cube = {0.25f, 0.5f, 0.75f}}, shaper{.shaper_size = 1, .shaper = {0.25f, 0.5f, 0.75f}};
    cube.cube.resize(24, nan);
    shaper.shaper.resize(6, nan);
    for (const ColorTable& table : {cube, shaper})
        for (const auto how : both) EXPECT_EQ(evaluate(table, {0.3, 0, 7}, how), (TableColor{0.25, 0.5, 0.75}));
}

TEST(TablesEvaluate, BeyondItsInputsIsTheirEdgeAndNanTheFirst) {
    const ColorTable table = random_table(4, 9);
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto how : both) {
        EXPECT_EQ(evaluate(table, {-infinity, 5, 0.2}, how), evaluate(table, {-1, 2, 0.5}, how));
        EXPECT_EQ(evaluate(table, {nan, infinity, nan}, how), evaluate(table, {-1, 2, 0.5}, how));
    }
}

TEST(TablesEvaluate, AShaperAloneIsACurveForEachChannel) {
    const ColorTable table{.shaper_size = 3, .shaper_max = {1, 2, 4}, .shaper = {0, 1, 2, 1, 1, 0, 5, 2, 1}};
    EXPECT_EQ(evaluate(table, {0.75, 0.5, 3}), (TableColor{3, 1, 0.5}));
    EXPECT_EQ(evaluate({}, {-1, 0.5, 3}), (TableColor{-1, 0.5, 3}));
}

class TablesExpected : public WithData {};

// What OpenColorIO made of the same files: its results are single precision.
TEST_F(TablesExpected, EveryColourIsThatOfOpenColorIO) {
    std::size_t files = 0, rows = 0;
    for (const auto& entry : std::filesystem::directory_iterator(data_ / "lut/expected")) {
        ++files;
        const std::string name = entry.path().stem().string();
        const Result<TableFile> file = parse_cube(content(data_ / ("lut/" + name + ".cube")), name);
        ASSERT_TRUE(file) << file.error().text;
        std::istringstream lines(content(data_ / ("lut/expected/" + name + ".csv")));
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with('#')) continue;
            std::ranges::replace(line, ',', ' ');
            std::istringstream numbers(line);
            std::array<TableColor, 3> colors{};
            for (TableColor& color : colors) numbers >> color[0] >> color[1] >> color[2];
            ASSERT_TRUE(numbers) << line;
            ++rows;
            const auto& [input, trilinear, tetrahedral] = colors;
            for (const auto& [how, expected] : {std::pair(TableInterpolation::Trilinear, trilinear),
                                                std::pair(TableInterpolation::Tetrahedral, tetrahedral)}) {
                const TableColor found = evaluate(file->table, input, how);
                for (std::size_t i = 0; i < 3; ++i)
                    EXPECT_NEAR(found[i], expected[i], 2e-5 * std::max(1.0, std::abs(expected[i])))
                        << name << ": " << line;
            }
        }
    }
    EXPECT_EQ(files, 10u);
    EXPECT_EQ(rows, 1970u);
}

TEST_F(TablesExpected, AShaperWithCommentsIsItsResolveForm) {
    const Result<TableFile> file =
        parse_cube(content(data_ / "lut/colour_resolve_shaper.cube"), "colour_resolve_shaper.cube");
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(file->title, "LUT3D with My Shaper");
    EXPECT_EQ(file->table.shaper_size, 10u);
    EXPECT_EQ(file->table.size, 3u);
    // The shaper's first entry lies below the cube's inputs, its last one is 1.6476816 of -0.1 .. 3 in each channel.
    EXPECT_EQ(evaluate(file->table, {-0.1, -0.1, -0.1}),
              evaluate({.size = 3, .min = {0, 0, 0}, .max = {1, 1, 1}, .cube = file->table.cube}, {0, 0, 0}));
}

/// A picture whose pixels count: pixel i is (i, i + 0.25, i + 0.5).
ResourceImage counted(std::uint32_t width, std::uint32_t height) {
    ResourceImage out{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i)
        for (const float add : {0.0f, 0.25f, 0.5f, 9.0f}) out.rgba.push_back(static_cast<float>(i) + add);
    return out;
}

TEST(TablesImage, StripsAndHaldClutsAreCubes) {
    const auto entry = [](const ImageTable& found, std::size_t r, std::size_t g, std::size_t b) {
        return found.table.cube[((b * found.table.size + g) * found.table.size + r) * 3];
    };
    // Slices side by side, below each other, and a HaldCLUT of level 2.
    const Result<ImageTable> row = table_of_image(counted(256, 16)), column = table_of_image(counted(16, 256)),
                             hald = table_of_image(counted(8, 8));
    ASSERT_TRUE(row && column && hald);
    EXPECT_EQ(row->table.size, 16u);
    EXPECT_EQ(column->table.size, 16u);
    EXPECT_EQ(hald->table.size, 4u);
    EXPECT_EQ(entry(*row, 3, 5, 7), 5 * 256 + 7 * 16 + 3);
    EXPECT_EQ(entry(*column, 3, 5, 7), (7 * 16 + 5) * 16 + 3);
    EXPECT_EQ(entry(*hald, 3, 2, 1), 16 + 2 * 4 + 3);
    EXPECT_EQ(row->table.cube[1] - row->table.cube[0], 0.25f);
}

/// Code values of 8 bits, as painters' files have them, of what `layout` says lies at a pixel.
ResourceImage painted(std::uint32_t width, std::uint32_t height, std::uint32_t edge,
                      const std::function<std::array<double, 3>(std::uint32_t x, std::uint32_t y)>& entry_at,
                      const std::function<TableColor(const TableColor&)>& graded) {
    ResourceImage out{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            TableColor color = entry_at(x, y);
            for (double& value : color) value /= edge - 1.0;
            color = graded(color);
            for (const double value : color)
                out.rgba.push_back(static_cast<float>(std::round(std::clamp(value, 0.0, 1.0) * 255) / 255));
            out.rgba.push_back(1);
        }
    return out;
}

TEST(TablesImage, SquaresAreTheSmootherOfTilesAndHaldCluts) {
    using Grade = std::function<TableColor(const TableColor&)>;
    const std::vector<Grade> grades{[](const TableColor& c) { return c; },
                                    [](const TableColor& c) {
                                        return TableColor{1 - c[0], c[1] * c[1], std::sqrt(c[2])};
                                    },
                                    [](const TableColor& c) {
                                        const double grey = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
                                        return TableColor{grey, 0.8 * grey, 0.6 * grey};
                                    },
                                    [](const TableColor& c) {
                                        return TableColor{c[2], c[2], c[2]};
                                    },
                                    [](const TableColor& c) {
                                        return TableColor{c[1], c[1], c[1]};
                                    },
                                    [](const TableColor& c) {
                                        return TableColor{std::floor(c[0] * 4) / 4, c[1] > 0.5 ? 1.0 : 0, c[2]};
                                    }};
    for (const std::uint32_t level : {2u, 4u, 8u}) {
        const std::uint32_t edge = level * level, side = edge * level;
        const auto tile_at = [&](std::uint32_t x, std::uint32_t y) {
            return std::array<double, 3>{double(x % edge), double(y % edge), double(y / edge * level + x / edge)};
        };
        const auto hald_at = [&](std::uint32_t x, std::uint32_t y) {
            const std::uint32_t n = y * side + x;
            return std::array<double, 3>{double(n % edge), double(n / edge % edge), double(n / edge / edge)};
        };
        for (const Grade& grade : grades) {
            const auto found = table_of_image(painted(side, side, edge, tile_at, grade));
            const auto hald = table_of_image(painted(side, side, edge, hald_at, grade));
            ASSERT_TRUE(found && hald);
            EXPECT_EQ(found->layout, fmt::format("{0}x{0} slices of {1}x{1}", level, edge)) << &grade - grades.data();
            EXPECT_EQ(hald->layout, "HaldCLUT") << level << " " << &grade - grades.data();
            EXPECT_EQ(found->table.cube, hald->table.cube);
        }
    }
    // Two rows of slices, in no square.
    const auto rows = table_of_image(painted(
        256, 128, 32,
        [](std::uint32_t x, std::uint32_t y) {
            return std::array<double, 3>{double(x % 32), double(y % 32), double(y / 32 * 8 + x / 32)};
        },
        grades[1]));
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->layout, "8x4 slices of 32x32");
    EXPECT_LE(test::distance(evaluate(rows->table, {0.25, 0.5, 1}), TableColor{0.75, 0.25, 1}), 0.005);
}

TEST(TablesImage, OtherSizesAndNumbersAreRefused) {
    for (const auto& [width, height] : {std::pair(0u, 0u), {1u, 1u}, {2u, 2u}, {16u, 255u}, {9u, 9u}, {256u, 15u}}) {
        const Result<ImageTable> table = table_of_image(counted(width, height));
        ASSERT_FALSE(table) << width << "x" << height;
        EXPECT_NE(table.error().text.find(fmt::format("{}x{}", width, height)), std::string::npos);
    }
    ResourceImage broken = counted(4, 2);
    broken.rgba[9] = std::numeric_limits<float>::quiet_NaN();
    const Result<ImageTable> table = table_of_image(broken);
    ASSERT_FALSE(table);
    EXPECT_NE(table.error().text.find("(2, 0) is nan"), std::string::npos) << table.error().text;
}

}  // namespace
}  // namespace darkroom
