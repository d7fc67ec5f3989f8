// SPDX-License-Identifier: MIT
#include "view_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"
#include "image/frame/sequence.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/shipped.hpp"
#include "programs/darkroom/run/ui_source.hpp"
#include "scene/read/scene_file.hpp"
#include "scene/scene.hpp"
#include "toml/toml_text.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;
using darkroom::window::Presentation;

namespace {

/// Is it a look, and no scene that may have one? What cannot be read is said by who reads it.
bool is_look(const std::string& input) {
    if (!input.ends_with(".toml")) return false;
    const Result<std::string> text = darkroom::scene::reading::read_scene_text(input);
    if (!text) return false;
    const Result<toml::table> file = darkroom::parse_toml(*text, input);
    return file && darkroom::scene::reading::has_look(*file) && !darkroom::scene::reading::is_scene(*file);
}

/// What is named: files to be shown, and the look that they are shown through.
struct Named {
    std::vector<std::string> inputs;
    std::filesystem::path look;
};

Result<Named> named_by(const ViewFlags& flags) {
    Named out{.look = flags.look.file};
    for (const std::string& input : flags.inputs) {
        if (!is_look(input)) {
            out.inputs.push_back(input);
            continue;
        }
        if (!out.look.empty())
            return user_error(fmt::format("{}: is a second look beside {}: one is allowed", printable(input),
                                          printable(out.look.string())));
        out.look = input;
    }
    if (!out.inputs.empty()) return out;
    if (flags.inputs.empty()) return user_error("a scene, a model or a frame is needed");
    const std::filesystem::path sample = shipped_file("samples/window.exr");
    if (sample.empty())
        return user_error(
            fmt::format("{}: is a look, and the sample frame is not there: a scene, a "
                        "model or a frame is needed beside it",
                        printable(out.look.string())));
    out.inputs.push_back(sample.string());
    return out;
}

Result<> read_subject(ViewerJob& job, const ViewFlags& flags, const std::vector<std::string>& inputs) {
    const bool has_scene = std::ranges::any_of(inputs, darkroom::scene::is_scene_path);
    if (has_scene && inputs.size() > 1)
        return user_error(fmt::format("{}: one scene or model at a time", printable(inputs[1])));
    DARKROOM_TRY_VALUE(const darkroom::render::RenderDesc desc, flags.drawn.desc());
    DARKROOM_TRY_VALUE(const std::uint64_t seed, flags.drawn.seed());
    DARKROOM_TRY_VALUE(const darkroom::scene::OrbitOverride orbit, flags.drawn.orbit());
    job.scene_desc = {
        .render = desc, .seed = seed, .is_strict = flags.look.is_strict(), .named_files = flags.drawn.named_files()};
    job.orbit = orbit;
    DARKROOM_TRY(flags.time.read_to(job.time));
    DARKROOM_TRY(flags.frames_per_second.read_to(job.frame_desc.frames_per_second));
    job.step = 1 / job.frame_desc.frames_per_second.value_or(usual_frames_per_second);
    if (has_scene) {
        job.scene = inputs.front();
        return {};
    }
    DARKROOM_TRY_VALUE(job.frames, darkroom::expand_inputs(inputs));
    const std::vector<std::string> eyes = flags.frame.eyes();
    if (eyes.size() > 1) return user_error("--eye both: allowed is one view at a time");
    DARKROOM_TRY_VALUE(job.frame_desc.options, flags.frame.options({}, eyes.front()));
    if (orbit.field_of_view) job.frame_desc.options.vertical_field_of_view = *orbit.field_of_view;
    job.frame_desc.options.keeps_halves = true;
    return {};
}

/// What the scene's camera says to a look of another file. What is wrong with the scene is said by who draws it.
darkroom::CameraLens lens_for(const ViewerJob& job, const std::filesystem::path& look) {
    if (job.scene.empty() || look == job.scene || darkroom::scene::is_model_path(job.scene)) return {};
    const Result<darkroom::scene::Scene> scene =
        darkroom::scene::read_scene(job.scene, {.named_files = job.scene_desc.named_files});
    return scene ? lens_of(scene->camera) : darkroom::CameraLens();
}

Result<> read_look(ViewerJob& job, const ViewFlags& flags, std::filesystem::path path) {
    // Models hold no look.
    if (path.empty() && !job.scene.empty() && !darkroom::scene::is_model_path(job.scene)) path = job.scene;
    std::vector<std::string> warnings;
    job.look_options = flags.look.options(nullptr);
    darkroom::LookOptions options = job.look_options;
    options.warnings = &warnings;
    if (path.empty()) {
        // As render and develop begin.
        job.document.emplace(job.scene.empty() ? darkroom::default_look_of_traced_light() : darkroom::default_look(),
                             job.look_options);
    } else {
        Result<darkroom::edit::LookDocument> opened =
            darkroom::edit::LookDocument::open(path, options, lens_for(job, path));
        // The window tells those of a look that it shows.
        if (!opened)
            for (const std::string& warning : warnings) warn(warning);
        if (!opened) return failure(std::move(opened));
        job.document.emplace(std::move(*opened));
    }
    job.is_off = flags.look.is_off();
    if (flags.look.change_anything()) {
        const Result<> done = job.document->edit("the command line", [&](darkroom::Look& look) -> Result<> {
            DARKROOM_TRY(flags.look.change(look, true));
            if (!flags.look.ui_file().empty())
                look.ui->document = std::filesystem::absolute(flags.look.ui_file()).string();
            return {};
        });
        if (!done) return done;
    }
    if (flags.look.events.empty()) return {};
    darkroom::Look look = job.document->look();
    DARKROOM_TRY_VALUE(job.timeline, Timeline::read(flags.look.events, look));
    return {};
}

Result<> read_frame_time(ViewerJob& job, const ViewFlags& flags) {
    std::optional<double> milliseconds;
    if (Result<> done = flags.frame_time.read_to(milliseconds); !done || !milliseconds) return done;
    if (job.scene.empty())
        return user_error("--frame-time: stored frames have the lines they have; a scene or a model is needed");
    if (flags.is_full_size) return user_error("--frame-time: --full-size draws every pixel, however long that takes");
    if (flags.frames.is_given() || !flags.screenshot.empty() || !flags.window_screenshot.empty())
        return user_error("--frame-time: frames that are counted are the same on every machine, and have every pixel");
    job.frame_time = *milliseconds / 1000;
    return {};
}

Result<> read_window(ViewerJob& job, const ViewFlags& flags) {
    constexpr std::array modes{std::pair("vsync", Presentation::Vsync), std::pair("mailbox", Presentation::Mailbox),
                               std::pair("immediate", Presentation::Immediate)};
    const auto mode =
        std::ranges::find(modes, flags.presentation, [](const auto& of) { return std::string(of.first); });
    if (mode == modes.end())
        return user_error(
            fmt::format("--present {}: allowed is vsync, mailbox or immediate", printable(flags.presentation)));
    job.presentation = mode->second;
    if (flags.range != "standard" && flags.range != "high")
        return user_error(fmt::format("--range {}: allowed is standard or high", printable(flags.range)));
    // The same command gives the same picture on every display.
    if (flags.range == "high" && !flags.frames.is_given() && flags.screenshot.empty() &&
        flags.window_screenshot.empty())
        job.range = darkroom::window::DynamicRange::High;
    DARKROOM_TRY(flags.peak.read_to(job.peak_nits));
    DARKROOM_TRY_VALUE(job.kernels, flags.device.stage());
    job.fuse = flags.device.is_fused();
    job.device = flags.device.name();
    job.turns = flags.turns;
    job.is_paused = flags.is_paused;
    job.is_full_size = flags.is_full_size;
    DARKROOM_TRY(read_frame_time(job, flags));
    job.obeys_input = flags.obeys_input;
    const std::string subject = (job.scene.empty() ? job.frames.front().path : job.scene).filename().string();
    job.window = {.title = fmt::format("{} - Darkroom", printable(subject)),
                  .size = job.scene_desc.render.extent,
                  .is_fullscreen = flags.is_fullscreen};
    DARKROOM_TRY(flags.frames.read_to(job.frames_to_show));
    job.screenshot = flags.screenshot;
    job.window_screenshot = flags.window_screenshot;
    if (!flags.screenshot.empty() || !flags.window_screenshot.empty())
        job.frames_to_show = job.frames_to_show.value_or(1);
    std::vector<std::filesystem::path> inputs;
    for (const darkroom::NumberedFile& frame : job.frames) inputs.push_back(frame.path);
    if (!job.scene.empty()) inputs.push_back(job.scene);
    std::ranges::copy(flags.look.input_files(), std::back_inserter(inputs));
    darkroom::Look look = job.document->look();
    resolve_ui(look, job.document->file().parent_path());
    std::ranges::copy(ui_files(look), std::back_inserter(inputs));
    const FileSet files(inputs);
    for (const std::filesystem::path& out : {job.screenshot, job.window_screenshot})
        if (!out.empty()) DARKROOM_TRY(check_output(out, files));
    return {};
}

}  // namespace

Result<ViewerJob> job_of(const ViewFlags& flags) {
    ViewerJob job{.is_edit = flags.is_edit};
    DARKROOM_TRY_VALUE(const Named named, named_by(flags));
    DARKROOM_TRY(read_subject(job, flags, named.inputs));
    DARKROOM_TRY(read_look(job, flags, named.look));
    DARKROOM_TRY(read_window(job, flags));
    return job;
}

}  // namespace app
