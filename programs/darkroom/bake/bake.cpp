// SPDX-License-Identifier: MIT
// darkroom bake: the kernels of looks as a file, for programs that compile none.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <darkroom/kernel_file.hpp>
#include <filesystem>
#include <memory>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "gpu/resource/formats.hpp"
#include "plan/frame_inputs.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

using darkroom::plan::frame_inputs;

struct Options {
    LookFlags look;
    SpaceFlags space;
    std::vector<std::string> looks, sizes;
    std::string color = "R16G16B16A16_SFLOAT", target = "R8G8B8A8_UNORM";
    std::array<std::string, frame_inputs.size()> inputs;  ///< empty: frames lack it
    std::string out, profile;
    bool is_depth_planar = false, is_velocity_plain = false, has_shadows = false, keeps_what_is_off = false;
    bool makes_folder = false;
};

Result<darkroom::DeviceProfile> profile_of(const std::string& text) {
    if (text == "gpu") return darkroom::DeviceProfile::Gpu;
    if (text == "software") return darkroom::DeviceProfile::Software;
    return user_error(fmt::format("--profile {}: allowed is gpu or software", printable(text)));
}

std::string flag_of(std::string_view image) { return fmt::format("--{}-format", image); }

/// "D32_SFLOAT", or with ":storage" of what shaders may load or store by texels.
Result<darkroom::ImageUse> use_of(std::string_view image, const std::string& text, VkImageUsageFlags usage) {
    constexpr std::string_view storage = ":storage";
    const bool is_storage = text.ends_with(storage);
    const std::string name = is_storage ? text.substr(0, text.size() - storage.size()) : text;
    const VkFormat format = darkroom::gpu::format_named(name);
    if (format == VK_FORMAT_UNDEFINED)
        return user_error(
            fmt::format("{} {}: not a format of images; allowed is the name of a VkFormat without VK_FORMAT_, "
                        "as R16G16B16A16_SFLOAT or R8G8B8A8_UNORM:storage",
                        flag_of(image), printable(text)));
    return darkroom::ImageUse{format, is_storage ? usage | VK_IMAGE_USAGE_STORAGE_BIT : usage};
}

/// What --output-space says of a target of this format.
Result<> set_target_color(const SpaceFlags& flags, darkroom::CompileDesc& desc) {
    DARKROOM_TRY_VALUE(const std::optional<darkroom::OutputSpace> space, flags.space());
    if (!space) return {};
    const std::string_view format = darkroom::gpu::format_name(desc.target.format);
    desc.target_color = format.ends_with("SFLOAT") ? space->floats : space->integers;
    if (desc.target_color) return {};
    return user_error(fmt::format("--output-space {}: a target of {} cannot hold it", space->name, format));
}

