// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace darkroom::bench {

namespace {

struct Clock {
    std::string_view name;
    double Sample::*member;
};
constexpr std::array clocks{Clock{"cpu_ms", &Sample::cpu_ms}, Clock{"wall_ms", &Sample::wall_ms},
                            Clock{"gpu_ms", &Sample::gpu_ms}};

double in_c(const Report& report, const Row& row) { return ratio(row, report.rows.front(), report.cost); }

/// What moving the row's bytes alone costs, in c.
std::optional<double> floor_of(const Report& report, const Row& row) {
    const auto floor = std::ranges::find(report.rows, floor_name, &Row::name);
    if (row.moved_bytes == 0 || floor == report.rows.end()) return std::nullopt;
    return in_c(report, *floor) * row.moved_bytes / floor->moved_bytes;
}

std::string_view unit_of(const Report& report) {
    return report.cost == &Sample::cpu_ms ? "process CPU time" : "GPU time";
}

std::string json_text(std::string_view text) {
    std::string out = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') {
            out += '\\';
            out += letter;
        } else if (static_cast<unsigned char>(letter) < 0x20) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
        } else {
            out += letter;
        }
    }
    return out + '"';
}

void write_clocks(std::back_insert_iterator<std::string> to, const Row& row) {
    for (const Clock& clock : clocks) {
        const std::vector<double> values = column(row, clock.member);
        fmt::format_to(to, ", \"{0}\": {1:.4f}, \"{0}_min\": {2:.4f}", clock.name, median(values), minimum(values));
    }
}

}  // namespace

std::string text(const Report& report) {
    std::string out =
        fmt::format("{} ({}), {}x{}, {} rounds; c and ratios compare {}\n\n", report.device.name, report.device.driver,
                    report.extent.width, report.extent.height, report.rounds, unit_of(report));
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "{:<42} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}\n", "", "CPU ms", "min", "wall ms",
                   "min", "GPU ms", "min", "c", "floor c");
    for (const Row& row : report.rows) {
        fmt::format_to(to, "{:<42}", row.name);
        for (const Clock& clock : clocks) {
            const std::vector<double> values = column(row, clock.member);
            fmt::format_to(to, " {:>9.3f} {:>9.3f}", median(values), minimum(values));
        }
        fmt::format_to(to, " {:>7.2f}", in_c(report, row));
        if (const auto floor = floor_of(report, row)) fmt::format_to(to, " {:>7.2f}", *floor);
        out += '\n';
    }
    if (!report.passes.empty()) fmt::format_to(to, "\n{:<48} {:>9}\n", "pass", "GPU ms");
    for (const PassRow& pass : report.passes)
        fmt::format_to(to, "{:<48} {:>9.3f}\n", fmt::format("{}: {}", pass.stack, pass.pass), pass.milliseconds);
    if (!report.sequence.empty())
        fmt::format_to(to, "\n{:<42} {:>9} {:>9} {:>9} {:>9}\n",
                       fmt::format("sequence of {}, one frame", report.sequence_frames), "CPU ms", "wall ms", "GPU ms",
                       "frames/s");
    for (const Row& row : report.sequence) {
        fmt::format_to(to, "{:<42}", row.name);
        for (const Clock& clock : clocks) fmt::format_to(to, " {:>9.1f}", median(column(row, clock.member)));
        fmt::format_to(to, " {:>9.2f}\n", 1e3 / median(column(row, &Sample::wall_ms)));
    }
    if (!report.figures.empty()) out += '\n';
    for (const Figure& figure : report.figures) {
        fmt::format_to(to, "{:<48} {:>9.3f} {:<5}", figure.name, figure.value, figure.unit);
        const std::string_view verdict = figure.holds() ? "holds" : "MISSED";
        if (figure.at_most) fmt::format_to(to, " at most {:<6g} {}", *figure.at_most, verdict);
        if (figure.at_least) fmt::format_to(to, " at least {:<5g} {}", *figure.at_least, verdict);
        out += '\n';
    }
    return out;
}

std::string json(const Report& report) {
    std::string out;
    const auto to = std::back_inserter(out);
    fmt::format_to(
        to, "{{\n  \"device\": {},\n  \"driver\": {},\n  \"api_version\": \"{}.{}.{}\",\n  \"is_software\": {},\n",
        json_text(report.device.name), json_text(report.device.driver), VK_API_VERSION_MAJOR(report.device.api_version),
        VK_API_VERSION_MINOR(report.device.api_version), VK_API_VERSION_PATCH(report.device.api_version),
        report.device.is_software);
    out += "  \"command_line\": [";
    for (std::size_t i = 0; i < report.command_line.size(); ++i)
        out += (i == 0 ? "" : ", ") + json_text(report.command_line[i]);
    fmt::format_to(to, "],\n  \"size\": [{}, {}],\n  \"rounds\": {},\n  \"c_compares\": {},\n  \"rows\": [",
                   report.extent.width, report.extent.height, report.rounds, json_text(unit_of(report)));
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const Row& row = report.rows[i];
        fmt::format_to(to, "{}\n    {{\"name\": {}", i == 0 ? "" : ",", json_text(row.name));
        write_clocks(to, row);
        fmt::format_to(to, ", \"c\": {:.4f}", in_c(report, row));
        if (const auto floor = floor_of(report, row)) fmt::format_to(to, ", \"floor_c\": {:.4f}", *floor);
        out += '}';
    }
    out += "\n  ],\n  \"passes\": [";
    for (std::size_t i = 0; i < report.passes.size(); ++i)
        fmt::format_to(to, "{}\n    {{\"stack\": {}, \"pass\": {}, \"gpu_ms\": {:.4f}}}", i == 0 ? "" : ",",
                       json_text(report.passes[i].stack), json_text(report.passes[i].pass),
                       report.passes[i].milliseconds);
    fmt::format_to(to, "\n  ],\n  \"sequence_frames\": {},\n  \"sequence\": [", report.sequence_frames);
    for (std::size_t i = 0; i < report.sequence.size(); ++i) {
        fmt::format_to(to, "{}\n    {{\"name\": {}", i == 0 ? "" : ",", json_text(report.sequence[i].name));
        write_clocks(to, report.sequence[i]);
        out += '}';
    }
    out += "\n  ],\n  \"figures\": [";
    for (std::size_t i = 0; i < report.figures.size(); ++i) {
        const Figure& figure = report.figures[i];
        fmt::format_to(to, "{}\n    {{\"name\": {}, \"value\": {:.4f}, \"unit\": {}", i == 0 ? "" : ",",
                       json_text(figure.name), figure.value, json_text(figure.unit));
        if (figure.at_most) fmt::format_to(to, ", \"at_most\": {}", *figure.at_most);
        if (figure.at_least) fmt::format_to(to, ", \"at_least\": {}", *figure.at_least);
        if (figure.at_most || figure.at_least) fmt::format_to(to, ", \"holds\": {}", figure.holds());
        out += '}';
    }
    out += "\n  ]\n}\n";
    return out;
}

std::string csv(const Report& report) {
    std::string out = "name";
    for (const Clock& clock : clocks) out += fmt::format(",{0},{0}_min", clock.name);
    out += ",c\n";
    for (const Row& row : report.rows) {
        out += json_text(row.name);
        for (const Clock& clock : clocks) {
            const std::vector<double> values = column(row, clock.member);
            out += fmt::format(",{:.4f},{:.4f}", median(values), minimum(values));
        }
        out += fmt::format(",{:.4f}\n", in_c(report, row));
    }
    return out;
}

}  // namespace darkroom::bench
