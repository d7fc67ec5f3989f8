// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "core/text/param_text.hpp"
#include "develop/developer.hpp"
#include "formats/exr/exr.hpp"
#include "image/color/output_space.hpp"
#include "image/frame/sequence.hpp"
#include "image/picture/alpha.hpp"
#include "image/picture/resize.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/device_flags.hpp"
#include "programs/darkroom/flags/flags.hpp"
#include "programs/darkroom/flags/frame_flags.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/flags/run_flags.hpp"
#include "programs/darkroom/run/dim_bloom.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "programs/darkroom/run/motion.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"
#include "programs/darkroom/run/sequence_run.hpp"
#include "scene/scene.hpp"

namespace app {

namespace {

using darkroom::Result;
using darkroom::user_error;

/// Of frames that say nothing else: as DevelopInput has it.
constexpr double usual_frames_per_second = 60;
/// Of a stream of pictures, where nothing says how fast they go.
constexpr double stream_frames_per_second = 24;

struct Options {
    LookFlags look;
    DeviceFlags device;
    WriteFlags write;
    RunFlags run;
    FrameFlags frame;
    std::vector<std::string> inputs;
    std::string out, size, output_size;
    std::optional<std::string> frames;
    std::string gaps;
    NumberFlag time{"--time", {.least = 0, .most = 1e9, .unit = "s"}};
    NumberFlag frames_per_second{"--fps", {.least = 0.001, .most = 1e6, .is_rate = true}};
    bool is_reference = false, keeps_layers = false, has_gain_map = false;
};

/// A name of files with %V, which stands for the eye, and %v, for the first letter of it.
std::string with_eye(std::string name, const std::string& eye) {
    if (eye.empty()) return name;
    for (const auto& [sign, text] : {std::pair<std::string, std::string>{"%V", eye}, {"%v", eye.substr(0, 1)}})
        for (std::size_t at = 0; (at = name.find(sign, at)) != std::string::npos; at += text.size())
            name.replace(at, sign.size(), text);
    return name;
}

/// One frame to go through the stack. What is read for the sake of effects with history alone makes no picture.
struct Step {
    std::size_t place = 0;  ///< among all inputs
    std::filesystem::path input, output;
    long long number = 0;
    bool is_written = false;
    long long missing = 0;  ///< frames that are asked for and not there, between the written one before and this
};

/// Everything that can be known before a frame is read.
struct Job {
    std::string eye, out;
    std::vector<darkroom::NumberedFile> inputs;
    std::optional<darkroom::FrameSet> frames;  ///< else all are asked for
    std::vector<Step> steps;
    std::size_t skipped = 0;  ///< pictures that are there already
    std::size_t jobs = 0;
    darkroom::Look look;
    std::optional<darkroom::Look> brighter;  ///< for a gain map: the look as it was given
    Timeline timeline;
    darkroom::FrameOptions frame;
    darkroom::WriteOptions write;
    darkroom::DevelopDesc develop;
    std::optional<darkroom::NewSize> size;
    std::optional<double> time, frames_per_second;
    std::optional<StreamDesc> stream;
    long long missing_at_end = 0;  ///< frames that are asked for and not there, behind all that are
    long long step = 1;            ///< from one input's number to the next, where none is missing

