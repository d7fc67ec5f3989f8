// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "develop/developer.hpp"
#include "formats/exr/exr.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/write.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/dim_bloom.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/jitter.hpp"
#include "programs/darkroom/run/motion.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/sequence_run.hpp"
#include "scene/assets.hpp"
#include "scene/scene.hpp"
#include "scene_flags.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

// The flags of `render` and what they ask for: moments, files, and what all that draw scenes have. Everything that can
// be known without the scene and without a device is checked here.

/// One picture: a moment of the scene and the files it becomes.
struct Shot {
    std::uint64_t number = 0;  ///< of the frame
    double time = 0;           ///< seconds
    double previous_time = 0;  ///< one frame before, but not before 0
    double delta_time = 0;
    std::filesystem::path picture;
    std::filesystem::path frame;  ///< empty: not asked for
    bool is_written = true;       ///< false: for the sake of effects with history alone
};

struct RenderJob {
    darkroom::render::RenderDesc desc;  ///< without `output`: that is for the look to say
    darkroom::scene::OrbitOverride orbit;
    std::vector<Shot> shots;
    darkroom::WriteOptions write;
    std::size_t jobs = 0;
    darkroom::DevelopTarget target = darkroom::DevelopTarget::Encoded8;
    std::optional<darkroom::ColorState> color;  ///< in place of that of the target
    std::optional<StreamDesc> stream;
    std::uint64_t seed = 0;
    double frames_per_second = 24;
    double render_scale = 1;   ///< of the frame's lines to those of the picture, whose extent `desc` has
    bool is_sequence = false;  ///< its frames follow each other

    [[nodiscard]] double time_of(std::uint64_t frame) const { return static_cast<double>(frame) / frames_per_second; }
};

class RenderFlags {
  public:
    void add_to(CommandFlags command, std::span<const darkroom::LookEntry> named);
    [[nodiscard]] darkroom::Result<RenderJob> job() const;

    SceneFlags drawn;
    LookFlags look;
    DeviceFlags device;
    WriteFlags write;
    RunFlags run;
    std::string scene;
    /// Do the flags say a time? Else it is the scene's.
    bool has_time() const { return time_.is_given() || frames_; }
    /// Places within a pixel that light is the mean of: those of the flag, else of the scene, else enough for edges
    /// within 0.02 FLIP of 256.
    [[nodiscard]] darkroom::Result<std::uint32_t> samples(std::uint32_t of_scene) const;
    [[nodiscard]] bool has_samples() const { return samples_.is_given(); }
    [[nodiscard]] bool has_lens() const { return aperture_.is_given(); }
    /// Of a lens what the scene's camera says and no flag does.
    void add_lens_of(const darkroom::scene::Camera& camera, darkroom::render::LensDesc& lens) const;

  private:
    void add_moments(CommandFlags command);
    [[nodiscard]] darkroom::Result<std::vector<Shot>> shots(const RenderJob& job) const;
    /// What becomes of the pictures: files or a stream.
    [[nodiscard]] darkroom::Result<> set_target(RenderJob& job) const;
    [[nodiscard]] darkroom::Result<> set_lens(RenderJob& job) const;
    [[nodiscard]] darkroom::Result<> check_files(const std::vector<Shot>& shots) const;

