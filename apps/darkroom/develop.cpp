// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "commands.hpp"
#include "core/param_text.hpp"
#include "develop/developer.hpp"
#include "device_flags.hpp"
#include "frames.hpp"
#include "image/resize.hpp"
#include "image/sequence.hpp"
#include "look_flags.hpp"
#include "number_flag.hpp"
#include "outputs.hpp"
#include "report.hpp"

namespace app {

namespace {

using darkroom::Result;
using darkroom::user_error;

struct Options {
    LookFlags look;
    DeviceFlags device;
    std::vector<std::string> inputs, maps;
    std::string out, size, bits, camera;
    NumberFlag fov{"--fov", {.least = 0, .most = 180, .is_open = true, .unit = "deg"}};
    NumberFlag time{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    bool is_reference = false, has_timings = false, has_alpha = false;
};

/// Everything that can be known before a frame is read.
struct Job {
    std::vector<std::filesystem::path> inputs, outputs;
    darkroom::Look look;
    darkroom::FrameOptions frame;
    darkroom::WriteOptions write;
    darkroom::DevelopDesc develop;
    std::optional<VkExtent2D> size;
    std::optional<double> time;
};

Result<Job> job_of(const Options& options) {
    Job job;
    if (options.is_reference && options.has_timings)
        return user_error("--timings: the references do not run on the device");
    if (Result<> done = options.time.read_to(job.time); !done) return failure(std::move(done));
    if (Result<> done = options.fov.read_to(job.frame.vertical_field_of_view); !done) return failure(std::move(done));
    Result<std::vector<std::filesystem::path>> inputs = darkroom::expand_inputs(options.inputs);
    if (!inputs) return failure(std::move(inputs));
    job.inputs = std::move(*inputs);
    Result<std::vector<std::filesystem::path>> outputs = output_paths(job.inputs, options.out);
    if (!outputs) return failure(std::move(outputs));
    job.outputs = std::move(*outputs);
    job.write.alpha = options.has_alpha;
    if (!options.bits.empty()) {
        const Result<darkroom::SampleKind> bits = parse_bits(options.bits);
        if (!bits) return failure(bits.error());
        job.write.samples = *bits;
    }
    for (const std::filesystem::path& output : job.outputs) {
        const Result<darkroom::SampleKind> samples = darkroom::sample_kind(output, job.write);
        if (!samples) return failure(samples.error());
        job.develop.target = target_for(*samples);
    }
    if (!options.size.empty()) {
        const Result<VkExtent2D> size = parse_size(options.size);
        if (!size) return failure(size.error());
        job.size = *size;
    }
    for (const std::string& map : options.maps)
        if (Result<> added = darkroom::add_mapping(job.frame.names, map); !added) return failure(std::move(added));
    job.frame.camera_file = options.camera;
    const Result<darkroom::KernelStage> stage = options.device.stage();
    if (!stage) return failure(stage.error());
    job.develop.kernels = *stage;
    job.develop.fuse = options.device.is_fused();
    Result<darkroom::Look> look = options.look.look();
    if (!look) return failure(std::move(look));
    job.look = std::move(*look);
    job.frame.has_shadow_depths = needs_shadows(job.look);
    return job;
}

class Develop {
  public:
    Develop(const Options& options, Job job) : options_(options), job_(std::move(job)) {}

    Result<> run() {
        Progress progress(job_.inputs.size());
        for (std::size_t i = 0; i < job_.inputs.size(); ++i) {
            const Result<std::string> line = develop(i);
            if (!line) return failure(line.error());
            progress.step(*line);
            if (options_.has_timings) print_timings(*composer_);
        }
        return {};
    }

    [[nodiscard]] int exit_code(int code) const { return device_ ? finish(*device_, code) : code; }

  private:
    // The device is made when the first frame has been read: an unreadable one is refused at once.
    Result<> make_composer() {
        if (composer_) return {};
        Result<darkroom::Device> device = options_.device.create();
        if (!device) return failure(std::move(device));
        device_ = std::make_unique<darkroom::Device>(std::move(*device));
        composer_ = std::make_unique<darkroom::Composer>(
            *device_, darkroom::ComposerDesc{.frames_in_flight = 1, .has_timers = options_.has_timings});
        developer_ = std::make_unique<darkroom::Developer>(*device_, job_.develop);
        return darkroom::apply(job_.look, *composer_);
    }

