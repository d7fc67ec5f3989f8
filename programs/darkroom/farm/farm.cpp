// SPDX-License-Identifier: MIT
#include "farm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/sequence.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/effects/named_effects.hpp"
#include "programs/darkroom/flags/program.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "scene/assets.hpp"

namespace app {

CommandRow render_command();
CommandRow develop_command();

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

/// "out/shot.0001.png" -> "out/shot.farm". Told by two frames: other digits of a name are no number of a frame.
fs::path farm_folder(const fs::path& first, const fs::path& other) {
    std::string name = first.stem().string();
    const std::string beside = other.stem().string();
    name.erase(std::ranges::mismatch(name, beside).in1, name.end());
    name.resize(name.find_last_not_of("0123456789") + 1);
    name.resize(name.find_last_not_of("._- ") + 1);
    return first.parent_path() / ((name.empty() ? "frames" : name) + farm_suffix);
}

}  // namespace

Result<> check_unknown_pictures(const FarmWork& work) {
    std::set<fs::path> found;
    for (const FarmFrame& frame : work.frames)
        if (is_there(frame.picture)) found.insert(frame.picture);
    // Of other chunks, too.
    const fs::path folder = work.folder.has_parent_path() ? work.folder.parent_path() : fs::path(".");
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path name = entry->path().filename();
        const std::optional<long long> number = darkroom::frame_number(name);
        if (!number) continue;
        for (const fs::path& picture : work.names.pictures(*number))
            if (picture.filename() == name && is_there(picture)) found.insert(picture);
    }
    if (found.empty()) return {};
    return user_error(
        fmt::format("{}: {} picture{} there, from {} on, and no record says of which look; remove {}, or write "
                    "elsewhere with -o",
                    printable(work.folder.string()), found.size(), found.size() == 1 ? " is" : "s are",
                    printable(found.begin()->filename().string()), found.size() == 1 ? "it" : "them"));
}

void FarmFlags::add_to(CommandFlags command, const std::string& frames_doc) {
    command.add_option("INPUT", input_, "A sequence (shot.%04d.exr or shot.####.exr), or a scene or a model")
        .required();
    command.add_option("MORE", more_, "Behind --: flags of develop for a sequence, of render for a scene");
    command
        .add_option("-o,--output,--out", out_,
                    "The pictures: a folder for those of a sequence, or a name with %04d, #### or {name}")
        .type_name("OUT")
        .required();
    command.add_option("--look", look_, "As for develop and render").type_name("FILE");
    command.add_option("--frames", frames_, frames_doc).type_name("A-B");
    command.add_flag("--mkdir", makes_folder_, "Makes the folder of the pictures where it is not there");
    command.add_flag("--allow-custom-effects", allows_custom_effects_,
                     "Lets the look name files of effects, which are code, and --effect bring some");
}

bool FarmFlags::is_scene() const { return darkroom::scene::is_scene_path(input_); }

std::vector<std::string> FarmFlags::command(const std::string& frames) const {
    std::vector<std::string> out{is_scene() ? "render" : "develop", input_, "-o", out_, "--frames", frames};
    if (!look_.empty()) out.insert(out.end(), {"--look", look_});
    if (!allows_custom_effects_) out.emplace_back(no_custom_effects);
    out.insert(out.end(), {"--skip-existing", "--keep-going"});
    out.insert(out.end(), more_.begin(), more_.end());
    return out;
}

std::vector<std::string> FarmFlags::task() const {
    std::vector<std::string> out{input_, "-o", out_};
    if (!look_.empty()) out.insert(out.end(), {"--look", look_});
    if (allows_custom_effects_) out.emplace_back("--allow-custom-effects");
    if (!more_.empty()) out.emplace_back("--");
    out.insert(out.end(), more_.begin(), more_.end());
    return out;
}

Result<> FarmFlags::check_arguments() const {
    if (!more_.empty() && !more_.front().starts_with('-'))
        return user_error(fmt::format("unexpected '{}': allowed is one INPUT, and flags of {} after --",
                                      printable(more_.front()), is_scene() ? "render" : "develop"));
    if (out_ == stream_name) return user_error("-o -: a farm writes files");
    // Its end is where `develop` reads which frames are meant.
    if (input_.ends_with(']'))
        return user_error(fmt::format("{}: a farm takes no [A-B]; --frames A-B chooses frames", printable(input_)));
    if (!is_scene() && !darkroom::has_number_pattern(input_))
        return user_error(
            fmt::format("{}: expected a sequence, shot.%04d.exr or shot.####.exr, or a scene (.toml) "
                        "or a model (.glb, .gltf)",
                        printable(input_)));
    if (is_scene() && frames_.empty()) return user_error(fmt::format("{}: --frames A-B is needed", printable(input_)));
    const bool is_pattern = darkroom::has_number_pattern(out_);
    if (is_scene() ? !is_pattern : !is_folder() && !is_pattern && out_.find("{name}") == std::string::npos)
        return user_error(fmt::format("-o {}: expected {}a name with %04d or ####", printable(out_),
                                      is_scene() ? "" : "a folder (--mkdir makes a new one), or "));
    return {};
}

