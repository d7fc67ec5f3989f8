// SPDX-License-Identifier: MIT
#include "view_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/darkroom/run/outputs.hpp"
#include "apps/darkroom/run/report.hpp"
#include "apps/darkroom/run/ui_source.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/sequence.hpp"
#include "scene/read/scene_file.hpp"
#include "scene/scene.hpp"
#include "toml/toml_text.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;
using darkroom::window::Presentation;

namespace {

constexpr VkExtent2D play_extent{1280, 720}, edit_extent{1600, 900};
constexpr double usual_frames_per_second = 60;

bool is_scene(const std::string& input) { return input.ends_with(".toml") || darkroom::scene::is_model_path(input); }

/// Is it a look, and no scene that may have one? What cannot be read is said by who reads it.
bool is_look(const std::string& input) {
    if (!input.ends_with(".toml")) return false;
    const Result<std::string> text = darkroom::scene::reading::read_scene_text(input);
    if (!text) return false;
    const Result<toml::table> file = darkroom::parse_toml(*text, input);
    return file && darkroom::scene::reading::has_look(*file) && !darkroom::scene::reading::is_scene(*file);
}

/// The frame that ships: beside the sources that the program was built from, or installed with it. Empty: neither.
std::filesystem::path shipped_sample() {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path())
        for (const char* const name : {"samples/window.exr", "share/darkroom/samples/window.exr"})
            if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
    return {};
}

}  // namespace

void ViewFlags::add_to(CommandFlags command, bool is_edit, std::span<const darkroom::LookEntry> named) {
    is_edit_ = is_edit;
    command.add_option(
        "INPUT", inputs_,
        "A scene (.toml), a model (.glb, .gltf), a frame or picture, or a sequence: shot.####.exr; a look "
        "(.toml) is shown on a frame that ships, or on what stands beside it");
    const std::string group = "The window";
    command.add_flag("--fullscreen", is_fullscreen_, "Fills the screen").group(group);
    command
        .add_option(
            "--present", presentation_,
            "vsync waits for the display, mailbox shows the newest frame at a refresh, immediate waits for nothing")
        .type_name("vsync|mailbox|immediate")
        .capture_default()
        .group(group);
    command
        .add_option("--range", range_, "high shows light beyond white where the display can; --frames takes standard")
        .type_name("standard|high")
        .capture_default()
        .group(group);
    peak_.add_to(command, "Peak luminance of a display of high range")
        .type_name("CD/M2")
        .default_str("1000")
        .group(group);
    frames_.add_to(command, "Shows so many frames, 1 / fps seconds apart, and ends").type_name("N").group(group);
    frames_per_second_.add_to(command, "Frames a second, for --frames and for a sequence")
        .type_name("N")
        .default_str(fmt::format("{}", usual_frames_per_second))
        .group(group);
    time_.add_to(command, "The scene's time at the first frame, default: what the scene says, or 0")
        .type_name("S")
        .group(group);
    command.add_flag("--paused", is_paused_, "The time stands still until P is pressed").group(group);
    command
        .add_flag(
            "--full-size", is_full_size_,
            "Draws every pixel also while something moves; else a half or a quarter each way where frames take long")
        .group(group);
    command.add_option("--screenshot", screenshot_, "Stores the last frame's picture, and ends (--frames 1)")
        .type_name("OUT")
        .group(group);
    command
        .add_option("--window-screenshot", window_screenshot_,
                    "Stores the window's last picture, with all that lies over it")
        .type_name("OUT")
        .group(group);
    command
        .add_flag("--commands", obeys_input_,
                  "Obeys the console's commands from standard input, a line each, and prints what they answer")
        .group(group);
    command.add_flag("--help-keys", asks_for_keys_, "Prints what keys and mouse do").group(group);
    if (is_edit) command.add_flag("--auto-orbit", turns_, "The camera goes round by itself").group(group);
    const std::string frame_group = "A stored frame";
    command
        .add_option("--map", maps_,
                    "Name of a layer in the file: depth=NAME, normals=PREFIX, velocity=PREFIX, color=PREFIX")
        .repeated()
        .type_name("LAYER=NAME")
        .group(frame_group);
    command.add_option("--camera", camera_, "A camera file (TOML)").type_name("FILE").group(frame_group);
    drawn_.add_to(command, is_edit ? edit_extent : play_extent, usual_msaa, group);
    device_.add_to(command);
    look_.add_to(command, true, named);
}

Result<ViewerJob> ViewFlags::job() const {
    ViewerJob job{.is_edit = is_edit_};
    const Result<Named> named = this->named();
    if (!named) return failure(named.error());
    if (Result<> done = read_subject(job, named->inputs); !done) return failure(std::move(done));
    if (Result<> done = read_look(job, named->look); !done) return failure(std::move(done));
    if (Result<> done = read_window(job); !done) return failure(std::move(done));
    return job;
}

Result<ViewFlags::Named> ViewFlags::named() const {
    Named out{.look = look_.file};
    for (const std::string& input : inputs_) {
        if (!is_look(input)) {
            out.inputs.push_back(input);
            continue;
        }
        if (!out.look.empty())
            return user_error(fmt::format("{}: one look at a time, and {} is one, too", printable(input),
                                          printable(out.look.string())));
        out.look = input;
    }
    if (!out.inputs.empty()) return out;
    if (inputs_.empty()) return user_error("a scene, a model or a frame is needed");
    const std::filesystem::path sample = shipped_sample();
    if (sample.empty())
        return user_error(
            fmt::format("{}: it is a look, and the frame that ships to try one on is not there: a scene, a "
                        "model or a frame is needed beside it",
                        printable(out.look.string())));
    out.inputs.push_back(sample.string());
    return out;
}

