// SPDX-License-Identifier: MIT
#include "run_flags.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"
#include "device_flags.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

/// Those of VideoFormat, in its order.
constexpr std::array<std::string_view, 3> format_names{"y4m", "rgb24", "rgba64le"};

}  // namespace

void SpaceFlags::add_to(CommandFlags command, const std::string& group) {
    const Flag name = command
                          .add_option("--output-space", name_,
                                      "Colour space that the picture is for: " + darkroom::output_space_names(", "))
                          .type_name("SPACE");
    const Flag peak =
        peak_.add_to(command, "The display's peak, for pq and hlg").type_name("CD/M2").default_str("1000");
    if (group.empty()) return;
    for (Flag flag : {name, peak}) flag.group(group);
}

Result<std::optional<darkroom::OutputSpace>> SpaceFlags::space() const {
    if (!name_) {
        if (peak_.is_given()) return user_error("--output-peak: needs --output-space pq or hlg");
        return std::optional<darkroom::OutputSpace>();
    }
    Result<darkroom::OutputSpace> space = darkroom::find_output_space(*name_);
    if (!space) return user_error("--output-space: " + space.error().text);
    const bool has_peak = space->integers && space->integers->peak_nits > space->integers->white_nits;
    if (peak_.is_given() && !has_peak)
        return user_error(fmt::format("--output-peak: works for pq and hlg, and not for {}", space->name));
    if (has_peak) DARKROOM_TRY(peak_.read_to(space->integers->peak_nits));
    return std::optional(std::move(*space));
}

void WriteFlags::add_to(CommandFlags command) {
    const std::string group = "The files";
    command.add_option("--bits", bits_, "Samples of the file").type_name("8|16|half|float").group(group);
    space_.add_to(command, group);
    command.add_flag("--alpha", alpha_, "Keeps alpha; --alpha=glow gives one to light over what is transparent")
        .group(group);
    command
        .add_option("--compression", compression_,
                    "EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; TIFF: none, packbits, lzw or zip; "
                    "PNG: [0, 12]")
        .type_name("NAME")
        .group(group);
    command.add_option("--format", format_, "Form of -o -: 8 bits of BT.709 limited, 8 bits, 16 bits")
        .type_name(fmt::format("{}", fmt::join(format_names, "|")))
        .group(group);
    quality_.add_to(command, "Quality of JPEG files").type_name("N").default_str("95").group(group);
    command.add_option("--chroma", chroma_, "Resolution of JPEG's red and blue; default: 4:4:4 from a quality of 90 on")
        .type_name("4:4:4|4:2:2|4:2:0")
        .group(group);
    ocio.add_to(command, true);
}

Result<darkroom::WriteOptions> WriteFlags::options(const std::string& input_space) const {
    if (const bool is_known = alpha_.empty() || alpha_ == "true" || alpha_ == "false" || alpha_ == "glow"; !is_known)
        return user_error(fmt::format("--alpha={}: allowed is glow", printable(alpha_)));
    darkroom::WriteOptions out{
        .alpha = has_alpha(), .has_alpha_of_glow = alpha_ == "glow", .chroma = chroma_, .compression = compression_};
    if (bits_) {
        DARKROOM_TRY_VALUE(out.samples, parse_bits(*bits_));
    }
    DARKROOM_TRY_VALUE(out.space, space_.space());
    DARKROOM_TRY(quality_.read_to(out.quality));
    DARKROOM_TRY_VALUE(out.view, ocio.view(input_space));
    return out;
}

Result<std::optional<StreamDesc>> WriteFlags::stream(const std::string& out, double frames_per_second) const {
    if (!format_) {
        if (out != stream_name) return std::optional<StreamDesc>();
        return user_error(fmt::format("-o -: --format {} is needed", fmt::join(format_names, "|")));
    }
    const auto name = std::ranges::find(format_names, *format_);
    if (name == format_names.end())
        return user_error(
            fmt::format("--format {}: allowed is {}", printable(*format_), fmt::join(format_names, ", ")));
    if (out != stream_name) return user_error(fmt::format("--format {}: works for -o -, not for files", *format_));
    const StreamDesc desc{.format = static_cast<darkroom::VideoFormat>(name - format_names.begin()),
                          .rate = darkroom::frame_rate(frames_per_second),
                          .has_alpha = has_alpha(),
                          .has_alpha_of_glow = alpha_ == "glow"};
    for (const auto& [is_given, flag] :
         {std::pair(bits_.has_value(), "--bits"), std::pair(space_.is_given(), "--output-space"),
          std::pair(!compression_.empty(), "--compression"), std::pair(quality_.is_given(), "--quality"),
          std::pair(!chroma_.empty(), "--chroma"), std::pair(ocio.has_display(), "--display")})
        if (is_given) return user_error(fmt::format("{}: works for files only, not for --format {}", flag, *format_));
    if (has_alpha() && desc.format != darkroom::VideoFormat::Rgba64le)
        return user_error(fmt::format("--alpha: --format {} holds no alpha; rgba64le does", *format_));
    if (isatty(STDOUT_FILENO) != 0) return user_error("-o -: standard output is a terminal, which shows no pictures");
    return desc;
}

Result<darkroom::FrameSet> parse_frames(const std::string& text) {
    const auto refuse = [&](std::string_view why) {
        return user_error(fmt::format("--frames {}: {}", printable(text), why));
    };
    Result<darkroom::FrameSet> frames = darkroom::FrameSet::parse(text);
    if (!frames) return refuse(frames.error().text);
    if (frames->count() > max_frames) return refuse(fmt::format("at most {} frames at once", max_frames));
    return frames;
}

void RunFlags::add_to(CommandFlags command) {
    const std::string group = "The work";
    jobs_.add_to(command, "Threads that decode and encode files").type_name("N").default_str("processors").group(group);
    command.add_flag("--skip-existing", skips_existing_, "Pictures that are there already stay as they are")
        .group(group);
    command
        .add_flag("--keep-going", keeps_going, "A frame that fails does not stop the others; all are listed at the end")
        .group(group);
    command.add_flag("--mkdir", makes_folders_, "Makes the folders of output files that are not there").group(group);
    command.add_option("--progress", progress_, "Form of standard error: text, or a JSON object a line")
        .type_name("text|json")
        .group(group);
    command
        .add_flag("--timings", has_timings, "Prints GPU milliseconds of every pass, and of stages for several frames")
        .group(group);
}

Result<std::size_t> RunFlags::jobs() const {
    std::size_t out = 0;
    DARKROOM_TRY(jobs_.read_to(out));
    return out;
}

Result<> RunFlags::start_report() const {
    if (!progress_ || *progress_ == "text") return {};
    if (*progress_ != "json")
        return user_error(fmt::format("--progress {}: allowed is text, json", printable(*progress_)));
    report_as_json();
    return {};
}

Result<> RunFlags::check_stream() const {
    for (const auto& [is_given, flag] :
         {std::pair(skips_existing_, "--skip-existing"), std::pair(keeps_going, "--keep-going")})
        if (is_given) return user_error(fmt::format("{}: a stream has no gaps; with -o - leave the flag out", flag));
    return {};
}

void RunFlags::tell_of_skipped(std::size_t skipped, std::size_t asked_for) {
    if (skipped > 0) tell(fmt::format("{} of {} pictures are there already", skipped, asked_for));
}

bool RunFlags::is_skipped(const std::filesystem::path& output) const { return skips_existing_ && is_there(output); }

}  // namespace app
