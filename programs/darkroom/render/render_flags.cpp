// SPDX-License-Identifier: MIT
#include "render_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "formats/exr/exr.hpp"
#include "image/frame/sequence.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

constexpr VkExtent2D default_extent{1920, 1080};
constexpr const char* moment_group = "The time";
constexpr std::uint32_t usual_samples = 3, usual_samples_of_lens = 256;

}  // namespace

void RenderFlags::add_to(CommandFlags command, std::span<const darkroom::LookEntry> named) {
    command.add_option("SCENE", scene, "A scene (.toml) or a model (.glb, .gltf)").required();
    command
        .add_option("-o,--output,--out", out_,
                    fmt::format("The picture: {}; for several frames a name with %04d; - is standard output, "
                                "with --format",
                                darkroom::written_extensions()))
        .type_name("OUT")
        .capture_default();
    command
        .add_option("--save-frame,--frame", frame_,
                    "The raw frame, too: linear light, depth, normals, motion and camera (.exr)")
        .type_name("OUT.exr");
    add_moments(command);
    drawn.add_to(command, default_extent, 1, moment_group);
    samples_.add_to(command, "Number of places within a pixel whose light is averaged, on top of --msaa")
        .type_name("N")
        .default_str(
            fmt::format("what the scene says, or {}; with --aperture {}", usual_samples, usual_samples_of_lens))
        .group(SceneFlags::drawing_group);
    aperture_
        .add_to(command,
                "Draws through a lens of this f-stop: each of --samples sees the scene from another place of its "
                "aperture")
        .type_name("N")
        .group(SceneFlags::drawing_group);
    focus_.add_to(command, "Distance along the view axis that such a lens is focused at")
        .type_name("METRES")
        .default_str("that of the scene's camera, else of its target")
        .group(SceneFlags::drawing_group);
    sensor_height_
        .add_to(command, "Height of the sensor behind the lens; with the field of view it gives the focal length")
        .type_name("MM")
        .default_str(fmt::format("that of the scene's camera, else {}", darkroom::render::LensDesc().sensor_height))
        .group(SceneFlags::drawing_group);
    render_scale_
        .add_to(command,
                "Lines that are drawn for each line of the picture; upscalers make the others, else a bilinear filter")
        .type_name("N")
        .default_str("1")
        .group(SceneFlags::drawing_group);
    write.add_to(command);
    run.add_to(command);
    device.add_to(command);
    look.add_to(command, true, named);
}

void RenderFlags::add_moments(CommandFlags command) {
    const std::string group = moment_group;
    time_.add_to(command, "Time since the scene's beginning; default: what the scene says, or 0")
        .type_name("S")
        .group(group);
    command
        .add_option("--frames", frames_,
                    "Several frames: 1-100, 1-100x2, 1,5,9-12; the time of one is its number / fps")
        .type_name("A-B")
        .group(group);
    frames_per_second_.add_to(command, "Frames a second, for --frames and for motion")
        .type_name("N")
        .default_str(fmt::format("{}", RenderJob().frames_per_second))
        .group(group);
}

Result<std::vector<Shot>> RenderFlags::shots(const RenderJob& job) const {
    double time = 0;
    DARKROOM_TRY(time_.read_to(time));
    if (time_.is_given() && frames_)
        return user_error("--time: --frames sets the time of every frame; give one of the two");
    const double step = 1 / job.frames_per_second;
    const auto shot = [&](std::uint64_t number, double at) {
        return Shot{.number = number,
                    .time = at,
                    .previous_time = std::max(0.0, at - step),
                    .delta_time = step,
                    .picture = darkroom::numbered(out_, static_cast<long long>(number)),
                    .frame = darkroom::numbered(frame_.value_or(""), static_cast<long long>(number))};
    };
    if (!frames_) return std::vector{shot(0, time)};
    DARKROOM_TRY_VALUE(const darkroom::FrameSet frames, parse_frames(*frames_));
    std::vector<Shot> out;
    for (const long long number : frames.numbers()) {
        if (number < 0) return user_error(fmt::format("--frames {}: a scene begins at frame 0", printable(*frames_)));
        out.push_back(shot(static_cast<std::uint64_t>(number), job.time_of(static_cast<std::uint64_t>(number))));
    }
    return out;
}