    [[nodiscard]] bool is_asked_for(long long number) const { return !frames || frames->contains(number); }
};

darkroom::Failure no_place_for_layers(const std::filesystem::path& output) {
    return user_error(
        fmt::format("--keep-layers: {} holds no layers; .exr does", darkroom::printable(output.string())));
}

/// What of an OpenEXR frame's attributes a picture in OpenEXR does not repeat.
void tell_of_dropped(const darkroom::FrameFile& frame, const std::filesystem::path& output, std::string_view shown) {
    const auto format = darkroom::written_format(output);
    if (!format || *format != &darkroom::exr_format() || !frame.attributes || frame.attributes->dropped().empty())
        return;
    const std::string names = fmt::format("{}", fmt::join(frame.attributes->dropped(), ", "));
    warn(fmt::format("{}: its {} may not be true of a picture made of it, and is left out", shown,
                     darkroom::one_printable_line(names)));
}

/// How many frames that are asked for are missing before each picture, and behind the last. Those that stand in another
/// order than that of their numbers have no gaps.
void count_missing(Job& job) {
    if (!std::ranges::is_sorted(job.steps, {}, &Step::number)) return;
    const std::vector<long long> asked_for = job.frames ? job.frames->numbers() : std::vector<long long>();
    const auto missing = [&](std::optional<long long> before, std::optional<long long> behind) {
        if (!job.frames) return before && behind ? std::max(0LL, (*behind - *before) / job.step - 1) : 0LL;
        const auto first = before ? std::ranges::upper_bound(asked_for, *before) : asked_for.begin();
        const auto last = behind ? std::ranges::lower_bound(asked_for, *behind) : asked_for.end();
        const long long place = before ? *before : *behind;
        return static_cast<long long>(
            std::count_if(first, last, [&](long long number) { return (number - place) % job.step == 0; }));
    };
    std::optional<long long> before;
    for (Step& step : job.steps) {
        if (!step.is_written) continue;
        step.missing = missing(before, step.number);
        before = step.number;
    }
    if (before) job.missing_at_end = missing(before, std::nullopt);
}

/// Streams go on at their pace over frames that are missing, or do not begin.
Result<> check_gaps(const Options& options, Job& job) {
    if (!options.gaps.empty() && options.gaps != "hold" && options.gaps != "stop")
        return user_error(fmt::format("--gaps {}: allowed is hold, stop", darkroom::printable(options.gaps)));
    if (!options.gaps.empty() && !job.stream) return user_error("--gaps: works for -o -, not for files");
    if (!job.stream) return {};
    count_missing(job);
    long long held = 0;
    const auto check = [&](long long missing, std::string_view where, const Step& step) -> Result<> {
        const std::string shown = darkroom::printable(step.input.string());
        if (missing > 0 && options.gaps == "stop")
            return user_error(fmt::format("--gaps stop: {} frames are missing {} {}", missing, where, shown));
        constexpr auto most = static_cast<long long>(max_frames);
        held += std::min(missing, most + 1);
        if (held <= most) return {};
        return user_error(
            fmt::format("--gaps hold: {} frames are missing {} {}, at most {} are held", missing, where, shown, most));
    };
    for (const Step& step : job.steps) DARKROOM_TRY(check(step.missing, "before", step));
    return job.steps.empty() ? Result<>() : check(job.missing_at_end, "behind", job.steps.back());
}

/// The frames that are asked for and are not there yet, each with those before it that histories need.
Result<> add_steps(const Options& options, std::uint32_t pre_roll, Job& job) {
    const std::vector<darkroom::NumberedFile>& inputs = job.inputs;
    const auto is_in_range = [&](long long number) { return job.is_asked_for(number); };
    using Paths = std::vector<std::filesystem::path>;
    Paths also_read = options.look.input_files();
    std::ranges::move(ui_files(job.look), std::back_inserter(also_read));
    DARKROOM_TRY_VALUE(const Paths outputs, job.stream ? Result<Paths>(Paths(inputs.size(), stream_name))
                                                       : output_paths(inputs, job.out, also_read, is_in_range,
                                                                      options.run.missing_folders()));
    if (job.stream) job.develop.target = target_for(job.stream->format);
    if (job.stream && options.keeps_layers) return no_place_for_layers("a stream");
    for (const std::filesystem::path& output : job.stream ? Paths() : outputs) {
        DARKROOM_TRY_VALUE(const darkroom::SampleKind samples, darkroom::sample_kind(output, job.write));
        if (options.keeps_layers && *darkroom::written_format(output) != &darkroom::exr_format())
            return no_place_for_layers(output);
        job.develop.target = target_for(samples, job.write);
        job.develop.color = darkroom::color_of(job.write, samples);
    }
    // Made of the picture before it is rounded.
    if (job.write.has_alpha_of_glow && job.develop.target == darkroom::DevelopTarget::Encoded8)
        job.develop.target = darkroom::DevelopTarget::EncodedFloat;
    if (job.write.alpha) job.develop.color = with_alpha(job.develop.color, job.develop.target, job.write);
    suit(job.look, job.develop.target, job.write);
    if (!job.stream) DARKROOM_TRY(check_codes(job.look, job.develop.target, job.write));
    std::size_t next_written = inputs.size();
    for (std::size_t i = inputs.size(); i-- > 0;) {
        const bool is_asked_for = is_in_range(inputs[i].number);
        const bool is_written = is_asked_for && !options.run.is_skipped(outputs[i]);
        job.skipped += is_asked_for && !is_written ? 1 : 0;
        if (is_written) next_written = i;
        if (next_written < inputs.size() && next_written - i <= pre_roll)
            job.steps.push_back({i, inputs[i].path, outputs[i], inputs[i].number, is_written});
    }
    std::ranges::reverse(job.steps);
    return check_gaps(options, job);
}

/// What is read, and the place of the last one that is asked for.
Result<std::size_t> add_inputs(const Options& options, Job& job) {
    std::vector<std::string> names = options.inputs;
    for (std::string& name : names) name = with_eye(name, job.eye);
    // Files of one eye each have no other.
    if (names != options.inputs) job.frame.view.clear();
    DARKROOM_TRY_VALUE(job.inputs, darkroom::expand_inputs(names));
    job.step = step_of(job.inputs);
    if (options.frames) {
        DARKROOM_TRY_VALUE(job.frames, parse_frames(*options.frames));
    }
    for (std::size_t i = job.inputs.size(); i-- > 0;)
        if (job.is_asked_for(job.inputs[i].number)) {
            // A stream tells of them where it holds a picture in their place.
            if (job.frames && !job.stream) warn_of_missing_inputs(*options.frames, *job.frames, job.inputs);
            return i;
        }
    return user_error(fmt::format("--frames {}: none of the {} inputs has such a number",
                                  darkroom::printable(options.frames.value_or("")), job.inputs.size()));
}

/// What the flags say goes before what the frame says. Frames that cannot be read have none.
std::optional<double> time_of(const Job& job, std::size_t place) {
    if (job.time) return job.time;
    const darkroom::NumberedFile& input = job.inputs[place];
    if (job.frames_per_second) return static_cast<double>(input.number) / *job.frames_per_second;
    const Result<std::optional<double>> time = darkroom::read_frame_time(input.path, job.frame.names);
    return time ? std::optional(time->value_or(0)) : std::nullopt;
}

/// For a gain map a look is developed twice: as it is, and with each peak beyond white at white.
Result<> part_looks(const Options& options, Job& job) {
    if (!options.has_gain_map) return {};
    if (options.is_reference) return user_error("--gain-map: works without --reference");
    if (job.stream) return user_error("--gain-map: works for files, not for a stream");
    if (job.write.space || job.write.view || job.write.alpha)
        return user_error("--gain-map: works without --output-space, --display and --alpha");
    for (const Step& step : job.steps)
        if (const auto format = darkroom::written_format(step.output); !format || !(*format)->has_quality)
            return user_error(
                fmt::format("--gain-map: {} has none; .jpg has", darkroom::printable(step.output.string())));
    darkroom::Look standard = job.look;
    bool is_brighter = false;
    for (darkroom::LookEntry& entry : standard.entries) {
        const darkroom::ParamInfo* const row = entry.effect->parameters.find("peak_nits");
        if (entry.state.enabled.on == 0 || entry.effect->makes == nullptr || row == nullptr) continue;
        const darkroom::ColorState made = entry.effect->makes({}, entry.words.data());
        if (made.domain != darkroom::Domain::DisplayLinear || made.peak_nits <= made.white_nits) continue;
        entry.words[row->word] = std::bit_cast<std::uint32_t>(made.white_nits);
        is_brighter = true;
    }
    if (!is_brighter)
        return user_error(
            "--gain-map: the look ends at white on every display; --tonemap-curve bt2390 "
            "--tonemap-peak-nits 1000 reaches beyond");
    job.brighter = std::move(job.look);
    job.look = std::move(standard);
    suit(*job.brighter, darkroom::DevelopTarget::SceneLinear, job.write);
    return {};
}

/// `eye`: one of those that are asked for.
Result<Job> job_of(const Options& options, const std::string& eye) {
    Job job{.eye = eye, .out = with_eye(options.out, eye)};
    if (options.frame.eyes().size() > 1 && job.out == options.out)
        return user_error(fmt::format("-o {}: two eyes need a name with %V or %v", darkroom::printable(options.out)));
    DARKROOM_TRY(options.run.start_report());
    for (const std::string& input : options.inputs)
        if (darkroom::scene::is_scene_path(input))
            return user_error(
                fmt::format("{}: is no picture; --look takes a look, and `darkroom render` a scene or a model",
                            darkroom::printable(input)));
    if (options.keeps_layers && options.frame.keeps_overscan)
        return user_error("--overscan: works without --keep-layers, which keeps the pixels of the display window only");
    if (options.frame.keeps_overscan && (!options.size.empty() || !options.output_size.empty()))
        return user_error("--overscan: works without --size and --output-size, which know no display window");
    if (!options.output_size.empty() && options.keeps_layers)
        return user_error("--output-size: works without --keep-layers, which keeps layers at the frame's size");
    if (options.is_reference && options.run.has_timings)
        return user_error("--timings: works without --reference, which does not run on the device");
    if (options.time.is_given() && options.frames_per_second.is_given())
        return user_error("--time: --fps sets the time of every frame; give one of the two");
    DARKROOM_TRY(options.time.read_to(job.time));
    DARKROOM_TRY(options.frames_per_second.read_to(job.frames_per_second));
    DARKROOM_TRY(options.write.ocio.check(options.frame.has_input_space()));
    DARKROOM_TRY_VALUE(job.frame, options.frame.options(options.write.ocio.configuration, eye));
    DARKROOM_TRY_VALUE(job.write, options.write.options(options.frame.input_space()));
    DARKROOM_TRY_VALUE(job.stream,
                       options.write.stream(job.out, job.frames_per_second.value_or(stream_frames_per_second)));
    if (job.stream) DARKROOM_TRY(options.run.check_stream());
    DARKROOM_TRY_VALUE(job.jobs, options.run.jobs());
    if (!options.size.empty()) {
        DARKROOM_TRY_VALUE(job.size, parse_new_size(options.size));
    }
    if (!options.output_size.empty()) {
        DARKROOM_TRY_VALUE(job.develop.target_extent, parse_size(options.output_size, "--output-size"));
    }
    DARKROOM_TRY_VALUE(job.develop.kernels, options.device.stage());
    job.develop.fuse = options.device.is_fused();
    job.develop.frames_in_flight = 2;
    DARKROOM_TRY_VALUE(job.look, options.look.look_of_frames());
    DARKROOM_TRY(check_ui_files(job.look));
    if (!options.look.events.empty()) {
        DARKROOM_TRY_VALUE(job.timeline, Timeline::read(options.look.events, job.look));
    }
    const double delta_time = 1 / job.frames_per_second.value_or(usual_frames_per_second);
    DARKROOM_TRY_VALUE(const std::uint32_t pre_roll, add_needs(job.look, delta_time, job.timeline, job.frame));
    job.frame.keeps_halves = !options.is_reference;
    DARKROOM_TRY_VALUE(const std::size_t last, add_inputs(options, job));
    const Motion motion(job.look, job.timeline, [&job](std::size_t place) { return time_of(job, place); });
    DARKROOM_TRY_VALUE(const std::uint32_t moved_pre_roll, motion.pre_roll(job.look, delta_time, last));
    DARKROOM_TRY(add_steps(options, std::max(pre_roll, moved_pre_roll), job));
    DARKROOM_TRY(part_looks(options, job));
    // What is wrong with one is told before any work, unless only its own frame is to fail.
    if (darkroom::has_number_pattern(job.frame.camera_file) && !options.run.keeps_going)
        for (const Step& step : job.steps)
            DARKROOM_TRY(darkroom::read_camera(darkroom::numbered(job.frame.camera_file, step.number)));
    // One file is decoded by all threads, several by one each.
    if (job.steps.size() > 1) job.frame.max_threads = job.write.max_threads = 1;
    return job;
}

class Develop {
  public:
    Develop(const Options& options, Job job) : options_(options), job_(std::move(job)), items_(job_.steps.size()) {
        if (job_.stream) stream_.emplace(*job_.stream);
    }

