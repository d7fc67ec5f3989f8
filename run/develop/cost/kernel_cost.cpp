// SPDX-License-Identifier: MIT
#include "develop/cost/kernel_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "core/files.hpp"
#include "develop/cost/machine_code.hpp"

namespace darkroom {

namespace {

/// What ACO, RADV's compiler, takes for the rounds of a loop within `depth` others.
double guessed_trips(std::ptrdiff_t depth) { return depth == 0 ? 8 : depth == 1 ? 4 : 2; }

constexpr std::array<Chip, 4> known_chips{{
    {"RX Vega 64", "VEGA10", Architecture::Gcn, 256, 1.546, 484},
    {"RX 5700 XT", "NAVI10", Architecture::Rdna, 80, 1.905, 448},
    {"RX 6800 XT", "NAVI21", Architecture::Rdna, 144, 2.25, 512},
    {"RX 7900 XTX", "GFX1100", Architecture::Rdna, 192, 2.5, 960},
}};

bool begins_with_any(std::string_view name, std::span<const std::string_view> beginnings) {
    return std::ranges::any_of(beginnings, [&](std::string_view one) { return name.starts_with(one); });
}

constexpr std::array<std::string_view, 7> transcendental{"v_exp_",  "v_log_", "v_rcp_", "v_rsq_",
                                                         "v_sqrt_", "v_sin_", "v_cos_"};
// 32-bit products run at a quarter of the rate.
constexpr std::array<std::string_view, 6> slow_products{"v_mul_lo_u32", "v_mul_lo_i32",  "v_mul_hi_u32",
                                                        "v_mul_hi_i32", "v_mad_u64_u32", "v_mad_i64_i32"};
constexpr std::array<std::string_view, 2> wide_shifts{"v_lshlrev_b64", "v_lshrrev_b64"};
// They wait, or tell the front end something; no unit works.
constexpr std::array<std::string_view, 8> not_issued{"s_waitcnt",   "s_clause",    "s_inst_prefetch", "s_nop",
                                                     "s_delay_alu", "s_set_inst_", "s_endpgm",        "s_code_end"};

/// Cycles of each unit.
struct Units {
    double vector = 0, transcendental = 0, scalar = 0, texture = 0, lds = 0;
};

bool has(std::string_view name, std::string_view part) { return name.find(part) != std::string_view::npos; }

double lds_cycles(std::string_view name) {
    if (has(name, "b128") || has(name, "2_b64") || has(name, "2st64_b64")) return 16;
    if (has(name, "b64") || has(name, "b96") || has(name, "2_b32") || has(name, "2st64_b32")) return 8;
    return 4;
}

/// `rounds`: how often the instruction is run. In cycles of RDNA.
void count(std::string_view name, double rounds, Units& units) {
    if (begins_with_any(name, transcendental)) {
        units.vector += 2 * rounds;
        units.transcendental += 8 * rounds;
    } else if (name.starts_with("v_") && has(name, "_f64")) {
        units.vector += 32 * rounds;
    } else if (begins_with_any(name, slow_products)) {
        units.vector += 8 * rounds;
        units.transcendental += 8 * rounds;
    } else if (name.starts_with("v_")) {
        units.vector += (begins_with_any(name, wide_shifts) ? 4 : 2) * rounds;
    } else if (name.starts_with("image_sample") || name.starts_with("image_gather")) {
        units.texture += 32 * rounds;
    } else if (begins_with_any(name, std::array<std::string_view, 4>{"image_", "buffer_", "tbuffer_", "global_"})) {
        units.texture += 8 * rounds;
    } else if (name.starts_with("ds_")) {
        units.lds += lds_cycles(name) * rounds;
    } else if (name.starts_with("s_") && !begins_with_any(name, not_issued)) {
        units.scalar += rounds;
    }
}

}  // namespace

std::span<const Chip> chips() { return known_chips; }

std::string_view amd_family(std::string_view device_name) {
    constexpr std::string_view mark = "(RADV ";
    const std::size_t at = device_name.find(mark);
    if (at == std::string_view::npos) return {};
    const std::string_view rest = device_name.substr(at + mark.size());
    return rest.substr(0, rest.find(')'));
}

Architecture architecture_of(std::string_view family) {
    // GFX9 and what came before are GCN, and so are the accelerators that go on with it.
    constexpr std::array<std::string_view, 6> rdna{"NAVI", "GFX10", "GFX11", "VANGOGH", "REMBRANDT", "RAPHAEL"};
    return begins_with_any(family, rdna) ? Architecture::Rdna : Architecture::Gcn;
}

double KernelCost::cycles() const { return std::max({alu, texture, lds}); }

std::string_view KernelCost::bound() const {
    if (alu >= texture && alu >= lds) return "ALU";
    return texture >= lds ? "texture" : "LDS";
}

std::optional<KernelCost> kernel_cost(const KernelStatistics& statistics, Architecture architecture,
                                      std::span<const double> given_trips) {
    const MachineCode code(statistics.machine_code);
    const auto instructions = code.instructions();
    if (std::ranges::none_of(instructions, [](const auto& one) { return one.name == "s_endpgm"; })) return {};
    std::vector<double> rounds(instructions.size(), 1);
    KernelCost out;
    for (const MachineCode::Loop& loop : code.loops()) {
        const std::size_t place = out.loops.size();
        std::optional<double> trips;
        if (place < given_trips.size())
            trips = given_trips[place];
        else
            trips = code.trips(loop);
        const auto depth = std::ranges::count_if(code.loops().first(place),
                                                 [&](const MachineCode::Loop& outer) { return loop.end <= outer.end; });
        out.loops.push_back({trips.value_or(guessed_trips(depth)), trips.has_value()});
        for (std::size_t i = loop.begin; i <= loop.end; ++i) rounds[i] *= out.loops.back().trips;
    }
    Units units;
    for (std::size_t i = 0; i < instructions.size(); ++i) count(instructions[i].name, rounds[i], units);
    // 64 threads are two waves of 32, for which the vector units need half the time each, and the scalar one the same.
    if (statistics.subgroup == 32) units.scalar *= 2;
    // A SIMD of GCN has half the lanes, and shares the units of its compute unit with three others instead of one.
    const double scale = architecture == Architecture::Gcn ? 2 : 1;
    const double scalar_scale = architecture == Architecture::Gcn ? 4 : 1;
    out.alu = std::max({units.vector * scale, units.transcendental * scale, units.scalar * scalar_scale});
    out.texture = units.texture * scale;
    out.lds = units.lds * scale;
    return out;
}

double occupancy(const KernelStatistics& statistics, Architecture architecture) {
    // RADV counts waves of 64 on GCN, and of 32 on RDNA, whatever the kernel's are.
    return statistics.value("Subgroups per SIMD") / (architecture == Architecture::Gcn ? 1 : 2);
}

double milliseconds(const KernelCost& cost, double pixels, double bytes, const Chip& chip) {
    const double work = pixels / 64 * cost.cycles() / (chip.simds * chip.gigahertz * 1e9);
    const double traffic = bytes / (chip.gigabytes_per_second * 1e9);
    return 1e3 * std::max(work, traffic);
}

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
