// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "develop/developer.hpp"
#include "looks/look_parts.hpp"
#include "plan_statistics.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::Result;

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
