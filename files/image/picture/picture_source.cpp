// SPDX-License-Identifier: MIT
#include "image/picture/picture_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string_view>

#include "core/files.hpp"
#include "decoders/exr_source.hpp"
#include "image/codec/jpeg_check.hpp"
#include "image/codec/png_check.hpp"
#include "image/codec/tiff_check.hpp"
#include "image/confined/confined_source.hpp"
#include "image/confined/decoder_pool.hpp"
#include "image/exr/check.hpp"
#include "image/webp/check.hpp"

namespace darkroom {
namespace {

/// What a decoder may see of a file, empty: all of it.
Result<std::vector<std::byte>> check_structure(FileKind kind, std::span<const std::byte> bytes) {
    if (kind == FileKind::Png) return check_png(bytes);
    if (kind == FileKind::Tiff) return check_tiff(bytes);
    Result<> checked;
    if (kind == FileKind::OpenExr) checked = check_exr(bytes);
    if (kind == FileKind::Jpeg) checked = check_jpeg(bytes);
    if (kind == FileKind::WebP)
        if (auto picture = check_webp(bytes); !picture) checked = failure(picture.error());
    if (!checked) return failure(std::move(checked));
    return std::vector<std::byte>();
}

// The fewest bytes that a picture of this kind can take, so that a few damaged bytes of header cannot ask for
// gigabytes. TIFF: deflate makes at most 1032 bytes from one; it may also hold fax runs, hence the smaller claim.
// JPEG: a bit for each block of 8x8 (ITU-T T.81). Radiance: 4 bytes a line, and 2 for each run of at most 127 in each
// of the 4 components; lines shorter than 8 or longer than 32767 pixels are not packed.
double smallest_size(FileKind kind, const FilePart& part) {
    const double width = part.width;
    const double height = part.height;
    switch (kind) {
        case FileKind::OpenExr:
        case FileKind::Png:
            return 0;  // check_exr and check_png have seen to it
        case FileKind::Jpeg:
            return width * height / 64 / 8;
        case FileKind::Tiff:
        case FileKind::WebP:  // whose runs of one colour may cost next to nothing
            return width * height / 8 / 4096;
        case FileKind::Radiance:
            return height *
                   (width < 8 || width > 32767 ? 4 * width : 4 + 8 * static_cast<double>((part.width + 126) / 127));
    }
    return 0;
}

Result<> check_size(FileKind kind, const FilePart& part, std::size_t file_size) {
    if (std::max({part.width, part.height, part.display_width, part.display_height}) > max_picture_side)
        return user_error(fmt::format("the picture is {}x{}, at most {} a side is allowed", part.width, part.height,
                                      max_picture_side));
    // Only what would take much memory is refused unread: the decoder knows better what is wrong with a small file.
    constexpr double large = 1 << 22;
    if (static_cast<double>(part.width) * part.height > large &&
        static_cast<double>(file_size) < smallest_size(kind, part))
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
        return ExrSource::open(bytes, max_threads, [bytes, max_threads] {
            return ConfinedSource::open(FileKind::OpenExr, bytes, max_threads);
        });
    } catch (const std::exception& exception) {
        return user_error(
            fmt::format("cannot be read as {}: {}", name_of(FileKind::OpenExr), one_printable_line(exception.what())));
    }
}

}  // namespace

Result<FileKind> kind_of_file(std::span<const std::byte> start) {
    if (start.empty()) return user_error("is empty");
    const std::string_view text(reinterpret_cast<const char*>(start.data()), std::min<std::size_t>(start.size(), 16));
    if (text.starts_with("\x76\x2f\x31\x01")) return FileKind::OpenExr;
    if (text.starts_with("\x89PNG\r\n\x1a\n")) return FileKind::Png;
    if (text.starts_with("\xff\xd8\xff")) return FileKind::Jpeg;
    if (text.starts_with("#?")) return FileKind::Radiance;
    if (text.starts_with("RIFF") && text.substr(std::min<std::size_t>(text.size(), 8)).starts_with("WEBP"))
        return FileKind::WebP;
    const std::string_view tiff = text.substr(0, 4);
    if (tiff == std::string_view("II*\0", 4) || tiff == std::string_view("MM\0*", 4) ||
        tiff == std::string_view("II+\0", 4) || tiff == std::string_view("MM\0+", 4))
        return FileKind::Tiff;
    return user_error("is not a picture of a known format (OpenEXR, PNG, JPEG, TIFF, WebP, Radiance HDR)");
}

Result<std::vector<std::byte>> read_image_file(const std::filesystem::path& path, ReadFileOptions options) {
    options.max_size = max_image_file;
    options.check_start = [](std::span<const std::byte> start) -> Result<> {
        const Result<FileKind> kind = kind_of_file(start);
        return kind ? Result<>() : failure(kind.error());
    };
    return read_file(path, options);
}

Result<OpenedSource> open_source(std::span<const std::byte> bytes, std::size_t max_threads, DecodingPlace place) {
    if (!is_decoding_allowed()) return user_error("decoding of pictures is switched off in this process");
    DARKROOM_TRY_VALUE(const FileKind kind, kind_of_file(bytes));
    DARKROOM_TRY_VALUE(auto cleaned, check_structure(kind, bytes));
    const std::span<const std::byte> seen = cleaned.empty() ? bytes : std::span<const std::byte>(cleaned);
    DARKROOM_TRY_VALUE(auto source, kind == FileKind::OpenExr && place == DecodingPlace::FramesHere
                                        ? open_frame(seen, max_threads)
                                        : ConfinedSource::open(kind, seen, max_threads));
    source->keep(std::move(cleaned));
    for (const FilePart& part : source->parts()) DARKROOM_TRY(check_size(kind, part, bytes.size()));
    return OpenedSource{kind, std::move(source)};
}

}  // namespace darkroom
