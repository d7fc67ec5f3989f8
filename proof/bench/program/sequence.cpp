// SPDX-License-Identifier: MIT
#include "sequence.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <darkroom/look.hpp>
#include <filesystem>
#include <thread>

#include "child.hpp"
#include "develop/developer.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "sequence_frames.hpp"

namespace darkroom::bench {

namespace {

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
