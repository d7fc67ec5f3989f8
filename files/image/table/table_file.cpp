// SPDX-License-Identifier: MIT
#include "image/table/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <random>
#include <sstream>
#include <tuple>

#include "core/files.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "image/codec/load_module.hpp"
#include "image/picture/picture_numbers.hpp"
#include "image/table/color_chain.hpp"
#include "tables/evaluate.hpp"
#include "tables/table_image.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> chain_names{".3dl", ".spi1d", ".spi3d", ".csp", ".clf",
                                                      ".ctf", ".lut",   ".itx",   ".cub"};
/// Bytes of a file that OpenColorIO reads: it makes more than ten times as many of them.
constexpr std::uintmax_t max_chain_file = std::uintmax_t{32} << 20;

std::string extension_of(const fs::path& path) { return lower(path.extension().string()); }

double worst_error(const ColorTable& table, const ColorChain& chain) {
    constexpr std::size_t count = 20000;
    const bool is_shaped = table.shaper_size > 0;
    const auto& min = is_shaped ? table.shaper_min : table.min;
    const auto& max = is_shaped ? table.shaper_max : table.max;
    std::mt19937 random(1);
    std::vector<std::array<float, 3>> colors(count);
    for (auto& color : colors)
        for (std::size_t i = 0; i < 3; ++i)
            color[i] = min[i] + (max[i] - min[i]) * (static_cast<float>(random() >> 8U) / 16777215.0f);
    std::vector<std::array<float, 3>> expected = colors;
    chain.apply(expected);
    double worst = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const TableColor found = evaluate(table, {colors[n][0], colors[n][1], colors[n][2]});
        for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(found[i] - double{expected[n][i]}));
    }
    return worst;
}

/// Do its operations go on where the table has no inputs any more, and holds those at its ends? Grey, and so each
/// channel, twice, sixteen times and as far off as halves go.
bool goes_on(const ColorTable& table, const ColorChain& chain) {
    const bool is_shaped = table.shaper_size > 0;
    const auto& min = is_shaped ? table.shaper_min : table.min;
    const auto& max = is_shaped ? table.shaper_max : table.max;
    std::vector<std::array<float, 3>> ends{min, max};
    chain.apply(ends);
    for (const float factor : {1.0f, 15.0f, 65504.0f})
        for (const bool is_above : {false, true}) {
            std::vector<std::array<float, 3>> color{is_above ? max : min};
            for (std::size_t i = 0; i < 3; ++i) color[0][i] += (max[i] - min[i]) * (is_above ? factor : -factor);
            chain.apply(color);
            for (std::size_t i = 0; i < 3; ++i)
                if (std::abs(color[0][i] - ends[is_above ? 1 : 0][i]) > 1e-4f) return true;
        }
    return false;
}

/// Lines with something in them that is no comment, as their words in lower case.
std::vector<std::vector<std::string>> words_of(std::span<const std::byte> file) {
    std::istringstream text(std::string(reinterpret_cast<const char*>(file.data()), file.size()));
    std::vector<std::vector<std::string>> out;
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(lower(line));
        std::vector<std::string> found{std::istream_iterator<std::string>(words), {}};
        if (!found.empty() && !found.front().starts_with('#')) out.push_back(std::move(found));
    }
    return out;
}

/// Autodesk's Lustre says the bits of its numbers in a line "Mesh 5 12"; others say nothing, and OpenColorIO takes the
/// fewest of 8, 10, 12, 14 and 16 that the largest number can be of.
void settle_bits(std::span<const std::byte> file, std::optional<int> bits, FoundTable& out) {
    std::vector<float>& entries = out.file.table.cube;
    double largest = 0;
    bool is_said = bits.has_value();
    for (const std::vector<std::string>& words : words_of(file)) {
        int number = 0;
        const auto read = [&](const std::string& word) {
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
            return error == std::errc() && end == word.data() + word.size();
        };
        if (words.size() != 3) continue;
        if (words[0] == "mesh" && read(words[2]) && number >= 8 && number <= 16 && !bits) {
            bits = number;
            is_said = true;
        } else if (std::ranges::all_of(words, read)) {
            for (const std::string& word : words)
                if (read(word)) largest = std::max(largest, static_cast<double>(number));
        }
    }
    const double greatest = entries.empty() ? 0 : *std::ranges::max_element(entries);
    if (!(largest > 0) || !(greatest > 0)) return;
    const auto guessed = static_cast<int>(std::lround(std::log2(largest / greatest + 1)));
    const auto most = [](int of) { return std::exp2(of) - 1; };
    const auto scale = static_cast<float>(most(guessed) / most(bits.value_or(guessed)));
    for (float& entry : entries) entry *= scale;
    const int taken = bits.value_or(guessed);
    out.file.comments.push_back(fmt::format("Its numbers are taken as of {} bits, of which the largest is {} of {}",
                                            taken, largest, most(taken)));
    // A table that reaches nine tenths of white is of the bits that it seems to be of.
    if (!is_said && largest < 0.9 * most(guessed))
        out.warnings.push_back(
            fmt::format("its largest number is {}: it is taken as of {} bits, and may be of more; "
                        "`darkroom lut convert --bits` says so",
                        largest, guessed));
}