Result<> RenderFlags::check_files(const std::vector<Shot>& shots) const {
    const bool is_many = shots.size() > 1;
    if (out_.empty()) return user_error("-o: an output file is needed");
    if (is_many && !darkroom::has_number_pattern(out_) && out_ != stream_name)
        return user_error(fmt::format("-o {}: {} frames need a name with %04d", printable(out_), shots.size()));
    if (frame_) {
        const auto format = darkroom::written_format(*frame_);
        if (!format || *format != &darkroom::exr_format())
            return user_error(fmt::format("--save-frame {}: a frame is an .exr file", printable(*frame_)));
        if (is_many && !darkroom::has_number_pattern(*frame_))
            return user_error(
                fmt::format("--save-frame {}: {} frames need a name with %04d", printable(*frame_), shots.size()));
    }
    const FileSet inputs(std::array<fs::path, 1>{scene});
    std::set<fs::path> outputs;
    for (const Shot& shot : shots)
        for (const fs::path* const place : {&shot.picture, &shot.frame}) {
            const fs::path& path = *place;
            if (path.empty() || path == stream_name) continue;
            if (!outputs.insert(path.lexically_normal()).second)
                return user_error(fmt::format("{}: -o and --save-frame name the same file", printable(path.string())));
            DARKROOM_TRY(check_output(path, inputs, run.missing_folders()));
            if (place == &shot.frame) DARKROOM_TRY(darkroom::check_own_file(path, darkroom::FileOwner::Anyone));
        }
    return {};
}

Result<> RenderFlags::set_target(RenderJob& job) const {
    DARKROOM_TRY_VALUE(job.stream, write.stream(out_, job.frames_per_second));
    if (job.stream) {
        job.target = target_for(job.stream->format);
        return run.check_stream();
    }
    DARKROOM_TRY_VALUE(const darkroom::SampleKind samples, darkroom::sample_kind(out_, job.write));
    job.target = target_for(samples, job.write);
    job.color = darkroom::color_of(job.write, samples);
    return {};
}

Result<std::uint32_t> RenderFlags::samples(std::uint32_t of_scene) const {
    std::uint32_t samples = of_scene > 0 ? of_scene : usual_samples;
    if (has_lens()) samples = std::max(samples, usual_samples_of_lens);
    DARKROOM_TRY(samples_.read_to(samples));
    if (has_lens() && samples == 1)
        return user_error(
            fmt::format("--samples 1: with --aperture, allowed is [2, {}]", darkroom::scene::max_samples));
    return samples;
}

Result<> RenderFlags::set_lens(RenderJob& job) const {
    darkroom::render::LensDesc& lens = job.desc.lens;
    for (const auto& [flag, to] : {std::pair(&aperture_, &lens.f_stop), std::pair(&focus_, &lens.focus_distance),
                                   std::pair(&sensor_height_, &lens.sensor_height)})
        DARKROOM_TRY(flag->read_to(*to));
    if (!has_lens() && (focus_.is_given() || sensor_height_.is_given()))
        return user_error(
            fmt::format("{}: needs --aperture, which makes a lens", focus_.is_given() ? "--focus" : "--sensor-height"));
    // So that highlights keep their light.
    job.desc.is_mean_weighed = !has_lens();
    return {};
}

void RenderFlags::add_lens_of(const darkroom::scene::Camera& camera, darkroom::render::LensDesc& lens) const {
    if (!focus_.is_given()) lens.focus_distance = camera.lens.focus.value_or(lens.focus_distance);
    if (!sensor_height_.is_given()) lens.sensor_height = camera.lens.sensor_height.value_or(lens.sensor_height);
}

Result<RenderJob> RenderFlags::job() const {
    RenderJob job;
    DARKROOM_TRY(run.start_report());
    DARKROOM_TRY_VALUE(job.seed, drawn.seed());
    DARKROOM_TRY_VALUE(job.desc, drawn.desc());
    DARKROOM_TRY_VALUE(job.orbit, drawn.orbit());
    DARKROOM_TRY(write.ocio.check(false));
    DARKROOM_TRY_VALUE(job.write, write.options());
    DARKROOM_TRY_VALUE(job.jobs, run.jobs());
    DARKROOM_TRY(frames_per_second_.read_to(job.frames_per_second));
    DARKROOM_TRY(render_scale_.read_to(job.render_scale));
    DARKROOM_TRY(set_lens(job));
    job.is_sequence = frames_.has_value();
    DARKROOM_TRY(set_target(job));
    DARKROOM_TRY_VALUE(job.shots, this->shots(job));
    if (job.shots.size() > 1) job.write.max_threads = 1;  // several files are encoded at once
    DARKROOM_TRY(check_files(job.shots));
    return job;
}

}  // namespace app