    Result<> run() {
        const auto pictures = std::ranges::count(job_.steps, true, &Step::is_written);
        RunFlags::tell_of_skipped(job_.skipped, job_.skipped + static_cast<std::size_t>(pictures));
        const Result<> done = run_sequence({.steps = job_.steps.size(),
                                            .pictures = static_cast<std::size_t>(pictures),
                                            .jobs = job_.jobs,
                                            .in_flight = options_.is_reference ? 1U : job_.develop.frames_in_flight,
                                            .keeps_going = options_.run.keeps_going,
                                            .has_timings = options_.run.has_timings},
                                           {.decode = [this](std::size_t i) { return decode(i); },
                                            .begin = [this](std::size_t i) { return begin(i); },
                                            .finish = [this](std::size_t i) { return finish_step(i); },
                                            .encode = [this](std::size_t i) { return encode(i); },
                                            .deliver = [this](std::size_t i) { return deliver(i); },
                                            .made = [this](std::size_t i) { return made(i); },
                                            .release = [this](std::size_t i) { items_[i] = {}; }});
        if (options_.run.has_timings && done) pass_times_.print();
        return done;
    }

    [[nodiscard]] int exit_code(int code) const { return device_ ? app::finish(*device_, code) : code; }

  private:
    /// What a step has while it is under way.
    struct Item {
        darkroom::FrameFile frame;
        std::vector<darkroom::ReferenceLight> lights;
        std::shared_ptr<const std::vector<std::uint8_t>> ui;
        darkroom::DevelopInput input;
        darkroom::DevelopedPicture picture;
        std::shared_ptr<darkroom::Picture> light;  ///< for a gain map
        std::vector<std::byte> packed;             ///< of a stream: what goes out
        VkExtent2D stored{}, extent{};             ///< of the frame in its file, and of the picture
    };

