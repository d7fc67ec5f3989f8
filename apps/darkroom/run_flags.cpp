// SPDX-License-Identifier: MIT
#include "run_flags.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

#include "core/param_text.hpp"
#include "device_flags.hpp"

namespace app {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

void WriteFlags::add_to(CLI::App& command) {
    const std::string group = "The files";
    command.add_option("--bits", bits_, "Samples of the file")->type_name("8|16|half|float")->group(group);
    command.add_flag("--alpha", has_alpha_, "Keeps alpha; without it pictures are opaque")->group(group);
    command
        .add_option("--compression", compression_,
                    "EXR: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; TIFF: none, packbits, lzw or zip; "
                    "PNG: [0, 12]")
        ->type_name("NAME")
        ->group(group);
    quality_.add_to(command, "Of JPEG files")->type_name("1-100")->default_str("95")->group(group);
}

Result<darkroom::WriteOptions> WriteFlags::options() const {
    darkroom::WriteOptions out{.alpha = has_alpha_, .compression = compression_};
    if (bits_) {
        const Result<darkroom::SampleKind> bits = parse_bits(*bits_);
        if (!bits) return failure(bits.error());
        out.samples = *bits;
    }
    if (Result<> done = quality_.read_to(out.quality); !done) return failure(std::move(done));
    return out;
}

Result<FrameRange> parse_frames(const std::string& text) {
    FrameRange range;
    const char* const end = text.data() + text.size();
    const auto [dash, first_error] = std::from_chars(text.data(), end, range.first);
    std::errc error = first_error;
    const char* last = dash;
    range.last = range.first;
    if (error == std::errc() && dash != end && *dash == '-') {
        const auto parsed = std::from_chars(dash + 1, end, range.last);
        last = parsed.ptr;
        error = parsed.ec;
    }
    constexpr std::uint64_t most_number = 1'000'000'000;  // what fits a file name and a float file's attributes
    if (error != std::errc() || last != end || range.first > most_number || range.last > most_number)
        return user_error(
            fmt::format("--frames {}: expected A or A-B, whole numbers in [0, {}]", printable(text), most_number));
    if (range.last < range.first)
        return user_error(fmt::format("--frames {}: the last frame is before the first", printable(text)));
    constexpr std::uint64_t most = 100'000;
    if (range.last - range.first >= most)
        return user_error(fmt::format("--frames {}: at most {} frames at once", printable(text), most));
    return range;
}

void RunFlags::add_to(CLI::App& command) {
    const std::string group = "The work";
    jobs_.add_to(command, "Threads that decode and encode files; the pictures are the same whatever it is")
        ->type_name("N")
        ->default_str("processors")
        ->group(group);
    command.add_flag("--skip-existing", skips_existing_, "Pictures that are there already stay as they are")
        ->group(group);
    command
        .add_flag("--keep-going", keeps_going, "A frame that fails does not stop the others; all are listed at the end")
        ->group(group);
    command
        .add_flag(
            "--timings", has_timings,
            "Prints the GPU milliseconds of every pass, and of several frames what each stage took and waited for")
        ->group(group);
}

Result<std::size_t> RunFlags::jobs() const {
    std::size_t out = 0;
    if (Result<> done = jobs_.read_to(out); !done) return failure(std::move(done));
    return out;
}

bool RunFlags::is_skipped(const std::filesystem::path& output) const {
    std::error_code error;
    return skips_existing_ && std::filesystem::is_regular_file(output, error) &&
           std::filesystem::file_size(output, error) > 0 && !error;
}

}  // namespace app
