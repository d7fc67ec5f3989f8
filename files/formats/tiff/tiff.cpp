// SPDX-License-Identifier: MIT
#include "formats/file_format.hpp"
#include "formats/tiff/tiff_check.hpp"
#include "formats/tiff/tiff_source.hpp"

namespace darkroom {

const FileFormat& tiff_format();

namespace {

constexpr std::array<std::string_view, 2> tiff_extensions{".tif", ".tiff"};
constexpr std::array tiff_samples{SampleKind::Integer8, SampleKind::Integer16, SampleKind::Float};
constexpr std::array<std::string_view, 4> tiff_compressions{"none", "packbits", "lzw", "zip"};
constexpr std::array<std::string_view, 4> tiff_starts{std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                                      std::string_view("II+\0", 4), std::string_view("MM\0+", 4)};

}  // namespace

const FileFormat& tiff_format() {
    static constexpr FileFormat row{
        .name = "TIFF",
        .extensions = tiff_extensions,
        .begins =
            [](std::string_view start) {
                for (const std::string_view mark : tiff_starts)
                    if (start.starts_with(mark)) return true;
                return false;
            },
        .check = check_tiff,
        // Deflate makes at most 1032 bytes from one; it may also hold fax runs, hence the smaller claim.
        .least_bytes = [](const FilePart& part) { return double(part.width) * part.height / 8 / 4096; },
        .open = [](FileFormat::Bytes file, std::size_t) { return open_tiff(file); },
        .openimageio = "tiff",
        .color =
            [](FileFormat::Bytes file, bool is_integer) {
                const FileColor found = color_of_profile(profile_of_tiff(file), is_integer);
                return is_integer ? with_exif(found, file) : found;
            },
        .left_out = left_out_of_tiff,
        .samples = tiff_samples,
        .has_alpha = true,
        .compressions = tiff_compressions,
    };
    return row;
}

}  // namespace darkroom
