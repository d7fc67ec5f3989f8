// SPDX-License-Identifier: MIT
#include "sequence.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <thread>

#include "bench/world.hpp"
#include "child.hpp"
#include "core/thread/parallel.hpp"
#include "develop/developer.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"

namespace darkroom::bench {

namespace {

// A sequence as a renderer leaves it on a disk: OpenEXR, ZIP, halves with depth and normals. The street of the world
// in stone, under a sun that gets brighter, with the noise of a path tracer: neither flat nor noise alone, so that it
// packs as pictures do.

constexpr float noise_amount = 0.04F;

// Mark Jarzynski and Marc Olano, "Hash Functions for GPU Rendering", 2020: pcg.
std::uint32_t hash(std::uint32_t value) {
    const std::uint32_t state = value * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return (word >> 22U) ^ word;
}

/// In [-1, 1].
float noise(std::uint32_t seed) { return static_cast<float>(hash(seed) >> 8U) * 0x1p-23F - 1; }

/// Blocks of half a metre, each of a shade of its own, with a grain of a few centimetres.
float stone(const std::array<float, 3>& place) {
    const auto cell = [&](float size) {
        std::uint32_t seed = 0;
        for (const float x : place) seed = hash(seed + static_cast<std::uint32_t>(std::lround(x / size)));
        return noise(seed);
    };
    return 0.45F + 0.2F * cell(0.5F) + 0.1F * cell(0.04F);
}

FrameFile frame_of(const StreetView& view, VkExtent2D extent, std::uint32_t index) {
    FrameFile out;
    out.color = Picture(extent.width, extent.height);
    out.depth.emplace(extent.width, extent.height).values = view.distance;
    out.normals.emplace(extent.width, extent.height);
    out.camera.world_to_camera = view.camera.view;
    out.camera.projection = view.camera.projection;
    const Matrix& projection = view.camera.projection;
    const float sun = 0.5F + 0.005F * static_cast<float>(index);
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const std::size_t pixel = std::size_t{y} * extent.width + x;
            const float* const normal = &view.normals[3 * pixel];
            const float distance = view.distance[pixel];
            const float right = (static_cast<float>(x) / static_cast<float>(extent.width) * 2 - 1) / projection[0];
            const float down = (static_cast<float>(y) / static_cast<float>(extent.height) * 2 - 1) / projection[5];
            const bool is_sky = distance >= sky_depth;
            const float lit = 0.03F + sun * std::max(0.4F * normal[0] + 0.7F * normal[1] + 0.6F * normal[2], 0.0F);
            const float light =
                is_sky ? 0.25F + 0.15F * down : lit * stone({right * distance, down * distance, distance});
            std::uint32_t seed = hash(index * 0x10001U + static_cast<std::uint32_t>(pixel));
            float* const color = out.color.at(x, y);
            const std::array tint{1.0F, 0.9F, is_sky ? 1.3F : 0.75F};
            for (std::size_t c = 0; c < 3; ++c) color[c] = light * tint[c] * (1 + noise_amount * noise(seed++));
            color[3] = 1;
            for (std::size_t axis = 0; axis < 3 && !is_sky; ++axis)
                out.normals->at(x, y)[axis] = normal[axis] + noise_amount * noise(seed++);
        }
    return out;
}

/// One name for all frames, with %04d.
std::filesystem::path frames_pattern(const std::filesystem::path& folder) { return folder / "in.%04d.exr"; }

std::filesystem::path frame_path(const std::filesystem::path& folder, std::uint32_t index) {
    return folder / fmt::format("in.{:04}.exr", index);
}

/// Frames 0 to `count` - 1.
Result<> write_frames(const std::filesystem::path& folder, VkExtent2D extent, std::uint32_t count) {
    const StreetView view = view_street(extent);
    std::vector<Result<>> written(count);
    parallel_for(count, 0, [&](std::size_t i) {
        const auto index = static_cast<std::uint32_t>(i);
        written[i] = write_frame(frame_path(folder, index), frame_of(view, extent, index));
    });
    for (Result<>& result : written)
        if (!result) return std::move(result);
    return {};
}

/// In the order of the rows. Develop is upload, GPU and read-back.
enum Work : std::size_t { Decode, Develop, Encode, OneAfterTheOther, Program, Oiiotool };
constexpr std::array<std::string_view, 6> names{"sequence.decode",  "sequence.develop",
                                                "sequence.encode",  "sequence.one-after-the-other",
                                                "sequence.program", "sequence.oiiotool"};
using Times = std::array<Sample, names.size()>;

/// Gone with what is in it.
class TemporaryFolder {
  public:
    TemporaryFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("darkroom_sequence_{}", getpid())) {
        std::filesystem::create_directories(path_);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

std::string output_pattern(const std::filesystem::path& folder, std::string_view name) {
    return (folder / name).string() + ".%04d.png";
}
std::filesystem::path output_path(const std::filesystem::path& folder, std::string_view name, std::uint32_t index) {
    return folder / fmt::format("{}.{:04}.png", name, index);
}

void add(Sample& to, const Sample& more) {
    to.cpu_ms += more.cpu_ms;
    to.wall_ms += more.wall_ms;
    to.gpu_ms += more.gpu_ms;
}

DevelopInput input_of(const FrameFile& frame, std::uint32_t index) {
    Camera camera{.view = *frame.camera.world_to_camera, .projection = *frame.camera.projection};
    camera.previous_view = camera.view;
    camera.previous_projection = camera.projection;
    camera.depth = DepthKind::Planar;
    return {.extent = {frame.color.width, frame.color.height},
            .color = frame.color.pixels,
            .depth = frame.depth->values,
            .normals = frame.normals->values,
            .camera = camera,
            .frame_index = index};
}

/// What the program does of one frame, each part when the one before has ended.
Result<> develop_frame(Composer& composer, Developer& developer, const std::filesystem::path& folder,
                       std::uint32_t index, Times& times) {
    const Stopwatch decoding;
    DARKROOM_TRY_VALUE(const auto frame, read_frame(frame_path(folder, index)));
    add(times[Decode], decoding.elapsed());

    const Stopwatch developing;
    DARKROOM_TRY_VALUE(const auto picture, developer.develop(composer, input_of(frame, index)));
    Sample developed = developing.elapsed();
    for (const PassTime& pass : composer.times().passes) developed.gpu_ms += pass.milliseconds;
    add(times[Develop], developed);

    const Stopwatch encoding;
    auto done = write_bytes(output_path(folder, names[OneAfterTheOther], index), picture.extent.width,
                            picture.extent.height, picture.bytes);
    add(times[Encode], encoding.elapsed());
    return done;
}

Result<> develop_one_after_the_other(Device& device, const std::filesystem::path& folder, std::uint32_t frames,
                                     Times& times) {
    Composer composer(device, {.frames_in_flight = 1, .has_timers = true});
    Developer developer(device, {});
    DARKROOM_TRY(apply(default_look(), composer));
    Times unmeasured;
    // The first frame is when the stack is compiled.
    DARKROOM_TRY(develop_frame(composer, developer, folder, 0, unmeasured));
    const Stopwatch watch;
    for (std::uint32_t i = 0; i < frames; ++i) DARKROOM_TRY(develop_frame(composer, developer, folder, i, times));
    times[OneAfterTheOther] = watch.elapsed();
    return {};
}

/// The time of a program that is not there stays 0.
Result<> run_programs(const SequenceDesc& desc, const std::filesystem::path& folder, Times& times) {
    const std::string input = frames_pattern(folder).string();
    const auto run = [&](Work work, std::vector<std::string> arguments) -> Result<> {
        DARKROOM_TRY_VALUE(const auto sample, run_program(std::move(arguments), folder / "log"));
        if (sample) times[work] = *sample;
        return {};
    };
    std::vector<std::string> develop{DARKROOM_PROGRAM, "develop", input, "--out",
                                     output_pattern(folder, names[Program])};
    if (!desc.device.empty()) develop.insert(develop.end(), {"--device", desc.device});
    DARKROOM_TRY(run(Program, std::move(develop)));
    return run(Oiiotool, {"oiiotool", "--frames", fmt::format("0-{}", desc.frames - 1), input, "--ch", "R,G,B", "-d",
                          "uint8", "-o", output_pattern(folder, names[Oiiotool])});
}

/// Of the last frame, between this process and the program.
Result<Figure> differing_pixels(const std::filesystem::path& folder, std::uint32_t frames) {
    const auto own = read_frame(output_path(folder, names[OneAfterTheOther], frames - 1));
    const auto other = read_frame(output_path(folder, names[Program], frames - 1));
    if (!own || !other) return failure(own ? other.error() : own.error());
    double count = 0;
    for (std::size_t i = 0; i < own->color.pixels.size(); i += 4)
        count += std::equal(&own->color.pixels[i], &own->color.pixels[i] + 4, &other->color.pixels[i]) ? 0 : 1;
    return Figure{"sequence: pixels in which the program differs", count, "", 0.0};
}

std::vector<Figure> figures_of(const std::vector<Row>& rows) {
    const Row &develop = rows[Develop], &program = rows[Program], &oiiotool = rows[Oiiotool];
    std::vector<Figure> out{{"sequence: upload and read-back",
                             median(column(develop, &Sample::wall_ms)) - median(column(develop, &Sample::gpu_ms)),
                             "ms"}};
    if (minimum(column(program, &Sample::wall_ms)) == 0) return out;
    const double cores = std::max(std::thread::hardware_concurrency(), 1U);
    std::vector<double> busy;
    for (const Sample& sample : program.samples) busy.push_back(100 * sample.cpu_ms / sample.wall_ms / cores);
    out.push_back({.name = "sequence: rate of the program / one after other",
                   .value = ratio(rows[OneAfterTheOther], program, &Sample::wall_ms)});
    if (minimum(column(oiiotool, &Sample::wall_ms)) > 0)
        out.push_back({.name = "sequence: rate of the program / oiiotool",
                       .value = ratio(oiiotool, program, &Sample::wall_ms),
                       .at_least = 1.6});
    out.push_back({.name = "sequence: processors busy", .value = median(busy), .unit = "%", .at_least = 90.0});
    return out;
}

}  // namespace

std::vector<std::string> sequence_row_names() { return {names.begin(), names.end()}; }

Result<SequenceReport> measure_sequence(Device& device, const SequenceDesc& desc) {
    const TemporaryFolder folder;
    DARKROOM_TRY(write_frames(folder.path(), desc.extent, desc.frames));
    SequenceReport report{.frames = desc.frames};
    for (const std::string_view name : names) report.rows.push_back({.name = std::string(name)});
    for (std::uint32_t round = 0; round < desc.rounds; ++round) {
        Times times;
        DARKROOM_TRY(develop_one_after_the_other(device, folder.path(), desc.frames, times));
        DARKROOM_TRY(run_programs(desc, folder.path(), times));
        for (std::size_t i = 0; i < times.size(); ++i)
            report.rows[i].samples.push_back({.cpu_ms = times[i].cpu_ms / desc.frames,
                                              .wall_ms = times[i].wall_ms / desc.frames,
                                              .gpu_ms = times[i].gpu_ms / desc.frames});
    }
    report.figures = figures_of(report.rows);
    if (report.rows[Program].samples.back().wall_ms > 0) {
        DARKROOM_TRY_VALUE(auto differing, differing_pixels(folder.path(), desc.frames));
        report.figures.push_back(std::move(differing));
    }
    std::erase_if(report.rows, [](const Row& row) {
        const bool is_absent = row.samples.back().wall_ms == 0;
        if (is_absent) fmt::print(stderr, "{}: left out, the program is not there\n", row.name);
        return is_absent;
    });
    return report;
}

}  // namespace darkroom::bench