    // Optional, so that an empty text is a wrong value, not a missing one.
    std::string out_ = "render.png";
    std::optional<std::string> frame_, frames_;
    NumberFlag time_{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames_per_second_{"--fps", {.least = 0.001, .most = 1e6, .is_rate = true}};
    NumberFlag render_scale_{"--render-scale", {.least = 0.1, .most = 1}};
    NumberFlag aperture_{"--aperture", {.least = 0.5, .most = 64}};
    NumberFlag focus_{"--focus", {.least = 0.01, .most = 1e5, .unit = "m"}};
    NumberFlag sensor_height_{"--sensor-height", {.least = 1, .most = 1000, .unit = "mm"}};
    NumberFlag samples_{"--samples", {.least = 1, .most = darkroom::scene::max_samples, .is_whole = true}};
};

constexpr VkExtent2D default_extent{1920, 1080};
constexpr const char* moment_group = "The time";
constexpr std::uint32_t usual_samples = 3, usual_samples_of_lens = 256;

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
            const auto check = place == &shot.frame ? check_report : check_output;
            DARKROOM_TRY(check(path, inputs, run.missing_folders()));
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

namespace render = darkroom::render;
namespace scene = darkroom::scene;
using darkroom::DevelopedPicture;
using darkroom::DevelopTarget;

/// How a picture comes about.
enum class Way {
    Developed,  ///< linear light through the look
    Display,    ///< by the scene's own shaders
    Linear,     ///< linear light as it is, into a float file
};

std::string shown(const std::filesystem::path& path) { return darkroom::printable(path.string()); }

// The effects that bring light into the range of a display. None is known by name.
bool switch_tone_mapping_off(darkroom::Look& look) {
    bool was_there = false;
    for (darkroom::LookEntry& entry : look.entries) {
        const darkroom::EffectInfo& effect = *entry.effect;
        if (effect.makes == nullptr || !effect.accepts.contains(darkroom::Domain::SceneLinear)) continue;
        if (effect.makes({}, entry.words.data()).domain != darkroom::Domain::DisplayLinear) continue;
        entry.state.enabled = false;
        was_there = true;
    }
    return was_there;
}

// Effects that the lens makes superfluous: those that are told where it is focused. None is known by name.
void switch_lens_blur_off(darkroom::Look& look) {
    for (darkroom::LookEntry& entry : look.entries) {
        const auto& rows = entry.effect->parameters.rows;
        if (!entry.state.enabled.on ||
            std::ranges::find(rows, "focus_distance", &darkroom::ParamInfo::name) == rows.end())
            continue;
        entry.state.enabled = false;
        tell(fmt::format("--aperture: the lens blurs, {} is off",
                         entry.name.empty() ? std::string(entry.effect->name) : darkroom::printable(entry.name)));
    }
}

class Render {
  public:
    explicit Render(const RenderFlags& flags) : flags_(flags) {}

    Result<> run() {
        DARKROOM_TRY(read());
        if (job_.shots.empty()) return {};  // all are there
        DARKROOM_TRY(make());
        const auto pictures = std::ranges::count(job_.shots, true, &Shot::is_written);
        items_.resize(job_.shots.size());
        const Result<> done = run_sequence({.steps = items_.size(),
                                            .pictures = static_cast<std::size_t>(pictures),
                                            .jobs = job_.jobs,
                                            .keeps_going = flags_.run.keeps_going,
                                            .has_timings = flags_.run.has_timings},
                                           {.decode = [this](std::size_t i) { return pose(i); },
                                            .begin = [this](std::size_t i) { return render(i); },
                                            .finish = [](std::size_t) { return Result<>(); },
                                            .encode = [this](std::size_t i) { return encode(i); },
                                            .deliver = [this](std::size_t i) { return deliver(i); },
                                            .made = [this](std::size_t i) { return made(job_.shots[i]); },
                                            .release = [this](std::size_t i) { items_[i] = {}; }});
        if (composer_ && flags_.run.has_timings && done) pass_times_.print();
        return done;
    }

    Result<> check() {
        DARKROOM_TRY(read_flags());
        // Its prefabs are read with it; what a scene only warns of, each run tells.
        if (!scene::is_model_path(flags_.scene)) {
            DARKROOM_TRY_VALUE(scene_, read_scene());
        }
        return read_look();
    }

    [[nodiscard]] int exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

  private:
    /// What a shot has while it is under way.
    struct Item {
        std::optional<scene::Snapshot> snapshot;
        DevelopedPicture picture;
        std::vector<std::byte> packed;  ///< of a stream: what goes out
        VkExtent2D extent{};            ///< of that
        std::optional<darkroom::FrameFile> frame;
    };