Result<darkroom::CompileDesc> desc_of(const Options& options) {
    darkroom::CompileDesc desc{.is_depth_planar = options.is_depth_planar,
                               .is_velocity_plain = options.is_velocity_plain,
                               .has_shadows = options.has_shadows};
    const auto set = [](darkroom::ImageUse& use, std::string_view image, const std::string& text,
                        VkImageUsageFlags usage) -> Result<> {
        if (text.empty()) return {};
        DARKROOM_TRY_VALUE(use, use_of(image, text, usage));
        return {};
    };
    DARKROOM_TRY(set(desc.color, "color", options.color, VK_IMAGE_USAGE_SAMPLED_BIT));
    DARKROOM_TRY(set(desc.target, "target", options.target, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    for (const darkroom::plan::FrameInput& input : frame_inputs) {
        if (input.use == nullptr) continue;
        const std::string& text = options.inputs[static_cast<std::size_t>(input.image)];
        DARKROOM_TRY(set(desc.*input.use, input.name, text, VK_IMAGE_USAGE_SAMPLED_BIT));
    }
    DARKROOM_TRY(set_target_color(options.space, desc));
    return desc;
}

/// As a host reads it: what is off keeps its place until apply() decides.
Result<darkroom::Look> look_of(Options& options, const std::string& file) {
    options.look.file = file;
    std::vector<std::string> warnings;
    Result<darkroom::Look> look = darkroom::read_look(file, options.look.options(&warnings));
    for (const std::string& warning : warnings) warn(warning);
    if (!look) return look;
    DARKROOM_TRY(options.look.change(*look, true));
    return look;
}

/// The files that are named, and those of folders that are, in the order of their names.
Result<std::vector<std::string>> look_files(const std::vector<std::string>& named) {
    namespace fs = std::filesystem;
    constexpr std::size_t most = 4096;
    std::vector<std::string> out;
    for (const std::string& name : named) {
        std::error_code error;
        if (!fs::is_directory(name, error)) {
            out.push_back(name);
            continue;
        }
        const std::size_t before = out.size();
        for (fs::directory_iterator file(name, error), end; !error && file != end; file.increment(error)) {
            if (file->path().extension() != ".toml") continue;
            if (out.size() == most)
                return user_error(fmt::format("{}: allowed are at most {} looks", printable(name), most));
            out.push_back(file->path().string());
        }
        if (error) return darkroom::machine_error(fmt::format("{}: {}", printable(name), error.message()));
        if (out.size() == before) return user_error(fmt::format("{}: no .toml is in this folder", printable(name)));
        std::ranges::sort(out.begin() + static_cast<std::ptrdiff_t>(before), out.end());
    }
    return out;
}

Result<> bake(Options& options) {
    DARKROOM_TRY_VALUE(const darkroom::DeviceProfile profile, profile_of(options.profile));
    DARKROOM_TRY_VALUE(const std::vector<std::string> looks, look_files(options.looks));
    const MissingFolders folders = options.makes_folder ? MissingFolders::Made : MissingFolders::Told;
    std::vector<std::filesystem::path> inputs = options.look.input_files();
    inputs.insert(inputs.end(), looks.begin(), looks.end());
    DARKROOM_TRY(check_output(options.out, FileSet(inputs), folders));
    DARKROOM_TRY_VALUE(darkroom::CompileDesc desc, desc_of(options));
    darkroom::KernelFile file;
    for (const std::string& look_file : looks) {
        DARKROOM_TRY_VALUE(const darkroom::Look look, look_of(options, look_file));
        darkroom::Composer composer(darkroom::Device::assumed(profile));
        DARKROOM_TRY(darkroom::apply(look, composer, {.keeps_what_is_off = options.keeps_what_is_off}));
        for (const std::string& text : options.sizes) {
            DARKROOM_TRY_VALUE(desc.max_extent, parse_size(text));
            if (const Result<> added = file.add(composer, desc); !added)
                return darkroom::failure(
                    {added.error().fault, fmt::format("{}: {}", printable(look_file), added.error().text)});
        }
    }
    const std::vector<std::byte> bytes = file.bytes();
    DARKROOM_TRY(darkroom::write_file(options.out, bytes));
    answer_unless_quiet(fmt::format("{}: {} shaders, {} bytes", printable(options.out), file.size(), bytes.size()));
    return {};
}

int run(Options& options) {
    if (options.sizes.empty()) options.sizes = {"1920x1080"};
    const Result<> done = bake(options);
    return done ? exit_ok : fail(done.error());
}

}  // namespace

static Command add_bake(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command =
        program.add_command("bake", "Writes the kernels of looks to a file, for programs that compile none");
    command.examples(
        "darkroom bake my.toml -o kernels.dkb --profile gpu --depth-format D32_SFLOAT\n"
        "darkroom bake my.toml -o kernels.dkb --profile gpu --size 1920x1080 --size 2560x1440\n"
        "darkroom bake my.toml -o kernels.dkb --profile software --target-format B8G8R8A8_SRGB");
    const auto options = std::make_shared<Options>();
    command.add_option("LOOK", options->looks, "Look files or scenes (TOML), and folders of them")
        .names_look()
        .type_name("LOOK")
        .required();
    command.add_option("-o,--output,--out", options->out, "The file: .dkb").type_name("OUT").required();
    command.add_flag("--mkdir", options->makes_folder, "Makes the folder of the file where it is not there");
    command.add_option("--profile", options->profile, "The kind of device that will run them")
        .type_name("gpu|software")
        .required();
    command
        .add_option("--size", options->sizes, "Largest size of the picture, default 1920x1080; may stand several times")
        .type_name("WxH")
        .repeated()
        .one_value();
    const auto add_format = [&](std::string_view image, std::string& to, std::string_view doc) {
        command.add_option(flag_of(image), to, fmt::format("Format of {}", doc)).type_name("FORMAT[:storage]");
    };
    add_format("color", options->color, "the picture, default " + options->color);
    for (const darkroom::plan::FrameInput& input : frame_inputs)
        if (input.use != nullptr)
            add_format(input.name, options->inputs[static_cast<std::size_t>(input.image)], input.shown);
    add_format("target", options->target, "what is written, default " + options->target);
    options->space.add_to(command, "");
    command.add_flag("--planar-depth", options->is_depth_planar, "The depth is planar distance");
    command.add_flag("--plain-velocity", options->is_velocity_plain, "The motion vectors are of the default kind");
    command.add_flag("--shadows", options->has_shadows, "Frames have lights with cascades");
    command.add_flag("--keep-off", options->keeps_what_is_off,
                     "Effects of the flat table that are off have a place, too");
    options->look.add_to(command, false, named);
    return {command, [options] { return run(*options); }};
}

CommandRow bake_command() {
    return {.names = {"bake"}, .place = 210, .is_rare = true, .add = [](const CommandHost& host) {
                return std::vector{add_bake(host.program, host.named)};
            }};
}

}  // namespace app