    // The device is made when the first frame has been read: an unreadable one is refused at once.
    Result<> make_composer() {
        const std::lock_guard lock(making_);
        if (composer_) return {};
        DARKROOM_TRY_VALUE(darkroom::Device device,
                           options_.is_reference ? options_.device.create_if_named() : options_.device.create());
        auto made = std::make_unique<darkroom::Device>(std::move(device));
        auto composer = std::make_unique<darkroom::Composer>(
            *made, darkroom::ComposerDesc{.frames_in_flight = job_.develop.frames_in_flight,
                                          .has_timers = options_.run.has_timings});
        DARKROOM_TRY(darkroom::apply(job_.look, *composer, {.keeps = job_.timeline.entries()}));
        developer_ = std::make_unique<darkroom::Developer>(*made, job_.develop);
        if (job_.brighter) {
            brighter_composer_ = std::make_unique<darkroom::Composer>(*made);
            DARKROOM_TRY(darkroom::apply(*job_.brighter, *brighter_composer_, {.keeps = job_.timeline.entries()}));
            darkroom::DevelopDesc desc = job_.develop;
            desc.target = darkroom::DevelopTarget::SceneLinear;
            desc.color.reset();
            desc.frames_in_flight = 1;
            brighter_developer_ = std::make_unique<darkroom::Developer>(*made, desc);
        }
        device_ = std::move(made);
        composer_ = std::move(composer);
        return {};
    }