    Result<> read_flags() {
        DARKROOM_TRY_VALUE(job_, flags_.job());
        if (job_.stream) stream_.emplace(*job_.stream);
        tell_of_half_range(job_.write);
        DARKROOM_TRY_VALUE(const darkroom::KernelStage stage, flags_.device.stage());
        develop_ = {.target = job_.target, .color = job_.color, .kernels = stage, .fuse = flags_.device.is_fused()};
        return {};
    }

    Result<> read_look() {
        flags_.add_lens_of(scene_.camera, job_.desc.lens);
        // Models hold no look.
        DARKROOM_TRY_VALUE(
            look_, flags_.look.look(scene::is_model_path(flags_.scene) ? "" : flags_.scene, lens_of(scene_.camera)));
        DARKROOM_TRY(check_ui_files(look_));
        suit(look_, job_.target, job_.write);
        if (!job_.stream) DARKROOM_TRY(check_codes(look_, job_.target, job_.write));
        if (!flags_.look.events.empty()) {
            DARKROOM_TRY_VALUE(timeline_, Timeline::read(flags_.look.events, look_));
        }
        motion_ = Motion(look_, timeline_, [this](std::size_t frame) { return job_.time_of(frame); });
        choose_way();
        if (flags_.run.has_timings && way_ != Way::Developed)
            return darkroom::user_error("--timings: no effect runs, so there is nothing to time");
        if (job_.render_scale != 1 && way_ != Way::Developed)
            return darkroom::user_error(
                "--render-scale: no effect runs that could enlarge the picture; --size sets its size");
        if (job_.color && way_ != Way::Developed)
            return darkroom::user_error("--output-space: no effect runs that could encode the picture");
        if (!flags_.has_lens()) return {};
        if (way_ == Way::Display)
            return darkroom::user_error(
                "--aperture: the scene's own shaders draw no blur; a look does, or linear light in an .exr");
        switch_lens_blur_off(look_);
        return {};
    }

    Result<scene::Scene> read_scene(std::vector<std::string>* warnings = nullptr) const {
        return scene::read_scene(
            flags_.scene,
            {.is_strict = flags_.look.is_strict(), .warnings = warnings, .named_files = flags_.drawn.named_files()});
    }

    // Everything that needs no device: a slip is told before one is made.
    Result<> read() {
        DARKROOM_TRY(read_flags());
        std::vector<std::string> warnings;
        Result<scene::Scene> scene = read_scene(&warnings);
        for (const std::string& warning : warnings) warn(warning);
        if (!scene) return failure(std::move(scene));
        scene_ = std::move(*scene);
        if (!flags_.has_time()) {
            Shot& shot = job_.shots.front();
            shot.time = scene_.time;
            shot.previous_time = std::max(0.0, scene_.time - shot.delta_time);
        }
        DARKROOM_TRY(read_look());
        const bool is_orthographic = scene_.camera.projection == scene::Projection::Orthographic;
        if (job_.orbit.field_of_view && is_orthographic) warn("--fov: ignored, the scene's camera is orthographic");
        assets_ = scene::load_assets(scene_);
        DARKROOM_TRY(check_model());
        DARKROOM_TRY(scene::check_snapshot(scene_, assets_));
        for (const std::string& warning : assets_.warnings) warn(warning);
        std::vector<std::filesystem::path> inputs = assets_.files;
        std::ranges::move(flags_.look.input_files(), std::back_inserter(inputs));
        std::ranges::move(ui_files(look_), std::back_inserter(inputs));
        const FileSet files(inputs);
        for (const Shot& shot : job_.shots)
            for (const std::filesystem::path& path : {shot.picture, shot.frame})
                if (!path.empty() && path != stream_name) DARKROOM_TRY(check_output(path, files));
        const std::size_t asked_for = job_.shots.size();
        const std::size_t skipped = std::erase_if(job_.shots, [&](const Shot& shot) {
            return flags_.run.is_skipped(shot.picture) && (shot.frame.empty() || flags_.run.is_skipped(shot.frame));
        });
        RunFlags::tell_of_skipped(skipped, asked_for);
        if (way_ == Way::Developed) DARKROOM_TRY(add_pre_roll());
        tell(fmt::format("Loaded scene {}\nEntities: {}", darkroom::printable(scene_.name), scene_.entities.size()));
        return {};
    }