Result<> ViewFlags::read_subject(ViewerJob& job, const std::vector<std::string>& inputs) const {
    const bool has_scene = std::ranges::any_of(inputs, is_scene);
    if (has_scene && inputs.size() > 1)
        return user_error(fmt::format("{}: one scene or model at a time", printable(inputs[1])));
    const Result<darkroom::render::RenderDesc> desc = drawn_.desc();
    if (!desc) return failure(desc.error());
    const Result<std::uint64_t> seed = drawn_.seed();
    if (!seed) return failure(seed.error());
    const Result<darkroom::scene::OrbitOverride> orbit = drawn_.orbit();
    if (!orbit) return failure(orbit.error());
    job.scene_desc = {
        .render = *desc, .seed = *seed, .is_strict = look_.is_strict(), .named_files = drawn_.named_files()};
    job.orbit = *orbit;
    if (Result<> done = time_.read_to(job.time); !done) return done;
    if (Result<> done = frames_per_second_.read_to(job.frame_desc.frames_per_second); !done) return done;
    job.step = 1 / job.frame_desc.frames_per_second.value_or(usual_frames_per_second);
    drawn_.warn_of_what_is_ignored();
    if (has_scene) {
        job.scene = inputs.front();
        return {};
    }
    Result<std::vector<darkroom::NumberedFile>> files = darkroom::expand_inputs(inputs);
    if (!files) return failure(std::move(files));
    job.frames = std::move(*files);
    for (const std::string& map : maps_)
        if (Result<> added = darkroom::add_mapping(job.frame_desc.options.names, map); !added) return added;
    job.frame_desc.options.camera_file = camera_;
    job.frame_desc.options.keeps_halves = true;
    return {};
}

Result<> ViewFlags::read_look(ViewerJob& job, std::filesystem::path path) const {
    // Models hold no look.
    if (path.empty() && !job.scene.empty() && !darkroom::scene::is_model_path(job.scene)) path = job.scene;
    std::vector<std::string> warnings;
    job.look_options = look_.options(nullptr);
    darkroom::LookOptions options = job.look_options;
    options.warnings = &warnings;
    if (path.empty()) {
        job.document.emplace(darkroom::default_look(), job.look_options);
    } else {
        Result<darkroom::edit::LookDocument> opened = darkroom::edit::LookDocument::open(path, options);
        // The window tells those of a look that it shows.
        if (!opened)
            for (const std::string& warning : warnings) warn(warning);
        if (!opened) return failure(std::move(opened));
        job.document.emplace(std::move(*opened));
    }
    job.is_off = look_.is_off();
    if (look_.change_anything()) {
        const Result<> done = job.document->edit("the command line", [&](darkroom::Look& look) -> Result<> {
            if (Result<> changed = look_.change(look, true); !changed) return changed;
            if (!look_.ui_file().empty()) look.ui->document = std::filesystem::absolute(look_.ui_file()).string();
            return {};
        });
        if (!done) return done;
    }
    if (look_.events.empty()) return {};
    darkroom::Look look = job.document->look();
    Result<Timeline> timeline = Timeline::read(look_.events, look);
    if (!timeline) return failure(std::move(timeline));
    job.timeline = std::move(*timeline);
    return {};
}

Result<> ViewFlags::read_window(ViewerJob& job) const {
    constexpr std::array modes{std::pair("vsync", Presentation::Vsync), std::pair("mailbox", Presentation::Mailbox),
                               std::pair("immediate", Presentation::Immediate)};
    const auto mode = std::ranges::find(modes, presentation_, [](const auto& of) { return std::string(of.first); });
    if (mode == modes.end())
        return user_error(
            fmt::format("--present {}: allowed is vsync, mailbox or immediate", printable(presentation_)));
    job.presentation = mode->second;
    if (range_ != "standard" && range_ != "high")
        return user_error(fmt::format("--range {}: allowed is standard or high", printable(range_)));
    // The same command gives the same picture on every display.
    if (range_ == "high" && !frames_.is_given() && screenshot_.empty() && window_screenshot_.empty())
        job.range = darkroom::window::DynamicRange::High;
    if (Result<> done = peak_.read_to(job.peak_nits); !done) return done;
    const Result<darkroom::KernelStage> stage = device_.stage();
    if (!stage) return failure(stage.error());
    job.kernels = *stage;
    job.fuse = device_.is_fused();
    job.device = device_.name();
    job.turns = turns_;
    job.is_paused = is_paused_;
    job.is_full_size = is_full_size_;
    job.obeys_input = obeys_input_;
    const std::string subject = (job.scene.empty() ? job.frames.front().path : job.scene).filename().string();
    job.window = {.title = fmt::format("{} - Darkroom", printable(subject)),
                  .size = job.scene_desc.render.extent,
                  .is_fullscreen = is_fullscreen_};
    if (Result<> done = frames_.read_to(job.frames_to_show); !done) return done;
    job.screenshot = screenshot_;
    job.window_screenshot = window_screenshot_;
    if (!screenshot_.empty() || !window_screenshot_.empty()) job.frames_to_show = job.frames_to_show.value_or(1);
    std::vector<std::filesystem::path> inputs;
    for (const darkroom::NumberedFile& frame : job.frames) inputs.push_back(frame.path);
    if (!job.scene.empty()) inputs.push_back(job.scene);
    std::ranges::copy(look_.input_files(), std::back_inserter(inputs));
    darkroom::Look look = job.document->look();
    resolve_ui(look, job.document->file().parent_path());
    std::ranges::copy(ui_files(look), std::back_inserter(inputs));
    const FileSet files(inputs);
    for (const std::filesystem::path& out : {job.screenshot, job.window_screenshot})
        if (!out.empty())
            if (Result<> done = check_output(out, files); !done) return done;
    return {};
}

}  // namespace app