    [[nodiscard]] std::string shown(std::size_t i) const { return darkroom::printable(job_.steps[i].input.string()); }

    Result<> decode(std::size_t i) {
        const Step& step = job_.steps[i];
        DARKROOM_TRY_VALUE(darkroom::FrameFile frame, read_frame({step.input, step.number}, job_.frame));
        DARKROOM_TRY(make_composer());
        const darkroom::NewSize size = job_.size.value_or(darkroom::NewSize{frame.color.width, frame.color.height})
                                           .of(frame.color.width, frame.color.height);
        if (Result<> done = darkroom::check_extent(*device_, {size.width, size.height}); !done)
            return failure(darkroom::Error{done.error().fault, fmt::format("{}: {}", shown(i), done.error().text)});
        // Alpha that is not kept is a mask at most, as scenes write it.
        const bool has_alpha = job_.write.alpha && frame.has_alpha;
        if (has_alpha && !frame.is_associated) darkroom::associate(frame.color);
        Item& item = items_[i];
        item.stored = {frame.color.width, frame.color.height};
        DARKROOM_TRY_VALUE(darkroom::FrameFile sized, darkroom::resize(std::move(frame), size));
        item.frame = std::move(sized);
        item.lights = take_lights(item.frame);
        item.input = develop_input(item.frame, item.lights);
        item.input.is_color_associated = has_alpha;
        set_time(step, item);
        return {};
    }