    /// The shots before each that histories need and that are not made anyway.
    Result<> add_pre_roll() {
        if (job_.shots.empty()) return {};
        const double delta_time = job_.shots.front().delta_time;
        DARKROOM_TRY_VALUE(const std::uint32_t of_look, add_needs(look_, delta_time, timeline_, needs_));
        DARKROOM_TRY_VALUE(const std::uint32_t of_motion,
                           motion_.pre_roll(look_, delta_time, job_.shots.back().number));
        const std::uint32_t pre_roll = std::max(of_look, of_motion);
        std::vector<Shot> all;
        for (const Shot& shot : job_.shots) {
            std::uint64_t first = shot.number - std::min<std::uint64_t>(shot.number, pre_roll);
            if (!all.empty()) first = std::max(first, all.back().number + 1);
            for (std::uint64_t number = first; number < shot.number; ++number) {
                Shot& before = all.emplace_back(shot);
                before.number = number;
                before.time = job_.time_of(number);
                before.previous_time = std::max(0.0, before.time - shot.delta_time);
                before.frame.clear();
                before.is_written = false;
            }
            all.push_back(shot);
        }
        job_.shots = std::move(all);
        return {};
    }

    // In a scene a broken model is a gap; alone there is nothing left, and its error counts.
    [[nodiscard]] Result<> check_model() const {
        if (!scene::is_model_path(flags_.scene)) return {};
        if (!assets_.model_errors.empty()) return failure(assets_.model_errors.front());
        const auto draws = [](const scene::Model& model) {
            return std::ranges::any_of(model.nodes, [&](const scene::Node& node) {
                return node.mesh < model.meshes.size() && !model.meshes[node.mesh].primitives.empty();
            });
        };
        if (std::ranges::any_of(assets_.models, draws)) return {};
        return darkroom::user_error(
            fmt::format("{}: the model has no triangles in its scene, nothing is drawn", shown(flags_.scene)));
    }

    void choose_way() {
        const bool is_debug = job_.desc.draw.debug != render::DebugView::None;
        const bool is_off = flags_.look.is_off() || !look_.is_enabled;
        const bool is_light = develop_.target == DevelopTarget::SceneLinear;
        // The interface is laid over an encoded picture by the stack.
        if (!is_debug && (!is_off || (look_.ui && !is_light)))
            way_ = Way::Developed;
        else
            way_ = !is_debug && is_light ? Way::Linear : Way::Display;
        if (way_ == Way::Developed && !flags_.drawn.is_tone_mapped() && !switch_tone_mapping_off(look_))
            warn("--no-tonemapping: the look has no tone mapping");
    }