Result<std::vector<FarmFrame>> FarmFlags::frames_in(const std::optional<darkroom::FrameSet>& frames) const {
    std::vector<FarmFrame> out;
    if (is_scene()) {
        for (const long long number : frames->numbers()) {
            if (number < 0)
                return user_error(fmt::format("--frames {}: a scene begins at frame 0", printable(frames_)));
            out.push_back({number, darkroom::numbered(out_, number)});
        }
        return out;
    }
    DARKROOM_TRY_VALUE(const std::vector<darkroom::NumberedFile> inputs,
                       darkroom::expand_inputs(std::span(&input_, 1)));
    for (const auto& [path, number] : inputs)
        if (!frames || frames->contains(number)) out.push_back({number, output_path(path, number, out_, is_folder())});
    if (out.empty())
        return user_error(
            fmt::format("--frames {}: none of the {} inputs has such a number", printable(frames_), inputs.size()));
    std::ranges::sort(out, {}, &FarmFrame::number);
    if (frames) warn_of_missing_inputs(frames_, *frames, inputs);
    return out;
}

Result<FarmWork> FarmFlags::work() const {
    DARKROOM_TRY(check_arguments());
    std::optional<darkroom::FrameSet> asked_for;
    if (!frames_.empty()) {
        DARKROOM_TRY_VALUE(asked_for, parse_frames(frames_));
    }
    DARKROOM_TRY_VALUE(std::vector<FarmFrame> frames, frames_in(asked_for));
    if (frames.size() > max_frames)
        return user_error(fmt::format("{}: {} frames, a farm takes at most {}; --frames A-B chooses some",
                                      printable(input_), frames.size(), max_frames));
    const fs::path picture = frames.front().picture, folder = picture.parent_path();
    DARKROOM_TRY(check_folder(folder, missing_folders()));
    FarmNames names{.input = input_, .output = out_, .is_folder = is_folder()};
    const fs::path records = farm_folder(names.pictures(0).front(), names.pictures(9).front());
    return FarmWork{.frames = std::move(frames),
                    .names = std::move(names),
                    .folder = records,
                    .is_range = !asked_for || asked_for->is_range()};
}

// The command itself reads the arguments: what it would refuse is refused here, once, instead of by every task.
// For two frames, because what is right for one may be wrong for several; of more, all names would be tried.
Result<FarmInputs> FarmFlags::check(const FarmWork& work, std::span<const darkroom::LookEntry> named) const {
    const Trial trial;
    const CommandRow row = is_scene() ? render_command() : develop_command();
    const Command command = row.add({.program = trial.program(), .named = named}).front();
    const long long first = work.frames.front().number, last = std::min(first + 1, work.frames.back().number);
    DARKROOM_TRY(trial.parse(this->command(fmt::format("{}-{}", first, last)), command.flags));
    if (const std::vector<std::string> inputs = command.flags.typed("INPUT"); inputs.size() > 1)
        return user_error(fmt::format("unexpected '{}': allowed after -- are flags of {}", printable(inputs.back()),
                                      command.flags.name()));
    if (!allows_custom_effects_)
        for (const std::string& argument : more_)
            if (argument == "--effect" || argument.starts_with("--effect="))
                return user_error(
                    fmt::format("{}: such a file is code, --allow-custom-effects lets it run", printable(argument)));
    const darkroom::ReadRecord read;
    DARKROOM_TRY(command.check());
    FarmInputs out;
    for (const fs::path& file : std::set(read.files())) {
        DARKROOM_TRY_VALUE(const auto content, darkroom::read_file(file));
        out.emplace(printable(file.string()), darkroom::content_hash(content).hex());
    }
    return out;
}

// darkroom farm: a sequence over many machines.

static std::vector<Command> add_farm(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags farm = program.add_command("farm", "Makes the pictures of a sequence on many machines");
    farm.require_command();
    farm.examples(
        "darkroom farm slurm 'shot.####.exr' --look my.toml -o . --chunk 1 --dry-run\n"
        "darkroom farm task 'shot.####.exr' --look my.toml -o . --frames 1-2\n"
        "darkroom farm status .");
    return {add_farm_slurm(farm, named), add_farm_task(farm, named), add_farm_status(farm)};
}

CommandRow farm_command() {
    return {.names = {"farm"}, .place = 110, .add = [](const CommandHost& host) {
                return add_farm(host.program, host.named);
            }};
}

}  // namespace app