    /// What the flags say goes before what the frame says, and that before what its name says.
    void set_time(const Step& step, Item& item) const {
        const auto number = static_cast<std::uint64_t>(std::max(0LL, step.number));
        if (!item.frame.frame_index) item.input.frame_index = number;
        if (job_.time) item.input.time = *job_.time;
        if (!job_.frames_per_second) return;
        item.input.time = static_cast<double>(step.number) / *job_.frames_per_second;
        item.input.delta_time = static_cast<double>(job_.step) / *job_.frames_per_second;
    }

    /// Does motion lead from this one to that which was developed before it?
    [[nodiscard]] bool follows(const Step& step) const {
        if (step.place != next_place_) return false;
        return step.place == 0 || step.number - job_.inputs[step.place - 1].number == job_.step;
    }

    Result<> begin(std::size_t i) {
        Item& item = items_[i];
        for (const std::string& warning : item.frame.warnings) warn(fmt::format("{}: {}", shown(i), warning));
        if (i == 0) {
            tell_of_assumed_view(item.frame, shown(i));
            tell_of_dropped(item.frame, job_.steps[i].output, shown(i));
        }
        item.input.camera.is_cut = !follows(job_.steps[i]);
        next_place_ = job_.steps[i].place + 1;
        DARKROOM_TRY(motion_.advance(*composer_, job_.steps[i].place, item.input.time));
        const VkExtent2D output = job_.develop.target_extent;
        DARKROOM_TRY_VALUE(item.ui, motion_.picture(output.width != 0 ? output : item.input.extent));
        item.input.ui = *item.ui;
        if (options_.is_reference) {
            std::vector<std::string> left_out;
            DARKROOM_TRY_VALUE(item.picture,
                               develop_by_reference(*composer_, item.input, job_.develop, histories_, left_out));
            tell_of_what_is_left_out(i, left_out);
            return {};
        }
        if (job_.brighter) DARKROOM_TRY(develop_brighter(i));
        DARKROOM_TRY(developer_->submit(*composer_, item.input));
        tell_of_what_is_left_out(i, composer_->current_plan()->left_out);
        if (i == 0) warn_of_what_is_misplaced(*composer_->current_plan());
        if (i == 0) tell_of_dim_bloom(*device_, *composer_, job_.look, job_.develop, item.input);
        return {};
    }

    Result<> develop_brighter(std::size_t i) {
        Item& item = items_[i];
        DARKROOM_TRY(brighter_motion_.advance(*brighter_composer_, job_.steps[i].place, item.input.time));
        DARKROOM_TRY_VALUE(darkroom::DevelopedPicture made,
                           brighter_developer_->develop(*brighter_composer_, item.input));
        item.light = std::make_shared<darkroom::Picture>();
        item.light->width = made.extent.width, item.light->height = made.extent.height;
        item.light->pixels = std::move(made.pixels);
        return {};
    }

    /// Where it is not what was left out of the frame before.
    void tell_of_what_is_left_out(std::size_t i, const std::vector<std::string>& left_out) {
        if (last_left_out_ && *last_left_out_ == left_out) return;
        const std::string frame = job_.steps.size() > 1 ? shown(i) + ": " : "";
        const std::size_t told = warn_of_what_is_left_out(job_.look, *composer_, left_out, frame);
        if (told == 0 && last_left_out_) warn(fmt::format("{}nothing is left out any more", frame));
        last_left_out_ = left_out;
    }

    Result<> finish_step(std::size_t i) {
        Item& item = items_[i];
        if (!options_.is_reference) {
            DARKROOM_TRY_VALUE(item.picture, developer_->finish());
            if (options_.run.has_timings) pass_times_.add(composer_->times().passes);
        }
        item.extent = item.picture.extent;
        item.lights = {};
        // A stack may make a picture of another size, which has no such window.
        const bool has_frames_size =
            item.extent.width == item.input.extent.width && item.extent.height == item.input.extent.height;
        if (!has_frames_size) item.frame.display.reset();
        item.frame = {.display = item.frame.display, .attributes = std::move(item.frame.attributes)};
        return {};
    }

