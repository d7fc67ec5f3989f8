// SPDX-License-Identifier: MIT
// darkroom_lab capture: what temporal filters are given of a scene, at several sizes, and the truth that they should
// find.
#include "capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/composer.hpp>
#include <memory>
#include <optional>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/sequence.hpp"
#include "lab/lab.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/render/scene_flags.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/jitter.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "scene/assets.hpp"

namespace app {

namespace {

namespace fs = std::filesystem;
namespace render = darkroom::render;
namespace scene = darkroom::scene;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

constexpr VkExtent2D default_extent{960, 540};
constexpr std::uint32_t usual_samples = 64;
constexpr std::size_t max_captured_frames = 10'000;

struct Options {
    SceneFlags drawn;
    DeviceFlags device;
    std::string scene, folder, frames, scales = "1,1.5,2,3", mean = "tone-mapped";
    std::optional<std::string> truth_frames;
    NumberFlag frames_per_second{"--fps", {.least = 0.001, .most = 1e6, .is_rate = true}};
    NumberFlag samples{"--samples", {.least = 2, .most = scene::max_samples, .is_whole = true}};
};

Result<std::vector<long long>> parse_moments(const char* flag, const std::string& text) {
    DARKROOM_TRY_VALUE(const darkroom::FrameSet set, parse_frames(text));
    std::vector<long long> numbers = set.numbers();
    if (numbers.size() > max_captured_frames)
        return user_error(fmt::format("{} {}: {} frames, at most {} are allowed", flag, printable(text), numbers.size(),
                                      max_captured_frames));
    if (numbers.front() < 0) return user_error(fmt::format("{} {}: a scene begins at frame 0", flag, printable(text)));
    return numbers;
}

Result<CaptureJob> job_of(const Options& options) {
    CaptureJob job{.folder = options.folder};
    if (options.folder.empty()) return user_error("-o: a folder is needed");
    DARKROOM_TRY_VALUE(job.desc, options.drawn.desc());
    job.desc.positions = usual_samples;
    DARKROOM_TRY(options.samples.read_to(job.desc.positions));
    if (options.mean != "tone-mapped" && options.mean != "linear")
        return user_error(fmt::format("--mean {}: allowed is tone-mapped or linear", printable(options.mean)));
    job.desc.is_mean_weighed = options.mean == "tone-mapped";
    DARKROOM_TRY_VALUE(job.orbit, options.drawn.orbit());
    DARKROOM_TRY_VALUE(job.seed, options.drawn.seed());
    DARKROOM_TRY(options.frames_per_second.read_to(job.frames_per_second));
    DARKROOM_TRY_VALUE(job.frames, parse_moments("--frames", options.frames));
    job.truth_frames = job.frames;
    if (options.truth_frames) {
        DARKROOM_TRY_VALUE(job.truth_frames, parse_moments("--truth-frames", *options.truth_frames));
    }
    if (!std::ranges::includes(job.frames, job.truth_frames))
        return user_error(fmt::format("--truth-frames {}: are not all among --frames {}",
                                      printable(*options.truth_frames), printable(options.frames)));
    DARKROOM_TRY_VALUE(job.scales, parse_scales(options.scales, job.desc.extent));
    return job;
}

/// As the sample of FSR 2 makes it by default of the colour before and behind transparency: 0.9 where a channel of
/// c / (1 + max c) differs by 0.2 and more.
darkroom::Plane<1> reactive_mask(const darkroom::FrameFile& frame) {
    constexpr float threshold = 0.2F, value = 0.9F;
    darkroom::Plane<1> out(frame.color.width, frame.color.height);
    const auto shown = [](const float* light, std::size_t channel) {
        return light[channel] / (1 + std::max({light[0], light[1], light[2], 0.0F}));
    };
    for (std::size_t i = 0; i < out.values.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const float change = shown(&frame.color.pixels[4 * i], c) - shown(&frame.transparency->values[3 * i], c);
            if (std::abs(change) >= threshold) out.values[i] = value;
        }
    return out;
}

class Capture {
  public:
    Capture(const Options& options, CaptureJob job) : options_(options), job_(std::move(job)) {}

