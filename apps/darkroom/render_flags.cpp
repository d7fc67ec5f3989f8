// SPDX-License-Identifier: MIT
#include "render_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "core/param_text.hpp"
#include "image/sequence.hpp"
#include "outputs.hpp"
#include "report.hpp"

namespace app {

namespace fs = std::filesystem;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;
using darkroom::render::DebugView;

namespace {

constexpr VkExtent2D default_extent{1920, 1080};
constexpr double default_frames_per_second = 24;

struct DebugMode {
    const char* name;
    DebugView view;
};
constexpr std::array debug_modes{
    DebugMode{"wireframe", DebugView::Wireframe}, DebugMode{"normals", DebugView::Normals},
    DebugMode{"depth", DebugView::Depth},         DebugMode{"uv", DebugView::Uv},
    DebugMode{"unlit", DebugView::Unlit},         DebugMode{"metalrough", DebugView::MetalRough}};

Result<DebugView> parse_debug_mode(const std::string& text) {
    std::vector<std::string> names;
    for (const DebugMode& mode : debug_modes) {
        if (text == mode.name) return mode.view;
        names.emplace_back(mode.name);
    }
    return user_error(fmt::format("--debug-mode {}: allowed is {}{}", printable(text), fmt::join(names, ", "),
                                  darkroom::suggestion(text, names)));
}

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

Result<darkroom::scene::vec3> parse_vec3(std::string_view flag, const std::string& text) {
    darkroom::scene::vec3 out;
    std::string_view rest = text;
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = rest.find(',');
        const bool is_last = comma == std::string_view::npos;
        const std::optional<double> number = darkroom::parse_number(trimmed(rest.substr(0, comma)));
        if (!number || is_last != (i == 2) || std::abs(*number) > std::numeric_limits<float>::max())
            return user_error(fmt::format("{} {}: expected three numbers, X,Y,Z", flag, printable(text)));
        out[i] = static_cast<float>(*number);
        if (!is_last) rest.remove_prefix(comma + 1);
    }
    return out;
}

}  // namespace

void RenderFlags::add_to(CLI::App& command, std::span<const darkroom::LookEntry> named) {
    command.add_option("SCENE", scene, "A scene (.toml) or a model (.glb, .gltf)")->required();
    command
        .add_option("-o,--output,--out", out_,
                    "The picture: .png .jpg .tif .exr .hdr; for several frames a name with %04d")
        ->type_name("OUT")
        ->capture_default_str();
    command.add_option("--frame", frame_, "The raw frame, too: linear light, depth, normals, motion and camera (.exr)")
        ->type_name("OUT.exr");
    width_.add_to(command, "Of the picture")->type_name("PIXELS")->default_str(fmt::format("{}", default_extent.width));
    height_.add_to(command, "Of the picture")
        ->type_name("PIXELS")
        ->default_str(fmt::format("{}", default_extent.height));
    command.add_option("--size", size_, "Both at once")->type_name("WxH");
    command.add_option("--schemas", schemas_, "Taken for the sake of old command lines; there is nothing to check")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("DIR")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_moments(command);
    add_camera(command);
    add_drawing(command);
    write.add_to(command);
    run.add_to(command);
    device.add_to(command);
    look.add_to(command, true, named);
}

void RenderFlags::add_moments(CLI::App& command) {
    const std::string group = "The moment";
    time_.add_to(command, "Since the scene's beginning, default: what the scene says, or 0")
        ->type_name("S")
        ->group(group);
    command.add_option("--frames", frames_, "Several frames; the time of a frame is its number / fps")
        ->type_name("FIRST-LAST")
        ->group(group);
    frames_per_second_.add_to(command, "Frames a second, for --frames and for motion")
        ->type_name("N")
        ->default_str(fmt::format("{}", default_frames_per_second))
        ->group(group);
    seed_.add_to(command, "Of the particles")->type_name("N")->default_str("0")->group(group);
}

