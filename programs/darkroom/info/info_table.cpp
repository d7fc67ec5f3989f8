// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "image/table/table_file.hpp"
#include "info_documents.hpp"

namespace app::info {

using darkroom::Result;

namespace {

/// One number where the channels agree.
Json channels_of(const std::array<float, 3>& values) {
    if (values[0] == values[1] && values[0] == values[2]) return values[0];
    return values;
}

Json part_of(std::uint32_t size, const std::array<float, 3>& min, const std::array<float, 3>& max,
             const std::vector<float>& entries) {
    const auto [least, greatest] = std::ranges::minmax(entries);
    return {{"entries", size},
            {"inputs_from", channels_of(min)},
            {"inputs_to", channels_of(max)},
            {"least", least},
            {"greatest", greatest}};
}

}  // namespace

Result<Json> table(const std::filesystem::path& path) {
    const bool is_named = darkroom::is_table_name(path);
    Result<darkroom::FoundTable> found = [&]() -> Result<darkroom::FoundTable> {
        if (is_named) return darkroom::read_table_file(path);
        DARKROOM_TRY_VALUE(auto file, darkroom::read_cube(path));
        return darkroom::FoundTable{.file = std::move(file), .format = ".cube"};
    }();
    if (!found) return failure(std::move(found));
    const darkroom::ColorTable& table = found->file.table;
    Json out{{"kind", "table"}, {"format", found->format}};
    if (!found->file.title.empty()) out["title"] = found->file.title;
    if (table.shaper_size > 0)
        out[table.size > 0 ? "shaper" : "table_1d"] =
            part_of(table.shaper_size, table.shaper_min, table.shaper_max, table.shaper);
    if (table.size > 0) out["table_3d"] = part_of(table.size, table.min, table.max, table.cube);
    if (found->error) out["largest_error"] = *found->error;
    if (!found->file.comments.empty()) out["comments"] = found->file.comments;
    return out;
}

}  // namespace app::info
