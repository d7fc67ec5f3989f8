// SPDX-License-Identifier: MIT
// Colour tables as text: memory follows the text, whatever its sizes say, and what is read is written so that the same
// bits come back.

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "fuzz/target.hpp"
#include "tables/cube_file.hpp"

namespace darkroom::fuzz::cube_fuzz {
namespace {

bool is_same(std::span<const float> a, std::span<const float> b) {
    return std::ranges::equal(
        a, b, {}, [](float x) { return std::bit_cast<std::uint32_t>(x); },
        [](float x) { return std::bit_cast<std::uint32_t>(x); });
}

bool is_same(const ColorTable& a, const ColorTable& b) {
    return a.shaper_size == b.shaper_size && a.size == b.size && is_same(a.shaper, b.shaper) &&
           is_same(a.cube, b.cube) && is_same(a.shaper_min, b.shaper_min) && is_same(a.shaper_max, b.shaper_max) &&
           is_same(a.min, b.min) && is_same(a.max, b.max);
}

std::string run(std::string_view input) {
    const Result<TableFile> file = parse_cube(input, "a.cube");
    if (!file) return file.error().text.starts_with("a.cube:") ? wrong_error(file.error()) : "an error names no place";
    const ColorTable& table = file->table;
    if (table.shaper.size() != std::size_t{3} * table.shaper_size ||
        table.cube.size() != std::size_t{3} * table.size * table.size * table.size)
        return "a table has not the entries that its sizes say";
    const Result<std::string> text = write_cube(*file);
    // A shaper and a cube whose ranges differ from channel to channel cannot be written.
    if (!text) return table.shaper_size > 0 && table.size > 0 ? wrong_error(text.error()) : text.error().text;
    const Result<TableFile> again = parse_cube(*text, "b.cube");
    if (!again) return fmt::format("what is written is refused: {}\n{}", again.error().text, *text);
    if (!is_same(again->table, table)) return "what is written has other bits:\n" + *text;
    return again->title == file->title && again->comments == file->comments
               ? std::string()
               : "what is written has another title or other comments:\n" + *text;
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("data/*.cube");
    out.emplace_back("# made\nTITLE \"a b\"\nLUT_1D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 2 3\n0 0 0\n1 1 1e-3\n");
    out.emplace_back(
        "LUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE 0 1\nLUT_3D_SIZE 2\nLUT_3D_INPUT_RANGE -1 2\n0 0 0\n1 1 1\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n");
    return out;
}

const Registration cube({.name = "cube", .run = run, .seeds = seeds, .max_mebibytes = 4});

}  // namespace
}  // namespace darkroom::fuzz::cube_fuzz