void RenderFlags::add_camera(CLI::App& command) {
    const std::string group = "The camera, each on top of the scene's own";
    distance_.add_to(command, "From the target")->type_name("METRES")->group(group);
    yaw_.add_to(command, "Around the target")->type_name("DEGREES")->group(group);
    pitch_.add_to(command, "Above the target")->type_name("DEGREES")->group(group);
    command.add_option("--target", target_, "What is looked at; the camera moves with it")
        ->type_name("X,Y,Z")
        ->group(group);
    field_of_view_.add_to(command, "Vertical field of view")->type_name("DEGREES")->group(group);
}

void RenderFlags::add_drawing(CLI::App& command) {
    const std::string group = "What is drawn";
    command.add_flag("--no-grid", has_no_grid_, "No grid on the ground")->group(group);
    command
        .add_option("--debug-mode", debug_mode_,
                    "wireframe, normals, depth, uv, unlit or metalrough; neither tone-mapped nor post-processed")
        ->type_name("MODE")
        ->group(group);
    command.add_flag("--wireframe-overlay", has_wireframe_overlay_, "Edges of all triangles on top")->group(group);
    command.add_flag("--show-normals", has_normal_arrows_, "An arrow for the normal of every vertex")->group(group);
    command.add_flag("--no-tonemapping", has_no_tone_mapping_, "Light above 1 is cut off")->group(group);
    command.add_flag("--no-shadows", has_no_shadows_, "No light casts shadows")->group(group);
    shadow_resolution_.add_to(command, "Of each cascade of a shadow map")
        ->type_name("TEXELS")
        ->default_str(fmt::format("{}", darkroom::render::RenderDesc().cascades.resolution))
        ->group(group);
    samples_.add_to(command, "Samples a pixel, of the counts that the device has")
        ->type_name("N")
        ->default_str(fmt::format("{}", darkroom::render::RenderDesc().samples))
        ->group(group);
}

Result<VkExtent2D> RenderFlags::extent() const {
    if (size_) {
        if (width_.is_given() || height_.is_given())
            return user_error(fmt::format("--size {}: it says width and height, leave out --{}", printable(*size_),
                                          width_.is_given() ? "width" : "height"));
        return parse_size(*size_);
    }
    VkExtent2D extent = default_extent;
    if (Result<> done = width_.read_to(extent.width); !done) return failure(std::move(done));
    if (Result<> done = height_.read_to(extent.height); !done) return failure(std::move(done));
    return extent;
}

Result<darkroom::scene::OrbitOverride> RenderFlags::orbit() const {
    darkroom::scene::OrbitOverride out;
    for (const auto& [flag, to] : {std::pair(&distance_, &out.distance), std::pair(&yaw_, &out.yaw),
                                   std::pair(&pitch_, &out.pitch), std::pair(&field_of_view_, &out.field_of_view)})
        if (Result<> done = flag->read_to(*to); !done) return failure(std::move(done));
    if (target_) {
        const Result<darkroom::scene::vec3> target = parse_vec3("--target", *target_);
        if (!target) return failure(target.error());
        out.target = *target;
    }
    return out;
}

Result<darkroom::render::RenderDesc> RenderFlags::desc() const {
    darkroom::render::RenderDesc out;
    const Result<VkExtent2D> size = extent();
    if (!size) return failure(size.error());
    out.extent = *size;
    if (Result<> done = shadow_resolution_.read_to(out.cascades.resolution); !done) return failure(std::move(done));
    if (Result<> done = samples_.read_to(out.samples); !done) return failure(std::move(done));
    if (debug_mode_) {
        const Result<DebugView> view = parse_debug_mode(*debug_mode_);
        if (!view) return failure(view.error());
        out.debug = *view;
    }
    out.is_tone_mapped = !has_no_tone_mapping_;
    out.has_shadows = !has_no_shadows_;
    out.has_grid = !has_no_grid_;
    out.has_wireframe_overlay = has_wireframe_overlay_;
    out.has_normal_arrows = has_normal_arrows_;
    return out;
}