    Result<std::string> develop(std::size_t index) {
        const std::string shown = darkroom::printable(job_.inputs[index].string());
        Result<darkroom::FrameFile> frame = darkroom::read_frame(job_.inputs[index], job_.frame);
        if (!frame) return failure(std::move(frame));
        for (const std::string& warning : frame->warnings) warn(fmt::format("{}: {}", shown, warning));
        if (Result<> done = make_composer(); !done) return failure(std::move(done));
        const VkExtent2D extent = job_.size.value_or(VkExtent2D{frame->color.width, frame->color.height});
        if (Result<> done = darkroom::check_extent(*device_, extent); !done)
            return failure(darkroom::Error{done.error().fault, fmt::format("{}: {}", shown, done.error().text)});
        Result<darkroom::FrameFile> sized = darkroom::resize(std::move(*frame), extent.width, extent.height);
        if (!sized) return failure(std::move(sized));
        const std::vector<darkroom::ReferenceLight> lights = take_lights(*sized);
        darkroom::DevelopInput input = develop_input(*sized, lights);
        if (job_.time) input.time = *job_.time;
        if (!sized->frame_index) input.frame_index = index;
        std::vector<std::string> left_out;
        Result<darkroom::DevelopedPicture> picture =
            options_.is_reference ? develop_by_reference(*composer_, input, job_.develop.target, left_out)
                                  : developer_->develop(*composer_, input);
        if (!picture) return failure(std::move(picture));
        if (!options_.is_reference) left_out = developer_->plan().left_out;
        if (index == 0) warn_of_what_is_left_out(job_.look, *composer_, left_out);
        const VkExtent2D size = picture->extent;
        if (Result<> done = write(job_.outputs[index], std::move(*picture), job_.write); !done)
            return failure(std::move(done));
        return fmt::format("{} -> {} ({}x{})", shown, darkroom::printable(job_.outputs[index].string()), size.width,
                           size.height);
    }

    const Options& options_;
    Job job_;
    std::unique_ptr<darkroom::Device> device_;
    std::unique_ptr<darkroom::Composer> composer_;
    std::unique_ptr<darkroom::Developer> developer_;
};

int run(const Options& options) {
    Result<Job> job = job_of(options);
    if (!job) return fail(job.error());
    Develop develop(options, std::move(*job));
    const Result<> done = develop.run();
    return develop.exit_code(done ? exit_ok : fail(done.error()));
}

}  // namespace

Command add_develop(CLI::App& program) {
    CLI::App* const command = program.add_subcommand("develop", "Develops HDR frames into finished pictures");
    const auto options = std::make_shared<Options>();
    command
        ->add_option("INPUT", options->inputs,
                     "Frames (EXR, HDR, PNG, JPEG, TIFF); shot.%04d.exr stands for all that match")
        ->required();
    command
        ->add_option(
            "-o,--out", options->out,
            "The picture: .png .jpg .tif .exr .hdr. For several inputs a folder, or a name with %04d or {name}")
        ->type_name("OUT")
        ->required();
    command->add_option("--size", options->size, "Develops at this size; the frame is resampled first")
        ->type_name("WxH");
    command->add_option("--bits", options->bits, "Samples of the file: 8, 16, half or float")->type_name("BITS");
    command->add_flag("--alpha", options->has_alpha, "Keeps alpha; without it pictures are opaque");
    command->add_flag("--reference", options->is_reference, "By the CPU references alone, in double precision");
    command->add_flag("--timings", options->has_timings, "Prints the GPU milliseconds of every pass");
    options->time.add_to(*command, "For effects that move; default: what the frame says, or 0")->type_name("S");
    const std::string frame_group = "The frame";
    command
        ->add_option("--map", options->maps,
                     "What a layer is called in the file: depth=NAME, normals=, velocity=, color=")
        ->type_name("LAYER=NAME")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(frame_group);
    options->fov.add_to(*command, "Vertical field of view, where the file has no projection")
        ->type_name("DEGREES")
        ->group(frame_group);
    command->add_option("--camera", options->camera, "A camera file (TOML)")->type_name("FILE")->group(frame_group);
    options->device.add_to(*command);
    options->look.add_to(*command, true);
    return {command, [options] { return run(*options); }};
}

}  // namespace app
