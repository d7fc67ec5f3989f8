// SPDX-License-Identifier: MIT
#include "develop/cost/kernel_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "core/files.hpp"

namespace darkroom {

namespace {

constexpr std::string_view driver_mark = "driver: ";
constexpr double dearer = 1.1;

using Column = double KernelRow::*;
struct NamedColumn {
    std::string_view name;
    Column column;
};
constexpr std::array<NamedColumn, 7> columns{{{"VGPRs", &KernelRow::vgprs},
                                              {"waves", &KernelRow::waves},
                                              {"instr", &KernelRow::instructions},
                                              {"ALU", &KernelRow::alu},
                                              {"texture", &KernelRow::texture},
                                              {"LDS", &KernelRow::lds},
                                              {"spilled", &KernelRow::spilled}}};

/// "   16    10 ... bloom: bloom.prefilter, compute, lean": the numbers, then the name.
bool read_row(std::string_view line, KernelTable& table) {
    KernelRow row;
    for (const NamedColumn& column : columns) {
        line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
        const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), row.*column.column);
        if (error != std::errc()) return false;
        line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
    }
    if (!line.starts_with("  ")) return false;
    return table.rows.emplace(line.substr(2), row).second;
}

}  // namespace

double KernelRow::cycles() const { return std::max({alu, texture, lds}); }

std::string KernelTable::text() const {
    std::string out = fmt::format("{}{}\n", driver_mark, driver);
    for (const NamedColumn& column : columns) out += fmt::format("{:>8}", column.name);
    out += "  kernel\n";
    for (const auto& [name, row] : rows) {
        for (const NamedColumn& column : columns) out += fmt::format("{:8g}", row.*column.column);
        out += fmt::format("  {}\n", name);
    }
    return out;
}

Result<KernelTable> KernelTable::read(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(const auto bytes, read_file(path));
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    KernelTable out;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        if (number == 1 && line.starts_with(driver_mark)) {
            out.driver = line.substr(driver_mark.size());
        } else if (number != 2 && !read_row(line, out)) {
            return user_error(fmt::format("{}:{}: not a line of a kernel table", path.string(), number));
        }
    }
    return out;
}

std::vector<std::string> findings(const KernelTable& before, const KernelTable& now) {
    std::vector<std::string> out;
    for (const auto& [name, row] : now.rows) {
        if (row.spilled > 0) out.push_back(fmt::format("{}: it spills registers", name));
        if (before.driver != now.driver) continue;
        const auto old = before.rows.find(name);
        if (old == before.rows.end())
            out.push_back(fmt::format("{}: not in the table", name));
        else if (row.cycles() > dearer * old->second.cycles())
            out.push_back(fmt::format("{}: {:g} cycles, {:g} before", name, row.cycles(), old->second.cycles()));
    }
    return out;
}

}  // namespace darkroom
