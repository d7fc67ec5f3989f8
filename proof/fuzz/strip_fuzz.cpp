// SPDX-License-Identifier: MIT
// Colour tables as pictures: a picture of any size and any numbers is a table, or one line that says why not.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fuzz/bytes.hpp"
#include "fuzz/target.hpp"
#include "tables/table_image.hpp"

namespace darkroom::fuzz::strip_fuzz {
namespace {

constexpr std::size_t max_numbers = std::size_t{1} << 16;

std::string run(std::string_view input) {
    Bytes bytes(input);
    ResourceImage image;
    image.width = bytes.half();
    image.height = bytes.half();
    const Result<std::uint32_t> edge = table_image_edge(image.width, image.height);
    if (!edge) return wrong_error(edge.error());
    const std::size_t count = std::size_t{4} * image.width * image.height;
    if (std::uint64_t{*edge} * *edge * *edge != count / 4) return fmt::format("an edge of {}", *edge);
    if (count > max_numbers) return {};
    for (std::size_t i = 0; i < count; ++i) image.rgba.push_back(bytes.is_empty() ? 0.5F : bytes.number());
    const Result<ImageTable> found = table_of_image(image);
    const bool is_finite = std::ranges::all_of(image.rgba, [](float value) { return std::isfinite(value); });
    if (!found) return is_finite ? found.error().text : wrong_error(found.error());
    const ColorTable& table = found->table;
    if (table.size != *edge || table.cube.size() != count / 4 * 3) return "a table has another size than its edge";
    return std::ranges::all_of(table.cube, [](float value) { return std::isfinite(value); }) ? "" : "it is not finite";
}

std::vector<std::string> seeds() {
    return {std::string("\4\0\2\0\0\0\x80\x3f", 8), std::string("\x08\0\x08\0", 4), std::string("\0\1\x10\0", 4),
            std::string("\2\0\4\0\0\0\xc0\x7f", 8)};
}

const Registration strip({.name = "strip", .run = run, .seeds = seeds, .longest = 512});

}  // namespace
}  // namespace darkroom::fuzz::strip_fuzz
