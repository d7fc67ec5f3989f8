// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <darkroom/device.hpp>
#include <darkroom/kernel_statistics.hpp>
#include <darkroom/plan.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"
#include "develop/cost/kernel_cost.hpp"
#include "develop/developer.hpp"
#include "looks/look_parts.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::Chip;
using darkroom::DeviceInfo;
using darkroom::KernelCost;
using darkroom::KernelStatistics;
using darkroom::PlanPass;
using darkroom::Result;

namespace {

// `plan --statistics`: what a driver's compiler made of a plan's kernels, and what that costs on a chip.

/// How often the loops of a kernel run, as a user says who knows better than its machine code.
struct GivenLoops {
    std::string kernel;
    std::vector<double> trips;
};

struct StatisticsReport {
    const darkroom::DeviceInfo& device;
    const darkroom::Plan& plan;
    std::span<const darkroom::KernelStatistics> kernels;  ///< one for each pass of the plan
    const darkroom::Chip* chip = nullptr;
    std::span<const GivenLoops> loops;
};

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

/// The chip of this name, or, for an empty one, the first of the device's family; null: none is listed. Errors: a name
/// that is not listed, or of another family than the device compiles for.
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

/// "volumetric.march=1,32,0"
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

/// Errors: loops of a kernel that the plan does not have, or of more than the kernel has.
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

struct Options {
    LookFlags look;
    DeviceFlags device;
    SpaceFlags space;
    std::string size, frame, chip;
    std::optional<std::string> bits;
    std::vector<std::string> loops;
    bool is_json = false, wants_statistics = false, wants_stack = false;
};

Result<std::string> statistics_of(const Options& options, const darkroom::Device& device,
                                  const darkroom::Composer& composer, const darkroom::Plan& plan,
                                  const darkroom::CompileDesc& compile) {
    DARKROOM_TRY_VALUE(const darkroom::Chip* const chip, chip_named(options.chip, device.info()));
    std::vector<GivenLoops> loops;
    for (const std::string& text : options.loops) {
        DARKROOM_TRY_VALUE(GivenLoops parsed, parse_loops(text));
        loops.push_back(std::move(parsed));
    }
    DARKROOM_TRY_VALUE(const auto kernels, composer.statistics(compile));
    const StatisticsReport report{
        .device = device.info(), .plan = plan, .kernels = kernels, .chip = chip, .loops = loops};
    return options.is_json ? json_of(report) : text_of(report);
}

/// What --bits and --output-space ask for.
Result<darkroom::WriteOptions> target_of(const Options& options) {
    DARKROOM_TRY_VALUE(std::optional<darkroom::OutputSpace> space, options.space.space());
    darkroom::WriteOptions out{.samples = darkroom::SampleKind::Integer8, .space = space};
    if (out.space && out.space->integers != darkroom::srgb_color)
        out.samples = out.space->integers ? darkroom::SampleKind::Integer16 : darkroom::SampleKind::Half;
    if (options.bits) {
        DARKROOM_TRY_VALUE(out.samples, parse_bits(*options.bits));
    }
    if (out.space && !darkroom::color_of(out, *out.samples))
        return darkroom::user_error(fmt::format("--output-space {}: {} samples cannot hold it", out.space->name,
                                                darkroom::name_of(*out.samples)));
    return out;
}

/// As the renderer of scenes hands its frames over (render/targets.hpp).
void add_layers_of_scenes(darkroom::CompileDesc& compile) {
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    compile.depth = {VK_FORMAT_R32_SFLOAT, usage};
    compile.is_depth_planar = true;
    compile.normals = {VK_FORMAT_R16G16B16A16_SFLOAT, usage};
    compile.velocity = {VK_FORMAT_R16G16_SFLOAT, usage};
    compile.is_velocity_plain = true;
    compile.has_shadows = true;
}

/// What a frame has nobody knows where none is named.
void name_no_frame(darkroom::Plan& plan) {
    constexpr std::string_view missing = ", which the frame does not have";
    for (std::string& text : plan.left_out)
        if (text.ends_with(missing))
            text.replace(text.size() - missing.size(), missing.size(), "; no frame is named, --input FRAME does");
}

Result<std::string> text_of(const Options& options) {
    DARKROOM_TRY_VALUE(darkroom::Look look, options.look.look_of_frames());
    if (options.wants_stack) {
        if (look.is_flat) darkroom::make_stack(look);
        return darkroom::write_look(look);
    }
    DARKROOM_TRY_VALUE(const darkroom::WriteOptions write, target_of(options));
    const darkroom::DevelopTarget target = target_for(*write.samples);
    if (write.space) suit(look, target, write);
    DARKROOM_TRY_VALUE(const darkroom::KernelStage stage, options.device.stage());
    darkroom::FrameFile frame;
    darkroom::DevelopInput input{.extent = {1920, 1080}};
    if (!options.frame.empty()) {
        DARKROOM_TRY_VALUE(frame, darkroom::read_frame(options.frame, {.has_shadow_depths = false}));
        input = develop_input(frame, {});
    }
    if (!options.size.empty()) {
        DARKROOM_TRY_VALUE(input.extent, parse_size(options.size));
    }
    DARKROOM_TRY_VALUE(darkroom::Device device,
                       options.wants_statistics ? options.device.create_compiler() : options.device.create_if_named());
    DARKROOM_TRY(darkroom::check_extent(device, input.extent));
    darkroom::Composer composer(device);
    DARKROOM_TRY(darkroom::apply(look, composer));
    const darkroom::DevelopDesc desc{.target = target,
                                     .color = darkroom::color_of(write, *write.samples),
                                     .kernels = stage,
                                     .fuse = options.device.is_fused()};
    darkroom::CompileDesc compile = darkroom::compile_desc_for(device, input, desc);
    if (options.frame.empty()) compile.color.format = VK_FORMAT_R16G16B16A16_SFLOAT;  // what engines hand over
    if (look.ui) compile.ui = {VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    compile.has_shadows =
        std::ranges::any_of(frame.lights, [](const darkroom::FrameLight& light) { return !light.cascades.empty(); });
    if (options.frame.empty() && is_scene_name(options.look.file)) add_layers_of_scenes(compile);
    DARKROOM_TRY_VALUE(darkroom::Plan plan, composer.plan(compile));
    if (options.frame.empty()) name_no_frame(plan);
    if (options.wants_statistics) return statistics_of(options, device, composer, plan, compile);
    return options.is_json ? plan.json() : plan.text();
}

int run(const Options& options) {
    const Result<std::string> text = text_of(options);
    if (!text) return fail(text.error());
    fmt::print("{}{}", *text, text->ends_with('\n') ? "" : "\n");
    return exit_ok;
}

}  // namespace

static Command add_plan(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command = program.add_command(
        "plan", "Shows what the planner makes of a look: kernels, what fused and why not, bytes, memory");
    command.examples(
        "darkroom plan my.toml --input frame.exr --size 3840x2160\n"
        "darkroom plan my.toml --as-stack\n"
        "darkroom plan --bloom-intensity 0.2 --json");
    const auto options = std::make_shared<Options>();
    command
        .add_option(
            "LOOK", options->look.file,
            "A look file or a scene (TOML), whose renderer gives all layers. Default: the flat table at its defaults")
        .names_look();
    command.add_flag("--json", options->is_json, "For programs");
    command.add_flag("--as-stack", options->wants_stack,
                     "Prints the look itself: a flat table as the [[stack]] that it stands for");
    command.add_option("--size", options->size, "Size of the picture, default 1920x1080 or that of --input")
        .type_name("WxH");
    command.add_option("--input", options->frame, "A frame: its layers (depth, normals, motion, shadows) are there")
        .type_name("FRAME");
    command.add_option("--bits", options->bits, "Samples of the target").type_name("8|16|half|float");
    options->space.add_to(command, "");
    const Flag statistics = command.add_flag(
        "--statistics", options->wants_statistics,
        "Prints what the device's compiler makes of each kernel: registers, waves, instructions, cycles");
    command.add_option("--chip", options->chip, "Graphics card whose milliseconds --statistics gives")
        .type_name("NAME")
        .needs(statistics);
    command.add_option("--loops", options->loops, "Number of rounds that a kernel's loops run, for --statistics")
        .type_name("KERNEL=N,...")
        .one_value()
        .needs(statistics);
    options->device.add_to(command);
    options->look.add_to(command, false, named);
    return {command, [options] { return run(*options); }};
}

CommandRow plan_command() {
    return {.names = {"plan"}, .place = 80, .add = [](const CommandHost& host) {
                return std::vector{add_plan(host.program, host.named)};
            }};
}

}  // namespace app
