// SPDX-License-Identifier: MIT
#include "plan_statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

namespace {

using darkroom::Chip;
using darkroom::DeviceInfo;
using darkroom::KernelCost;
using darkroom::KernelStatistics;
using darkroom::PlanPass;
using darkroom::Result;

double pixels_of(VkExtent2D extent) { return static_cast<double>(extent.width) * extent.height; }

/// A pass, and what follows from its machine code and the chip, as far as there are such.
struct Row {
    const PlanPass& pass;
    const KernelStatistics& kernel;
    std::optional<KernelCost> cost;
    double waves = 0;
    double milliseconds = 0;
};

const GivenLoops* loops_of(const StatisticsReport& report, std::string_view kernel) {
    const auto found = std::ranges::find(report.loops, kernel, &GivenLoops::kernel);
    return found == report.loops.end() ? nullptr : &*found;
}

std::vector<Row> rows_of(const StatisticsReport& report) {
    const std::string_view family = darkroom::amd_family(report.device.name);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < report.plan.passes.size(); ++i) {
        const PlanPass& pass = report.plan.passes[i];
        Row row{.pass = pass, .kernel = report.kernels[i]};
        if (!family.empty()) {
            const darkroom::Architecture architecture = darkroom::architecture_of(family);
            const GivenLoops* const loops = loops_of(report, pass.name);
            row.cost = darkroom::kernel_cost(row.kernel, architecture,
                                             loops == nullptr ? std::span<const double>() : loops->trips);
            row.waves = darkroom::occupancy(row.kernel, architecture);
        }
        const auto bytes = static_cast<double>(pass.bytes_read + pass.bytes_written);
        if (row.cost && report.chip != nullptr)
            row.milliseconds =
                darkroom::milliseconds(*row.cost, static_cast<double>(pass.invocations), bytes, *report.chip);
        rows.push_back(std::move(row));
    }
    return rows;
}

Result<> check_loops(const StatisticsReport& report, std::span<const Row> rows) {
    for (const GivenLoops& loops : report.loops) {
        const auto row = std::ranges::find(rows, loops.kernel, [](const Row& one) { return one.pass.name; });
        if (row == rows.end())
            return darkroom::user_error(
                fmt::format("--loops {}: the plan has no kernel of this name", darkroom::printable(loops.kernel)));
        const std::size_t count = row->cost ? row->cost->loops.size() : 0;
        if (loops.trips.size() > count)
            return darkroom::user_error(
                fmt::format("--loops {}: {} numbers are given, and its machine code has {} loops", loops.kernel,
                            loops.trips.size(), count));
    }
    return {};
}

struct Sum {
    double milliseconds = 0;
    double cycles = 0;  ///< for 64 pixels of the frame: passes of fewer threads count less
};

Sum sum_of(std::span<const Row> rows, VkExtent2D frame) {
    Sum sum;
    for (const Row& row : rows) {
        sum.milliseconds += row.milliseconds;
        if (row.cost) sum.cycles += row.cost->cycles() * static_cast<double>(row.pass.invocations) / pixels_of(frame);
    }
    return sum;
}

std::string header_of(const StatisticsReport& report) {
    std::string out = fmt::format("{} | {}\n", report.device.name, report.device.driver);
    if (const Chip* const chip = report.chip)
        out +=
            fmt::format("ms: on {}, {} SIMDs, {} GHz, {} GB/s, at {} x {}\n", chip->name, chip->simds, chip->gigahertz,
                        chip->gigabytes_per_second, report.plan.extent.width, report.plan.extent.height);
    return out;
}

/// "32 8?": a guess has a question mark.
std::string trips_of(const KernelCost& cost) {
    std::string out;
    for (const KernelCost::Loop& loop : cost.loops)
        out += fmt::format("{}{}{}", out.empty() ? "" : " ", loop.trips, loop.is_known ? "" : "?");
    return out;
}

std::string line_of(std::size_t number, const Row& row, std::size_t name_width, bool has_chip) {
    const KernelCost& cost = *row.cost;
    std::string out = fmt::format(
        "{:3}  {:{}} {:8} {:4.0f} {:4.0f} {:5.0f} {:5g} {:6.0f} {:6.0f} {:6.0f} {:7.0f} {:6.0f} {:6.0f} {:7}", number,
        row.pass.name, name_width, row.pass.stage, row.kernel.value("VGPRs"), row.kernel.value("SGPRs"),
        row.kernel.value("Spilled VGPRs") + row.kernel.value("Spilled SGPRs"), row.waves,
        row.kernel.value("Instructions"), row.kernel.value("Code size"), cost.alu, cost.texture, cost.lds,
        cost.cycles(), cost.bound());
    if (has_chip) out += fmt::format(" {:7.4f}", row.milliseconds);
    const std::string trips = trips_of(cost);
    return out + (trips.empty() ? "\n" : fmt::format("  loops {}\n", trips));
}

std::string table_of(std::span<const Row> rows, VkExtent2D frame, bool has_chip) {
    std::size_t width = 6;
    for (const Row& row : rows) width = std::max(width, row.pass.name.size());
    std::string out =
        fmt::format("{:3}  {:{}} {:8} {:>4} {:>4} {:>5} {:>5} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:7}{}\n", "",
                    "kernel", width, "stage", "VGPR", "SGPR", "spill", "waves", "instr", "bytes", "ALU", "texture",
                    "LDS", "cycles", "bound", has_chip ? "      ms" : "");
    for (std::size_t i = 0; i < rows.size(); ++i) out += line_of(i + 1, rows[i], width, has_chip);
    const Sum sum = sum_of(rows, frame);
    out += fmt::format("a frame: {:.0f} cycles for 64 of its pixels", sum.cycles);
    if (has_chip) out += fmt::format(", {:.3f} ms", sum.milliseconds);
    out += '\n';
    return out;
}

