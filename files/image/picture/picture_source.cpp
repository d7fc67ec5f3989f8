// SPDX-License-Identifier: MIT
#include "image/picture/picture_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string_view>

#include "core/files.hpp"
#include "formats/exr/exr.hpp"
#include "formats/exr/exr_source.hpp"
#include "image/confined/confined_source.hpp"
#include "image/confined/decoder_pool.hpp"

namespace darkroom {
namespace {

Result<> check_size(const FileFormat& format, const FilePart& part, std::size_t file_size) {
    if (std::max({part.width, part.height, part.display_width, part.display_height}) > max_picture_side)
        return user_error(fmt::format("the picture is {}x{}, at most {} a side is allowed", part.width, part.height,
                                      max_picture_side));
    // Only what would take much memory is refused unread: the decoder knows better what is wrong with a small file.
    constexpr double large = 1 << 22;
    if (static_cast<double>(part.width) * part.height > large && format.least_bytes != nullptr &&
        static_cast<double>(file_size) < format.least_bytes(part))
        return user_error(
            fmt::format("a picture of {}x{} cannot be in a file of {} bytes: truncated, or a damaged header",
                        part.width, part.height, file_size));
    double row_bytes = 0;
    for (const SampleKind sample : part.kinds)
        row_bytes += static_cast<double>(part.width) * static_cast<double>(size_of(sample));
    return check_decoded_size(static_cast<std::uint64_t>(row_bytes * part.height), file_size);
}

/// Of frames of OpenEXR the header is read here, and samples that are packed by ZIP or not at all; see ExrSource.
Result<std::unique_ptr<PictureSource>> open_frame(std::span<const std::byte> bytes, std::size_t max_threads) {
    try {
        return ExrSource::open(bytes, max_threads,
                               [bytes, max_threads] { return ConfinedSource::open(exr_format(), bytes, max_threads); });
    } catch (const std::exception& exception) {
        return user_error(
            fmt::format("cannot be read as {}: {}", exr_format().name, one_printable_line(exception.what())));
    }
}

}  // namespace

Result<const FileFormat*> format_of_file(std::span<const std::byte> start) {
    if (start.empty()) return user_error("is empty");
    const std::string_view text(reinterpret_cast<const char*>(start.data()), std::min<std::size_t>(start.size(), 16));
    for (const FileFormat* const format : all_formats())
        if (format->begins(text)) return format;
    return user_error(fmt::format("is not a picture of a known format ({})", format_names()));
}

Result<std::vector<std::byte>> read_image_file(const std::filesystem::path& path, ReadFileOptions options) {
    options.max_size = max_image_file;
    options.check_start = [](std::span<const std::byte> start) -> Result<> {
        const auto format = format_of_file(start);
        return format ? Result<>() : failure(format.error());
    };
    return read_file(path, options);
}

Result<OpenedSource> open_source(std::span<const std::byte> bytes, std::size_t max_threads, DecodingPlace place) {
    if (!is_decoding_allowed()) return user_error("decoding of pictures is switched off in this process");
    DARKROOM_TRY_VALUE(const FileFormat* const format, format_of_file(bytes));
    DARKROOM_TRY_VALUE(auto cleaned, format->check(bytes));
    const std::span<const std::byte> seen = cleaned.empty() ? bytes : std::span<const std::byte>(cleaned);
    DARKROOM_TRY_VALUE(auto source, format == &exr_format() && place == DecodingPlace::FramesHere
                                        ? open_frame(seen, max_threads)
                                        : ConfinedSource::open(*format, seen, max_threads));
    source->keep(std::move(cleaned));
    for (const FilePart& part : source->parts()) DARKROOM_TRY(check_size(*format, part, bytes.size()));
    return OpenedSource{format, std::move(source)};
}

}  // namespace darkroom