/// Has the prelut of a .csp file a curve of more than two points?
bool has_curved_prelut(std::span<const std::byte> file) {
    const auto lines = words_of(file);
    auto line = lines.begin() + std::min<std::ptrdiff_t>(2, std::ssize(lines));
    if (line != lines.end() && line->front() == "begin") {
        while (line != lines.end() && line->front() != "end") ++line;
        if (line != lines.end()) ++line;
    }
    // Of each channel the number of points, their inputs, and their outputs.
    for (int channel = 0; channel < 3 && lines.end() - line > 2; ++channel, line += 3)
        if (line->front() != "0" && line->front() != "2") return true;
    return false;
}

Result<FoundTable> read_chain(const fs::path& path, const std::string& extension, std::optional<int> bits) {
    const std::string shown = printable(path.string());
    const auto refuse = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", shown, error.text)});
    };
    // What OpenColorIO makes of them it bounds itself: 129 a side of a cube, 2^20 entries of a 1D table.
    DARKROOM_TRY_VALUE(const std::vector<std::byte> file, read_file(path, {.max_size = max_chain_file}));
    const Result<const ColorChains*> chains = color_chains();
    if (!chains) return refuse(chains.error());
    const Result<std::unique_ptr<ColorChain>> chain = (*chains)->open(path);
    if (!chain) return refuse(chain.error());
    Result<ColorTable> table = (*chain)->sampled();
    if (!table) return refuse(table.error());
    for (const std::vector<float>* const entries : {&table->shaper, &table->cube})
        if (!std::ranges::all_of(*entries, [](float v) { return std::isfinite(v); }))
            return refuse({Fault::User, "its operations make colours that are not finite"});
    FoundTable out{.file = {.table = std::move(*table)}, .format = extension};
    out.error = worst_error(out.file.table, **chain);
    // Half a code of 8 bits.
    if (constexpr double seen = 0.5 / 255; *out.error > seen)
        out.warnings.push_back(fmt::format("its operations are sampled, and up to {:.3g} off", *out.error));
    if (goes_on(out.file.table, **chain)) {
        out.file.comments.emplace_back("Inputs beyond those of the table are held at its ends; its operations go on");
        const ColorTable& of = out.file.table;
        const auto& [least, most] =
            of.shaper_size > 0 ? std::tie(of.shaper_min, of.shaper_max) : std::tie(of.min, of.max);
        out.warnings.push_back(
            fmt::format("its operations go on below {:g} and above {:g}, where it is held at its ends",
                        *std::ranges::max_element(least), *std::ranges::min_element(most)));
    }
    if (extension == ".3dl") settle_bits(file, bits, out);
    if (extension == ".csp" && has_curved_prelut(file))
        out.file.comments.emplace_back(
            "Its prelut is a smooth curve through its points, as OpenColorIO takes it; some programs draw straight "
            "lines");
    return out;
}

Result<FoundTable> read_picture_table(const fs::path& path) {
    const auto check = [](const FilePart& part) -> Result<> {
        if (part.channels.size() < 3)
            return user_error(fmt::format("{} channels: red, green and blue are needed", part.channels.size()));
        const Result<std::uint32_t> edge = table_image_edge(part.width, part.height);
        return edge ? Result<>() : failure(edge.error());
    };
    std::string left_out;
    DARKROOM_TRY_VALUE(const ResourceImage image, read_numbers(path, check, &left_out));
    Result<ImageTable> found = table_of_image(image);
    if (!found)
        return failure(Error{found.error().fault, fmt::format("{}: {}", printable(path.string()), found.error().text)});
    FoundTable out{.file = {.table = std::move(found->table), .comments = {"A picture: " + found->layout}},
                   .format = "a picture"};
    if (!left_out.empty()) out.warnings.push_back(std::move(left_out));
    return out;
}

}  // namespace

Result<const ColorChains*> color_chains() {
    static const Result<const void*> loaded = load_module("libdarkroom_ocio.so", "darkroom_ocio_chains", "OpenColorIO");
    if (!loaded) return failure(loaded.error());
    return static_cast<const ColorChains*>(*loaded);
}

std::vector<std::string> table_extensions() {
    std::vector<std::string> out{".cube"};
    out.insert(out.end(), chain_names.begin(), chain_names.end());
    return out;
}

bool is_table_name(const fs::path& path) { return std::ranges::count(table_extensions(), extension_of(path)) > 0; }

Result<FoundTable> read_table_file(const fs::path& path, std::optional<int> bits) {
    const std::string extension = extension_of(path);
    if (bits && extension != ".3dl")
        return user_error(fmt::format("{}: bits are said of the numbers of .3dl alone", printable(path.string())));
    if (extension == ".cube") {
        DARKROOM_TRY_VALUE(TableFile file, read_cube(path));
        return FoundTable{.file = std::move(file), .format = extension};
    }
    if (is_table_name(path)) return read_chain(path, extension, bits);
    return read_picture_table(path);
}

}  // namespace darkroom