    Result<> run() {
        DARKROOM_TRY(read());
        DARKROOM_TRY(make());
        Progress progress(job_.frames.size() * job_.scales.size() + job_.truth_frames.size());
        for (const long long frame : job_.frames) DARKROOM_TRY(capture(frame, progress));
        // It comes last: a folder with a description is whole.
        const std::string text = describe(job_, fs::path(options_.scene).filename().string()).dump(2) + "\n";
        return darkroom::write_own_file(job_.folder / capture_description, std::as_bytes(std::span(text)),
                                        darkroom::FileOwner::Anyone);
    }

    [[nodiscard]] int exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

  private:
    Result<> read() {
        std::vector<std::string> warnings;
        Result<scene::Scene> read =
            scene::read_scene(options_.scene, {.warnings = &warnings, .named_files = options_.drawn.named_files()});
        for (const std::string& warning : warnings) warn(warning);
        if (!read) return failure(std::move(read));
        scene_ = std::move(*read);
        assets_ = scene::load_assets(scene_);
        DARKROOM_TRY(scene::check_snapshot(scene_, assets_));
        for (const std::string& warning : assets_.warnings) warn(warning);
        return {};
    }

    /// Renderers first: what the device refuses leaves the folder as it was.
    Result<> make() {
        DARKROOM_TRY_VALUE(darkroom::Device device, options_.device.create());
        device_ = std::make_unique<darkroom::Device>(std::move(device));
        DARKROOM_TRY(darkroom::check_extent(*device_, job_.desc.extent));
        job_.desc.draw.has_grid = job_.desc.draw.has_grid && scene_.has_grid;
        DARKROOM_TRY_VALUE(render::Renderer truth, render::Renderer::create(*device_, scene_, assets_, job_.desc));
        truth_.emplace(std::move(truth));
        for (const CaptureScale& scale : job_.scales) {
            render::RenderDesc desc = job_.desc;
            desc.extent = scale.extent;
            desc.positions = 1;
            desc.has_transparency = true;
            desc.draw.mip_bias = darkroom::Composer::mip_bias(scale.exact);
            DARKROOM_TRY_VALUE(render::Renderer made, truth_->sharing(desc));
            inputs_.push_back(std::move(made));
        }
        return make_folders();
    }

    Result<> make_folders() const {
        std::error_code error;
        const fs::path parent = fs::absolute(job_.folder, error).lexically_normal().parent_path();
        const fs::space_info space = fs::space(fs::is_directory(job_.folder, error) ? job_.folder : parent, error);
        constexpr double megabyte = 1e6;
        if (!error && space.available < job_.bytes())
            return user_error(fmt::format("{}: the capture takes up to {:.1f} MB, {:.1f} MB are free",
                                          printable(job_.folder.string()), static_cast<double>(job_.bytes()) / megabyte,
                                          static_cast<double>(space.available) / megabyte));
        DARKROOM_TRY(check_folder(job_.folder, MissingFolders::Made));
        fs::remove(job_.folder / capture_description, error);
        DARKROOM_TRY(darkroom::make_own_folder(job_.folder / "truth"));
        for (const CaptureScale& scale : job_.scales)
            DARKROOM_TRY(darkroom::make_own_folder(job_.folder / scale.folder));
        return {};
    }

    Result<> capture(long long frame, Progress& progress) {
        const auto [width, height] = job_.desc.extent;
        const double time = job_.time_of(frame), step = 1 / job_.frames_per_second;
        const scene::Snapshot snapshot =
            scene::snapshot(scene_, assets_,
                            {.time = time,
                             .previous_time = std::max(0.0, time - step),
                             .aspect = static_cast<float>(width) / static_cast<float>(height),
                             .seed = job_.seed,
                             .orbit = job_.orbit});
        if (frame == job_.frames.front())
            for (const std::string& warning : snapshot.warnings) warn(warning);
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const auto number = static_cast<std::uint64_t>(frame);
            DARKROOM_TRY_VALUE(darkroom::FrameFile input,
                               shoot(inputs_[i], snapshot, frame, jitter_of(number, job_.scales[i].exact)));
            input.reactive = reactive_mask(input);
            input.exposure = 1;
            DARKROOM_TRY(write(job_.scales[i].files(), frame, input, progress));
        }
        if (!std::ranges::binary_search(job_.truth_frames, frame)) return {};
        DARKROOM_TRY_VALUE(const darkroom::FrameFile truth, shoot(*truth_, snapshot, frame, {}));
        return write(CaptureJob::truth_files(), frame, truth, progress);
    }

