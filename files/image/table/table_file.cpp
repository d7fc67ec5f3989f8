// SPDX-License-Identifier: MIT
#include "image/table/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <random>

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

Result<FoundTable> read_chain(const fs::path& path, const std::string& extension) {
    const std::string shown = printable(path.string());
    const auto refuse = [&](const Error& error) {
        return failure(Error{error.fault, fmt::format("{}: {}", shown, error.text)});
    };
    // What OpenColorIO makes of them it bounds itself: 129 a side of a cube, 2^20 entries of a 1D table.
    DARKROOM_TRY(read_file(path, {.max_size = max_chain_file}));
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
    if (goes_on(out.file.table, **chain))
        out.file.comments.emplace_back("Inputs beyond those of the table are held at its ends; its operations go on");
    return out;
}

Result<FoundTable> read_picture_table(const fs::path& path) {
    const auto check = [](const FilePart& part) -> Result<> {
        if (part.channels.size() < 3)
            return user_error(fmt::format("{} channels: red, green and blue are needed", part.channels.size()));
        const Result<std::uint32_t> edge = table_image_edge(part.width, part.height);
        return edge ? Result<>() : failure(edge.error());
    };
    DARKROOM_TRY_VALUE(const ResourceImage image, read_numbers(path, check));
    Result<ImageTable> found = table_of_image(image);
    if (!found)
        return failure(Error{found.error().fault, fmt::format("{}: {}", printable(path.string()), found.error().text)});
    return FoundTable{.file = {.table = std::move(found->table), .comments = {"A picture: " + found->layout}},
                      .format = "a picture"};
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

Result<FoundTable> read_table_file(const fs::path& path) {
    const std::string extension = extension_of(path);
    if (extension == ".cube") {
        DARKROOM_TRY_VALUE(TableFile file, read_cube(path));
        return FoundTable{.file = std::move(file), .format = extension};
    }
    if (is_table_name(path)) return read_chain(path, extension);
    return read_picture_table(path);
}

}  // namespace darkroom