    [[nodiscard]] bool is_cropped() const { return job_.size && job_.size->sizing == darkroom::Sizing::Fill; }
    /// By --size, by --output-size, or by a stack that makes a picture of another shape; sizes are rounded to pixels.
    [[nodiscard]] bool is_stretched(const Item& item) const {
        const VkExtent2D frame = item.stored, made = item.extent;
        const std::int64_t difference =
            std::int64_t{made.width} * frame.height - std::int64_t{made.height} * frame.width;
        return !is_cropped() && std::abs(difference) > std::max(frame.width, frame.height);
    }

    Result<> encode(std::size_t i) {
        if (!job_.steps[i].is_written) return {};
        if (stream_) {
            items_[i].packed = stream_->pack(std::exchange(items_[i].picture, {}));
            return {};
        }
        darkroom::WriteOptions options = job_.write;
        options.attributes = items_[i].frame.attributes;
        options.light = std::move(items_[i].light);
        options.is_cropped = is_cropped();
        options.is_stretched = is_stretched(items_[i]);
        if (!job_.size && job_.develop.target_extent.width == 0) options.display = items_[i].frame.display;
        if (options_.keeps_layers) DARKROOM_TRY(keep_layers(i, options));
        return write(job_.steps[i].output, std::move(items_[i].picture), options);
    }

    /// A file of OpenEXR has one set of primaries for all of its channels.
    void warn_of_primaries(std::size_t i, const darkroom::Chromaticities& of_layers,
                           const darkroom::WriteOptions& options) const {
        const darkroom::Result<darkroom::SampleKind> samples = darkroom::sample_kind(job_.steps[i].output, options);
        const std::optional<darkroom::ColorState> color =
            samples ? darkroom::color_of(options, *samples) : std::nullopt;
        const darkroom::Chromaticities of_picture =
            color ? darkroom::chromaticities_of(color->primaries) : darkroom::Chromaticities();
        if (!darkroom::is_near(of_layers, of_picture))
            warn(fmt::format("{}: kept layers in color have the frame's primaries, and the file says the picture's",
                             shown(i)));
    }

    /// Read again, so that only those that are being encoded are in memory.
    Result<> keep_layers(std::size_t i, darkroom::WriteOptions& options) const {
        DARKROOM_TRY_VALUE(darkroom::KeptLayers layers, darkroom::read_kept_layers(job_.steps[i].input, job_.frame));
        for (const std::string& warning : layers.warnings) warn(fmt::format("{}: {}", shown(i), warning));
        if (layers.primaries) warn_of_primaries(i, *layers.primaries, options);
        options.layers = std::make_shared<const darkroom::KeptLayers>(std::move(layers));
        return {};
    }

    Result<> deliver(std::size_t i) {
        if (!stream_ || !job_.steps[i].is_written) return {};
        const std::vector<std::byte>& packed = items_[i].packed;
        // Before the first one there is none to hold but itself.
        DARKROOM_TRY(hold(i, last_packed_.empty() ? packed : last_packed_, job_.steps[i].missing, "before"));
        DARKROOM_TRY(stream_->write(packed, items_[i].extent, shown(i)));
        if (i + 1 == job_.steps.size()) return hold(i, packed, job_.missing_at_end, "behind");
        last_packed_ = has_gaps_ ? std::move(items_[i].packed) : std::vector<std::byte>();
        return {};
    }

    /// In place of frames that are missing beside a step.
    Result<> hold(std::size_t i, std::span<const std::byte> packed, long long missing, std::string_view where) {
        if (missing > 0)
            warn(fmt::format(
                "{} frames are missing {} {}: the stream holds the nearest; --gaps stop refuses such sequences",
                missing, where, shown(i)));
        for (long long held = 0; held < missing; ++held)
            DARKROOM_TRY(stream_->write(packed, items_[i].extent, shown(i)));
        return {};
    }

    [[nodiscard]] std::optional<Made> made(std::size_t i) const {
        const Step& step = job_.steps[i];
        if (!step.is_written) return std::nullopt;
        const auto [width, height] = items_[i].extent;
        return Made{.from = step.input.string(), .to = step.output.string(), .width = width, .height = height};
    }