    /// Without lights, whose shadows are most of a file.
    Result<darkroom::FrameFile> shoot(render::Renderer& renderer, const scene::Snapshot& snapshot, long long number,
                                      const render::FrameJitter& jitter) const {
        DARKROOM_TRY(renderer.prepare(snapshot, jitter));
        darkroom::Frame frame = renderer.frame();
        frame.lights = {};
        frame.time = job_.time_of(number);
        frame.delta_time = 1 / job_.frames_per_second;
        frame.frame_index = static_cast<std::uint64_t>(number);
        DARKROOM_TRY_VALUE(darkroom::FrameLayers layers,
                           darkroom::read_layers(*device_, frame,
                                                 [&](VkCommandBuffer commands) { return renderer.record(commands); }));
        return frame_file(frame, std::move(layers));
    }

    Result<> write(const std::string& files, long long number, const darkroom::FrameFile& frame,
                   Progress& progress) const {
        const fs::path path = darkroom::numbered(job_.folder / files, number);
        DARKROOM_TRY(darkroom::write_frame(path, frame));
        progress.step(
            {.from = options_.scene, .to = path.string(), .width = frame.color.width, .height = frame.color.height});
        return {};
    }

    const Options& options_;
    CaptureJob job_;
    scene::Scene scene_;
    scene::Assets assets_;
    std::unique_ptr<darkroom::Device> device_;
    std::optional<render::Renderer> truth_;
    std::vector<render::Renderer> inputs_;
};

int run(const Options& options) {
    Result<CaptureJob> job = job_of(options);
    if (!job) return fail(job.error());
    Capture capture(options, std::move(*job));
    const Result<> done = capture.run();
    return capture.exit_code(done ? exit_ok : fail(done.error()));
}

}  // namespace

Command add_capture(CommandFlags program) {
    const CommandFlags command = program.add_command(
        "capture", "Draws the frames of a scene that temporal filters get, at several sizes, and their truth");
    command.examples(
        "darkroom_lab capture scene.toml --frames 0-1 --scales 1,2 --samples 4 --size 64x36 -o captured\n"
        "darkroom_lab capture scene.toml --frames 0-1 --truth-frames 1 --samples 4 --size 64x36 -o truth\n"
        "darkroom_lab capture scene.toml --frames 0 --scales 1.5 --mean linear --samples 4 --size 64x36 -o linear");
    const auto options = std::make_shared<Options>();
    command.add_option("SCENE", options->scene, "A scene (.toml) or a model (.glb, .gltf)").required();
    command.add_option("-o,--output,--out", options->folder, "The folder; it is made where it is not there")
        .type_name("DIR")
        .required();
    command.add_option("--frames", options->frames, "Frames that filters get: 1-100, 1,5,9-12")
        .type_name("A-B")
        .required();
    command.add_option("--truth-frames", options->truth_frames, "Frames among them that have a truth; default: all")
        .type_name("A-B");
    options->frames_per_second.add_to(command, "Frames a second").type_name("N").default_str("24");
    command.add_option("--scales", options->scales, "Lines of the picture for each line of the frames that filters get")
        .type_name("S,S")
        .capture_default();
    options->samples.add_to(command, "Number of places within a pixel that the truth averages")
        .type_name("N")
        .default_str(fmt::format("{}", usual_samples));
    command.add_option("--mean", options->mean, "Mean of c / (1 + max c), as a display shows it, or of light itself")
        .type_name("tone-mapped|linear")
        .capture_default();
    options->drawn.add_to(command, default_extent, 1, "The time");
    options->device.add_to(command);
    return {command, [options] { return run(*options); }};
}

