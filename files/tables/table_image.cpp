// SPDX-License-Identifier: MIT
#include "tables/table_image.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tables/cube_file.hpp"

namespace darkroom {
namespace {

/// The level of a HaldCLUT of this side; 0: of none.
std::uint32_t hald_level(std::uint32_t side) {
    for (std::uint32_t level = 2; level * level <= max_cube_size; ++level)
        if (level * level * level == side) return level;
    return 0;
}

bool is_edge(std::uint64_t edge) { return edge >= min_table_size && edge <= max_cube_size; }

}  // namespace

Result<std::uint32_t> table_image_edge(std::uint32_t width, std::uint32_t height) {
    if (const std::uint32_t level = width == height ? hald_level(width) : 0; level > 0) return level * level;
    const std::uint64_t wide = width, high = height;
    if (is_edge(high) && wide == high * high) return height;
    if (is_edge(wide) && high == wide * wide) return width;
    return user_error(
        fmt::format("a picture of {}x{} is not a table: a strip is n*n x n or n x n*n, n in [{}, {}], a HaldCLUT is a "
                    "square of 8, 27, 64 ... 4096",
                    width, height, min_table_size, max_cube_size));
}

Result<ColorTable> table_of_image(const ResourceImage& image) {
    DARKROOM_TRY_VALUE(const std::uint32_t size, table_image_edge(image.width, image.height));
    ColorTable table{.size = size};
    const std::size_t width = image.width;
    const bool is_row = image.width > image.height;
    const std::size_t edge = table.size;
    table.cube.reserve(edge * edge * edge * 3);
    for (std::size_t b = 0; b < edge; ++b) {
        for (std::size_t g = 0; g < edge; ++g) {
            for (std::size_t r = 0; r < edge; ++r) {
                // HaldCLUTs and columns have the order of a cube's entries.
                const std::size_t pixel = is_row ? g * width + b * edge + r : (b * edge + g) * edge + r;
                for (std::size_t i = 0; i < 3; ++i) {
                    const float value = image.rgba[pixel * 4 + i];
                    if (!std::isfinite(value))
                        return user_error(fmt::format("pixel ({}, {}) is {}: entries must be finite", pixel % width,
                                                      pixel / width, value));
                    table.cube.push_back(value);
                }
            }
        }
    }
    return table;
}

}  // namespace darkroom
