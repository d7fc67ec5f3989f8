// SPDX-License-Identifier: MIT
#include "tables/table_image.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "tables/cube_file.hpp"

namespace darkroom {
namespace {

/// The pixel of an entry; red runs to the right in every layout.
struct Layout {
    std::size_t edge = 0, width = 0;
    bool is_hald = false;

    [[nodiscard]] std::size_t pixel(std::size_t r, std::size_t g, std::size_t b) const {
        if (is_hald) return (b * edge + g) * edge + r;
        const std::size_t columns = width / edge;
        return (b / columns * edge + g) * width + b % columns * edge + r;
    }
};

/// How much entries differ from the next ones of green and blue, in all.
double roughness(const ResourceImage& image, const Layout& layout) {
    const auto difference = [&](std::size_t from, std::size_t to) {
        double out = 0;
        for (std::size_t i = 0; i < 3; ++i) out += std::abs(double{image.rgba[4 * from + i]} - image.rgba[4 * to + i]);
        return out;
    };
    double out = 0;
    for (std::size_t b = 0; b + 1 < layout.edge; ++b)
        for (std::size_t g = 0; g + 1 < layout.edge; ++g)
            for (std::size_t r = 0; r < layout.edge; ++r) {
                const std::size_t here = layout.pixel(r, g, b);
                out += difference(here, layout.pixel(r, g + 1, b)) + difference(here, layout.pixel(r, g, b + 1));
            }
    return out;
}

bool is_hald_side(std::uint32_t side, std::uint32_t edge) {
    const auto level = static_cast<std::uint32_t>(std::lround(std::sqrt(edge)));
    return level * level == edge && level * edge == side;
}

/// Every HaldCLUT has the size of a square of slices, too. Neighbours are alike in a table: read in the wrong order it
/// jumps, by twice as much at least where it depends on green or blue.
Layout layout_of(const ResourceImage& image, std::uint32_t edge) {
    Layout tiles{edge, image.width, false};
    if (image.width != image.height || !is_hald_side(image.width, edge)) return tiles;
    const Layout hald{edge, image.width, true};
    constexpr double clearly = 0.8;
    return roughness(image, tiles) < clearly * roughness(image, hald) ? tiles : hald;
}

}  // namespace

Result<std::uint32_t> table_image_edge(std::uint32_t width, std::uint32_t height) {
    const auto edge = static_cast<std::uint32_t>(std::lround(std::cbrt(static_cast<double>(width) * height)));
    const bool is_table = edge >= min_table_size && edge <= max_cube_size && width % edge == 0 && height % edge == 0 &&
                          std::uint64_t{edge} * edge * edge == std::uint64_t{width} * height;
    if (is_table) return edge;
    return user_error(
        fmt::format("a picture of {}x{} is not a table: n slices of n x n pixels, n in [{}, {}], fill a strip "
                    "(256x16), a square (512x512) or rows of them (256x128); a HaldCLUT is a square of 8, 27, 64 ... "
                    "4096",
                    width, height, min_table_size, max_cube_size));
}

Result<ImageTable> table_of_image(const ResourceImage& image) {
    DARKROOM_TRY_VALUE(const std::uint32_t edge, table_image_edge(image.width, image.height));
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 < 3 && !std::isfinite(image.rgba[i]))
            return user_error(fmt::format("pixel ({}, {}) is {}: entries must be finite", i / 4 % image.width,
                                          i / 4 / image.width, image.rgba[i]));
    const Layout layout = layout_of(image, edge);
    ImageTable out{.table = {.size = edge}, .layout = "HaldCLUT"};
    if (!layout.is_hald)
        out.layout = fmt::format("{}x{} slices of {}x{}", image.width / edge, image.height / edge, edge, edge);
    out.table.cube.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t b = 0; b < edge; ++b)
        for (std::size_t g = 0; g < edge; ++g)
            for (std::size_t r = 0; r < edge; ++r)
                for (std::size_t i = 0; i < 3; ++i)
                    out.table.cube.push_back(image.rgba[layout.pixel(r, g, b) * 4 + i]);
    return out;
}

}  // namespace darkroom