namespace {

constexpr std::size_t max_scales = 8;
constexpr double max_scale = 10;
/// Colour and the colour before transparency in halves, depth and motion in floats, normals and mask in halves.
constexpr std::uint64_t bytes_a_pixel = 8 + 6 + 4 + 8 + 6 + 2;
constexpr std::uintmax_t max_description_bytes = 1 << 20;

Json size_of(VkExtent2D extent) { return Json{extent.width, extent.height}; }

darkroom::Failure bad_scales(const std::string& text) {
    return user_error(fmt::format("--scales {}: allowed are 1 to {} numbers in [1, {:g}], each once, with commas",
                                  printable(text), max_scales, max_scale));
}

}  // namespace

std::uint64_t CaptureJob::bytes() const {
    const auto pixels = [](VkExtent2D extent) { return std::uint64_t{extent.width} * extent.height; };
    std::uint64_t out = truth_frames.size() * pixels(desc.extent) * bytes_a_pixel;
    for (const CaptureScale& scale : scales) out += frames.size() * pixels(scale.extent) * bytes_a_pixel;
    return out;
}

Result<std::vector<CaptureScale>> parse_scales(const std::string& text, VkExtent2D extent) {
    std::vector<CaptureScale> out;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(',', start), text.size());
        const std::optional<double> number = darkroom::parse_number(text.substr(start, end - start));
        const bool is_new = number && std::ranges::find(out, *number, &CaptureScale::scale) == out.end();
        if (!is_new || !(*number >= 1 && *number <= max_scale) || out.size() == max_scales) return bad_scales(text);
        CaptureScale& scale = out.emplace_back(CaptureScale{.scale = *number, .folder = fmt::format("{:g}x", *number)});
        scale.extent = scaled(extent, 1 / *number);
        scale.exact = static_cast<float>(extent.height) / static_cast<float>(scale.extent.height);
        start = end + 1;
    }
    return out;
}

Json describe(const CaptureJob& job, std::string_view scene_file) {
    Json inputs = Json::array();
    for (const CaptureScale& scale : job.scales)
        inputs.push_back(Json{{"scale", scale.scale},
                              {"size", size_of(scale.extent)},
                              {"mip_bias", double{darkroom::Composer::mip_bias(scale.exact)}},
                              {"files", scale.files()}});
    return {{"format", 1},
            {"scene", printable(scene_file)},
            {"size", size_of(job.desc.extent)},
            {"frames_per_second", job.frames_per_second},
            {"seed", job.seed},
            {"frames", darkroom::frame_set_text(job.frames)},
            {"inputs", std::move(inputs)},
            {"truth", Json{{"files", CaptureJob::truth_files()},
                           {"frames", darkroom::frame_set_text(job.truth_frames)},
                           {"samples", job.desc.positions},
                           {"mean", job.desc.is_mean_weighed ? "tone_mapped" : "linear"}}}};
}

Result<CapturedTruth> read_capture(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / capture_description;
    DARKROOM_TRY_VALUE(const auto bytes, darkroom::read_file(file, {.max_size = max_description_bytes}));
    const std::optional<Json> json = Json::parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const auto refused = [&](std::string_view what) {
        return user_error(fmt::format("{}: {}", printable(file.string()), what));
    };
    if (!json || !json->is_object()) return refused("is not a description of a capture: a JSON object is needed");
    const Json* const format = json->find("format");
    if (format == nullptr || !format->is_whole() || format->whole() != 1) return refused("format: allowed is 1");
    const Json* const truth = json->find("truth");
    if (truth == nullptr || !truth->is_object()) return refused("truth: an object is needed");
    CapturedTruth out{.folder = folder};
    const Json *const files = truth->find("files"), *const frames = truth->find("frames");
    if (files == nullptr || !files->is_text() || frames == nullptr || !frames->is_text())
        return refused("truth: files and frames are needed, both texts");
    const std::filesystem::path named = files->text();
    if (named.is_absolute() || std::ranges::find(named, std::filesystem::path("..")) != named.end())
        return refused(fmt::format("truth.files {}: allowed is a name within the folder", printable(files->text())));
    out.files = files->text();
    const Result<darkroom::FrameSet> set = parse_frames(frames->text());
    if (!set) return refused(fmt::format("truth.frames: {}", set.error().text));
    out.frames = set->numbers();
    return out;
}

}  // namespace app