/// Of a driver whose machine code is not understood: what it says itself.
std::string driver_lines(std::span<const Row> rows) {
    std::string out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        out += fmt::format("{:3}  {} ({}):", i + 1, rows[i].pass.name, rows[i].pass.stage);
        for (const KernelStatistics::Value& one : rows[i].kernel.values)
            out += fmt::format(" {} {};", one.name, one.value);
        out.back() = '\n';
    }
    return out;
}

Json json_of(const Row& row, bool has_chip) {
    Json values = Json::object();
    for (const KernelStatistics::Value& one : row.kernel.values) values[one.name] = one.value;
    Json out{{"name", row.pass.name},
             {"stage", row.pass.stage},
             {"width", row.pass.extent.width},
             {"height", row.pass.extent.height},
             {"workgroup", row.kernel.workgroup},
             {"subgroup", row.kernel.subgroup},
             {"bytes_read", row.pass.bytes_read},
             {"bytes_written", row.pass.bytes_written},
             {"driver", std::move(values)}};
    if (!row.cost) return out;
    Json loops = Json::array();
    for (const KernelCost::Loop& loop : row.cost->loops)
        loops.push_back({{"trips", loop.trips}, {"is_known", loop.is_known}});
    out["waves"] = row.waves;
    out["alu"] = row.cost->alu;
    out["texture"] = row.cost->texture;
    out["lds"] = row.cost->lds;
    out["cycles"] = row.cost->cycles();
    out["bound"] = row.cost->bound();
    out["loops"] = std::move(loops);
    if (has_chip) out["milliseconds"] = row.milliseconds;
    return out;
}

}  // namespace

Result<const Chip*> chip_named(const std::string& name, const DeviceInfo& device) {
    const std::string_view family = darkroom::amd_family(device.name);
    const auto chips = darkroom::chips();
    const auto found = std::ranges::find_if(chips, [&](const Chip& chip) {
        return name.empty() ? chip.family == family : darkroom::lower(chip.name) == darkroom::lower(name);
    });
    if (found == chips.end()) {
        if (name.empty()) return nullptr;
        std::vector<std::string_view> names;
        for (const Chip& chip : chips) names.push_back(chip.name);
        return darkroom::user_error(
            fmt::format("--chip {}: allowed is {}", darkroom::printable(name), fmt::join(names, ", ")));
    }
    if (found->family == family) return &*found;
    return darkroom::user_error(fmt::format("--chip {}: it is a {}, and \"{}\" does not compile for it", found->name,
                                            found->family, device.name));
}

Result<GivenLoops> parse_loops(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    GivenLoops out{.kernel = text.substr(0, equals), .trips = {}};
    std::string_view rest =
        equals == std::string::npos ? std::string_view() : std::string_view(text).substr(equals + 1);
    bool is_good = !out.kernel.empty() && !rest.empty();
    while (is_good && !rest.empty()) {
        double trips = 0;
        const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), trips);
        rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
        is_good = error == std::errc() && trips >= 0 && trips <= 1e6 && (rest.empty() || rest.starts_with(','));
        if (is_good && !rest.empty()) rest.remove_prefix(1);
        out.trips.push_back(trips);
    }
    if (is_good && !text.ends_with(',')) return out;
    return darkroom::user_error(fmt::format("--loops {}: expected KERNEL=N or KERNEL=N,N..., each from 0 to 1000000",
                                            darkroom::printable(text)));
}

Result<std::string> text_of(const StatisticsReport& report) {
    const std::vector<Row> rows = rows_of(report);
    DARKROOM_TRY(check_loops(report, rows));
    const bool is_understood = std::ranges::all_of(rows, [](const Row& row) { return row.cost.has_value(); });
    std::string out = header_of(report);
    out += is_understood ? table_of(rows, report.plan.extent, report.chip != nullptr) : driver_lines(rows);
    for (const std::string& text : report.plan.left_out) out += fmt::format("left out: {}\n", text);
    return out;
}

Result<std::string> json_of(const StatisticsReport& report) {
    const std::vector<Row> rows = rows_of(report);
    DARKROOM_TRY(check_loops(report, rows));
    Json out{{"device", report.device.name},
             {"driver", report.device.driver},
             {"width", report.plan.extent.width},
             {"height", report.plan.extent.height}};
    if (const Chip* const chip = report.chip)
        out["chip"] = {{"name", chip->name},
                       {"simds", chip->simds},
                       {"gigahertz", chip->gigahertz},
                       {"gigabytes_per_second", chip->gigabytes_per_second}};
    out["kernels"] = Json::array();
    for (const Row& row : rows) out["kernels"].push_back(json_of(row, report.chip != nullptr));
    const Sum sum = sum_of(rows, report.plan.extent);
    out["cycles"] = sum.cycles;
    if (report.chip != nullptr) out["milliseconds"] = sum.milliseconds;
    out["left_out"] = report.plan.left_out;
    return out.dump(2) + "\n";
}

}  // namespace app