    Result<> make() {
        DARKROOM_TRY_VALUE(darkroom::Device device, flags_.device.create());
        device_ = std::make_unique<darkroom::Device>(std::move(device));
        const VkExtent2D extent = job_.desc.extent;
        DARKROOM_TRY(darkroom::check_extent(*device_, extent));
        render::RenderDesc desc = job_.desc;
        desc.draw.has_grid = desc.draw.has_grid && scene_.has_grid;
        const bool has_frames = !job_.shots.back().frame.empty();
        if (way_ == Way::Display) {
            desc.output = render::Output::Display;
            desc.draw.exposure = darkroom::exposure_of(look_);
            // Its own shaders encode it, so the rasteriser smooths its edges.
            if (desc.draw.debug == render::DebugView::None && !flags_.drawn.has_msaa()) desc.samples = usual_msaa;
            // What the file holds more of than eight bits: half floats have eleven, and no range to leave.
            if (develop_.target != DevelopTarget::Encoded8) desc.display_format = VK_FORMAT_R16G16B16A16_SFLOAT;
            DARKROOM_TRY(make_renderer(desc, display_));
        }
        if (way_ != Way::Display || has_frames) {
            DARKROOM_TRY_VALUE(const std::uint32_t samples, flags_.samples(scene_.samples));
            is_jittered_ = job_.is_sequence && way_ == Way::Developed && gathers_frames(look_);
            // Frames that are gathered have their other places in the frames before.
            desc.positions = is_jittered_ && !flags_.has_samples() && !flags_.has_lens() ? 1 : samples;
            desc.has_transparency = desc.positions == 1 && desc.samples == 1 && needs_.has_transparency;
            desc.extent = scaled(extent, job_.render_scale);
            scale_ = static_cast<float>(extent.height) / static_cast<float>(desc.extent.height);
            desc.draw.mip_bias = way_ == Way::Developed ? darkroom::Composer::mip_bias(scale_) : 0;
            desc.output = render::Output::Hdr;
            desc.draw.debug = render::DebugView::None;
            DARKROOM_TRY(make_renderer(desc, hdr_));
        }
        if (way_ != Way::Developed) return {};
        if (job_.render_scale != 1) develop_.target_extent = extent;
        composer_ = std::make_unique<darkroom::Composer>(
            *device_, darkroom::ComposerDesc{.frames_in_flight = 1, .has_timers = flags_.run.has_timings});
        developer_ = std::make_unique<darkroom::Developer>(*device_, develop_);
        return darkroom::apply(look_, *composer_, {.keeps = timeline_.entries()});
    }

    Result<> make_renderer(const render::RenderDesc& desc, std::optional<render::Renderer>& to) {
        DARKROOM_TRY_VALUE(render::Renderer made, display_ ? display_->sharing(desc)
                                                           : render::Renderer::create(*device_, scene_, assets_, desc));
        to.emplace(std::move(made));
        return {};
    }

    Result<> pose(std::size_t i) {
        const auto [width, height] = job_.desc.extent;
        const Shot& shot = job_.shots[i];
        items_[i].snapshot = scene::snapshot(scene_, assets_,
                                             {.time = shot.time,
                                              .previous_time = shot.previous_time,
                                              .aspect = static_cast<float>(width) / static_cast<float>(height),
                                              .seed = job_.seed,
                                              .orbit = job_.orbit});
        return {};
    }

    Result<> render(std::size_t i) {
        Item& item = items_[i];
        if (i == 0)
            for (const std::string& warning : item.snapshot->warnings) warn(warning);
        if (display_) {
            DARKROOM_TRY(display_->prepare(*item.snapshot));
            DARKROOM_TRY_VALUE(item.picture,
                               darkroom::read_picture(*device_, display_->picture(), recorder(*display_)));
        }
        if (hdr_) DARKROOM_TRY(render_light(i));
        item.snapshot.reset();
        return {};
    }

    Result<> encode(std::size_t i) {
        const Shot& shot = job_.shots[i];
        if (!shot.is_written) return {};
        Item& item = items_[i];
        if (item.frame) DARKROOM_TRY(darkroom::write_frame(shot.frame, *item.frame, job_.write.max_threads));
        if (!stream_) return write(shot.picture, std::move(item.picture), job_.write);
        item.extent = item.picture.extent;
        item.packed = stream_->pack(std::exchange(item.picture, {}));
        return {};
    }

    Result<> deliver(std::size_t i) {
        if (!stream_ || !job_.shots[i].is_written) return {};
        return stream_->write(items_[i].packed, items_[i].extent, shown(flags_.scene));
    }

    [[nodiscard]] std::optional<Made> made(const Shot& shot) const {
        if (!shot.is_written) return std::nullopt;
        const auto [width, height] = job_.desc.extent;
        return Made{.from = flags_.scene, .to = shot.picture.string(), .width = width, .height = height};
    }

