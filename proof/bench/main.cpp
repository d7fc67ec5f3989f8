// SPDX-License-Identifier: MIT
// darkroom_bench: what the library costs on this device, in milliseconds and in multiples of a calibration pass that is
// measured in the same rounds, beside the targets. A missed target is printed, not an error: machines differ.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "bench/program/baked.hpp"
#include "bench/program/edits.hpp"
#include "bench/program/headers.hpp"
#include "bench/program/sequence.hpp"
#include "bench/program/start.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "rows.hpp"

namespace darkroom::bench {

namespace {

// The results as a table for people, as JSON and as CSV. It holds no dates: two runs on one machine differ in figures
// only.

struct Report {
    DeviceInfo device;
    std::vector<std::string> command_line;
    VkExtent2D extent{};
    std::uint32_t rounds = 0;
    double Sample::*cost = &Sample::cpu_ms;  ///< what the column c and the ratios compare
    std::vector<Row> rows;                   ///< the calibration pass first
    std::vector<Figure> figures;
    std::vector<PassRow> passes;
    std::vector<Row> sequence;  ///< milliseconds of a frame
    std::uint32_t sequence_frames = 0;
};

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

constexpr int exit_user = 1, exit_machine = 2;

struct Options {
    std::string size = "1920x1080";
    std::uint32_t rounds = 7, frames = 30, edits = 1000;
    std::vector<std::string> filters;
    std::string device;
    std::filesystem::path json, csv;
    bool lists = false, has_passes = false;
};

int fail(const Error& error) {
    fmt::print(stderr, "darkroom_bench: {}\n", error.text);
    return error.fault == Fault::User ? exit_user : exit_machine;
}

Result<VkExtent2D> parse_size(const std::string& text) {
    constexpr double largest = 16384;
    const std::size_t cross = text.find('x');
    const auto width = parse_number(text.substr(0, cross));
    const auto height = parse_number(cross == std::string::npos ? std::string() : text.substr(cross + 1));
    const auto is_size = [](double side) { return side >= 1 && side <= largest && side == std::floor(side); };
    if (!is_size(width.value_or(0)) || !is_size(height.value_or(0)))
        return user_error(fmt::format("--size {}: allowed is WIDTHxHEIGHT, each 1 to {}", text, largest));
    return VkExtent2D{static_cast<std::uint32_t>(width.value_or(0)), static_cast<std::uint32_t>(height.value_or(0))};
}

/// Appends what `more` holds.
Result<> append(std::vector<Figure>& figures, Result<std::vector<Figure>> more) {
    if (!more) return failure(std::move(more));
    figures.insert(figures.end(), more->begin(), more->end());
    return {};
}

/// Does a filter ask for one of these names? Without filters all are.
bool is_asked_for(const Options& options, const std::vector<std::string>& names) {
    return options.filters.empty() || std::ranges::any_of(options.filters, [&](const std::string& filter) {
               return std::ranges::any_of(names,
                                          [&](const auto& name) { return name.find(filter) != std::string::npos; });
           });
}

/// Whole or not at all: its rows are made together.
Result<> add_sequence(const Options& options, Device& device, VkExtent2D extent, Report& report) {
    constexpr std::uint32_t max_rounds = 3;
    if (options.frames == 0 || !is_asked_for(options, sequence_row_names())) return {};
    DARKROOM_TRY_VALUE(auto sequence, measure_sequence(device, {.extent = extent,
                                                                .frames = options.frames,
                                                                .rounds = std::min(options.rounds, max_rounds),
                                                                .device = options.device}));
    report.sequence = std::move(sequence.rows);
    report.sequence_frames = sequence.frames;
    report.figures.insert(report.figures.end(), sequence.figures.begin(), sequence.figures.end());
    return {};
}

Result<> measure_all(const Options& options, Bed& bed, Report& report) {
    DARKROOM_TRY_VALUE(auto rows, make_rows(bed, options.filters));
    DARKROOM_TRY(measure(bed, rows, options.rounds));
    report.figures = ratio_figures(bed.device, rows);
    DARKROOM_TRY(append(report.figures, picture_figures(bed, rows)));
    report.rows = std::move(rows);
    if (options.has_passes) {
        DARKROOM_TRY_VALUE(report.passes, measure_passes(bed, options.rounds));
    }
    DARKROOM_TRY(add_sequence(options, bed.device, bed.extent, report));
    if (options.edits > 0 && is_asked_for(options, {std::string(edits_name)}))
        DARKROOM_TRY(append(report.figures, edit_figures(bed.device, options.edits)));
    if (is_asked_for(options, {"baked"})) DARKROOM_TRY(append(report.figures, baked_figures(options.rounds)));
    if (is_asked_for(options, {"headers"})) DARKROOM_TRY(append(report.figures, header_figures(options.rounds)));
    if (!options.filters.empty()) return {};
    DARKROOM_TRY(append(report.figures, counted_figures(bed)));
    return append(report.figures, start_figures(options.device, bed.extent, options.rounds));
}

Result<> save(const std::filesystem::path& path, const std::string& content) {
    if (path.empty()) return {};
    return write_file(path, std::as_bytes(std::span(content)));
}

int run(const Options& options, std::vector<std::string> command_line) {
    if (options.lists) {
        for (const auto& names : {row_names(), sequence_row_names()})
            for (const std::string& name : names) fmt::print("{}\n", name);
        return 0;
    }
    const auto extent = parse_size(options.size);
    if (!extent) return fail(extent.error());
    auto device = Device::create({.select = options.device, .log = [](Severity, std::string_view message) {
                                      fmt::print(stderr, "{}\n", message);
                                  }});
    if (!device) return fail(device.error());
    auto bed = Bed::create(*device, *extent);
    if (!bed) return fail(bed.error());
    Report report{.device = device->info(),
                  .command_line = std::move(command_line),
                  .extent = *extent,
                  .rounds = options.rounds,
                  .cost = cost_of(*device)};
    if (const auto ok = measure_all(options, **bed, report); !ok) return fail(ok.error());
    fmt::print("{}", text(report));
    if (const auto ok = save(options.json, json(report)); !ok) return fail(ok.error());
    if (const auto ok = save(options.csv, csv(report)); !ok) return fail(ok.error());
    const std::uint64_t messages = device->validation_messages();
    if (messages > 0) return fail({Fault::Machine, fmt::format("{} messages of the validation layer", messages)});
    return 0;
}

/// Results are kept and shown: the folders of the program and of its files are no part of them.
std::vector<std::string> without_folders(std::vector<std::string> command_line, const Options& options) {
    for (const std::filesystem::path& path : {std::filesystem::path(command_line[0]), options.json, options.csv})
        for (std::string& argument : command_line)
            if (!path.empty() && argument.ends_with(path.string()))
                argument.replace(argument.size() - path.string().size(), std::string::npos, path.filename().string());
    return command_line;
}

int parse_and_run(int argc, char** argv) {
    Options options;
    CLI::App program("Measures what Darkroom costs on this device.", "darkroom_bench");
    program.add_option("--size", options.size, "WIDTHxHEIGHT of the picture.")->capture_default_str();
    program.add_option("--rounds", options.rounds, "Runs of every row.")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    program.add_option("--frames", options.frames, "Frames of the sequence; 0: none.")
        ->check(CLI::Range(0, 10000))
        ->capture_default_str();
    program.add_option("--edits", options.edits, "Edits of a look while frames go on; 0: none.")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    program.add_option("--filter", options.filters, "Only rows whose name holds this text, or one of these.");
    program.add_option("--device", options.device, "Name, part of a name, or index of the device.");
    program.add_option("--json", options.json, "Writes the results to this file.");
    program.add_option("--csv", options.csv, "Writes the rows to this file.");
    program.add_flag("--list", options.lists, "Lists the rows.");
    program.add_flag("--passes", options.has_passes, "GPU time of every pass, too.");
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? program.exit(error) : fail({Fault::User, error.what()});
    }
    return run(options, without_folders({argv, argv + argc}, options));
}

}  // namespace

}  // namespace darkroom::bench

int main(int argc, char** argv) {
    // Exceptions come from third parties and from the allocator alone.
    try {
        return darkroom::bench::parse_and_run(argc, argv);
    } catch (const std::exception& error) {
        return darkroom::bench::fail({darkroom::Fault::Machine, error.what()});
    }
}