Result<std::vector<Shot>> RenderFlags::shots() const {
    double frames_per_second = default_frames_per_second, time = 0;
    if (Result<> done = frames_per_second_.read_to(frames_per_second); !done) return failure(std::move(done));
    if (Result<> done = time_.read_to(time); !done) return failure(std::move(done));
    if (time_.is_given() && frames_)
        return user_error("--time: --frames says the time of every frame, leave out one of them");
    const double step = 1 / frames_per_second;
    const auto shot = [&](std::uint64_t number, double at) {
        return Shot{.number = number,
                    .time = at,
                    .previous_time = std::max(0.0, at - step),
                    .delta_time = step,
                    .picture = darkroom::numbered(out_, static_cast<long long>(number)),
                    .frame = darkroom::numbered(frame_.value_or(""), static_cast<long long>(number))};
    };
    if (!frames_) return std::vector{shot(0, time)};
    const Result<FrameRange> range = parse_frames(*frames_);
    if (!range) return failure(range.error());
    std::vector<Shot> out;
    for (std::uint64_t number = range->first; number <= range->last; ++number)
        out.push_back(shot(number, static_cast<double>(number) / frames_per_second));
    return out;
}

Result<> RenderFlags::check_files(const std::vector<Shot>& shots) const {
    const bool is_many = shots.size() > 1;
    if (out_.empty()) return user_error("-o: an output file is needed");
    if (is_many && !darkroom::has_number_pattern(out_))
        return user_error(fmt::format("-o {}: {} frames need a name with %04d", printable(out_), shots.size()));
    if (frame_) {
        const Result<darkroom::FileKind> kind = darkroom::file_kind(*frame_);
        if (!kind || *kind != darkroom::FileKind::OpenExr)
            return user_error(fmt::format("--frame {}: a frame is an .exr file", printable(*frame_)));
        if (is_many && !darkroom::has_number_pattern(*frame_))
            return user_error(
                fmt::format("--frame {}: {} frames need a name with %04d", printable(*frame_), shots.size()));
    }
    const FileSet inputs(std::array<fs::path, 1>{scene});
    std::set<fs::path> outputs;
    for (const Shot& shot : shots)
        for (const fs::path& path : {shot.picture, shot.frame}) {
            if (path.empty()) continue;
            if (!outputs.insert(path.lexically_normal()).second)
                return user_error(fmt::format("{}: would be picture and frame", printable(path.string())));
            if (Result<> done = check_output(path, inputs); !done) return done;
        }
    return {};
}

Result<RenderJob> RenderFlags::job() const {
    RenderJob job;
    if (Result<> done = seed_.read_to(job.seed); !done) return failure(std::move(done));
    Result<darkroom::render::RenderDesc> desc = this->desc();
    if (!desc) return failure(std::move(desc));
    job.desc = *desc;
    const Result<darkroom::scene::OrbitOverride> orbit = this->orbit();
    if (!orbit) return failure(orbit.error());
    job.orbit = *orbit;
    Result<darkroom::WriteOptions> options = write.options();
    if (!options) return failure(std::move(options));
    job.write = std::move(*options);
    const Result<std::size_t> jobs = run.jobs();
    if (!jobs) return failure(jobs.error());
    job.jobs = *jobs;
    const Result<darkroom::SampleKind> samples = darkroom::sample_kind(out_, job.write);
    if (!samples) return failure(samples.error());
    job.samples = *samples;
    Result<std::vector<Shot>> shots = this->shots();
    if (!shots) return failure(std::move(shots));
    job.shots = std::move(*shots);
    if (job.shots.size() > 1) job.write.max_threads = 1;  // several files are encoded at once
    if (Result<> done = check_files(job.shots); !done) return failure(std::move(done));
    if (!schemas_.empty()) warn("--schemas: scenes are checked without schema files, the folders are not read");
    return job;
}

}  // namespace app