    /// The linear frame: through the look, or as it is, and into a file of its own.
    Result<> render_light(std::size_t i) {
        const Shot& shot = job_.shots[i];
        Item& item = items_[i];
        DARKROOM_TRY(
            hdr_->prepare(*item.snapshot, is_jittered_ ? jitter_of(shot.number, scale_) : render::FrameJitter{}));
        darkroom::DeviceFrame input{.frame = hdr_->frame(),
                                    .color_usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
                                    .layer_usage = hdr_->layer_usage(),
                                    .record_before = recorder(*hdr_)};
        input.frame.camera = as_stored(input.frame.camera);
        input.frame.time = shot.time;
        input.frame.delta_time = shot.delta_time;
        input.frame.frame_index = shot.number;
        input.frame.camera.is_cut = i > 0 && job_.shots[i - 1].number + 1 != shot.number;
        darkroom::FrameLayers layers;
        const bool has_frame = !shot.frame.empty();
        if (way_ == Way::Developed) {
            DARKROOM_TRY(motion_.advance(*composer_, shot.number, shot.time));
            DARKROOM_TRY_VALUE(const auto ui, motion_.picture(job_.desc.extent));
            input.ui = *ui;
            DARKROOM_TRY_VALUE(DevelopedPicture made,
                               developer_->develop(*composer_, input, has_frame ? &layers : nullptr));
            if (i == 0) warn_of_what_is_left_out(look_, *composer_, composer_->current_plan()->left_out);
            if (i == 0) warn_of_what_is_misplaced(*composer_->current_plan());
            if (i == 0) tell_of_dim_bloom(*device_, *composer_, look_, develop_, input);
            item.picture = std::move(made);
            if (flags_.run.has_timings) pass_times_.add(composer_->times().passes);
        } else {
            DARKROOM_TRY_VALUE(layers, darkroom::read_layers(*device_, input.frame, input.record_before));
            if (way_ == Way::Linear) item.picture = {.extent = layers.extent, .pixels = layers.color};
        }
        if (has_frame) item.frame = frame_file(input.frame, std::move(layers));
        return {};
    }

    static darkroom::RecordBefore recorder(render::Renderer& renderer) {
        return [&renderer](VkCommandBuffer commands) { return renderer.record(commands); };
    }

    const RenderFlags& flags_;
    RenderJob job_;
    darkroom::DevelopDesc develop_;
    scene::Scene scene_;
    scene::Assets assets_;
    darkroom::Look look_;
    Timeline timeline_;
    Way way_ = Way::Developed;
    std::unique_ptr<darkroom::Device> device_;
    std::optional<render::Renderer> hdr_, display_;
    darkroom::FrameOptions needs_{.has_transparency = false};
    bool is_jittered_ = false;
    float scale_ = 1;  ///< lines of the picture to those of the frame
    std::unique_ptr<darkroom::Composer> composer_;
    Motion motion_;  ///< moves the composer, so it goes first
    std::unique_ptr<darkroom::Developer> developer_;
    std::vector<Item> items_;
    std::optional<PictureStream> stream_;
    PassTimes pass_times_;
};

int run(const RenderFlags& flags) {
    Render render(flags);
    const Result<> done = render.run();
    return render.exit_code(done ? exit_ok : fail(done.error()));
}

}  // namespace

static Command add_render(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command = program.add_command("render", "Renders a scene and post-processes it");
    command.examples(
        "darkroom render scene.toml --size 640x360 -o picture.png\n"
        "darkroom render scene.toml --frames 0-1 --fps 24 --size 64x36 -o 'out.####.png'\n"
        "darkroom render scene.toml --size 64x36 --yaw 200 --save-frame frame.exr -o picture.png");
    const auto flags = std::make_shared<RenderFlags>();
    flags->add_to(command, named);
    return {command, [flags] { return run(*flags); }, [flags] { return Render(*flags).check(); }};
}

CommandRow render_command() {
    return {.names = {"render"}, .place = 10, .add = [](const CommandHost& host) {
                return std::vector{add_render(host.program, host.named)};
            }};
}

}  // namespace app