    const Options& options_;
    Job job_;
    std::vector<Item> items_;
    std::optional<PictureStream> stream_;
    std::mutex making_;
    std::unique_ptr<darkroom::Device> device_;
    std::unique_ptr<darkroom::Composer> composer_, brighter_composer_;
    Motion motion_{job_.look, job_.timeline,  // moves the composer, so it goes first
                   [this](std::size_t place) { return time_of(job_, place); }};
    Motion brighter_motion_{job_.brighter.value_or(darkroom::Look{}), job_.timeline,
                            [this](std::size_t place) { return time_of(job_, place); }};
    std::unique_ptr<darkroom::Developer> developer_, brighter_developer_;
    std::optional<std::vector<std::string>> last_left_out_;
    std::size_t next_place_ = 0;
    /// Of a stream with gaps: the picture before.
    std::vector<std::byte> last_packed_;
    bool has_gaps_ = std::ranges::any_of(job_.steps, [](const Step& step) { return step.missing > 0; });
    darkroom::ReferenceHistories histories_;
    PassTimes pass_times_;
};

int run(const Options& options, const std::string& eye) {
    Result<Job> job = job_of(options, eye);
    if (!job) return fail(job.error());
    tell_of_half_range(job->write);
    Develop develop(options, std::move(*job));
    const Result<> done = develop.run();
    return develop.exit_code(done ? exit_ok : fail(done.error()));
}

/// One eye after the other.
int run(const Options& options) {
    for (const std::string& eye : options.frame.eyes())
        if (const int code = run(options, eye); code != exit_ok) return code;
    return exit_ok;
}

}  // namespace

static Command add_develop(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags command = program.add_command("develop", "Develops HDR frames into finished pictures");
    const auto options = std::make_shared<Options>();
    command.examples(
        "darkroom develop frame.exr --look my.toml --exposure 2 -o picture.png\n"
        "darkroom develop 'shot.####.exr' --frames 1-2 -o 'out.####.png'\n"
        "darkroom develop frame.exr --ssao --no-bloom --tonemap-curve agx -o picture.exr");
    command.add_option("INPUT", options->inputs, "Frames or pictures; ####, %04d or $F4 for all numbers").required();
    command
        .add_option("-o,--output,--out", options->out,
                    fmt::format("The picture: {}. For several inputs a folder, or a name with %04d, #### or "
                                "{{name}}; - is standard output, with --format",
                                darkroom::written_extensions()))
        .type_name("OUT")
        .required();
    command
        .add_option("--size", options->size, "Resamples the frame first, to within this size; :fill, :stretch: to it")
        .type_name("WxH[:fit|fill|stretch]");
    command
        .add_option("--output-size", options->output_size,
                    "Size of the picture of smaller frames, by upscalers or bilinear")
        .type_name("WxH");
    command.add_flag("--keep-layers", options->keeps_layers,
                     "Puts the frame's other layers beside the picture in an .exr file");
    command.add_flag("--gain-map", options->has_gain_map,
                     "Adds to a JPEG what brighter displays show of it (Ultra HDR)");
    command.add_flag("--reference", options->is_reference, "Develops by the CPU references alone, in double precision");
    command.add_option("--frames", options->frames, "Numbers of the inputs to develop: 8, 1-100, 1-100x2, 1,5,9-12")
        .type_name("A-B");
    command.add_option("--gaps", options->gaps, "Of -o -, where one is missing: the nearest, or the end")
        .type_name("hold|stop")
        .default_str("hold");
    options->time.add_to(command, "Time for effects that move; default: the frame's, or 0").type_name("S");
    options->frames_per_second.add_to(command, "Frames a second, for times and motion").type_name("N");
    options->frame.add_to(command);
    options->write.add_to(command);
    options->run.add_to(command);
    options->device.add_to(command);
    options->look.add_to(command, true, named);
    return {command, [options] { return run(*options); },
            [options]() -> Result<> {
                DARKROOM_TRY(job_of(*options, options->frame.eyes().front()));
                return {};
            }};
}

CommandRow develop_command() {
    return {.names = {"develop"}, .place = 20, .add = [](const CommandHost& host) {
                return std::vector{add_develop(host.program, host.named)};
            }};
}

}  // namespace app
