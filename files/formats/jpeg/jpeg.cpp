// SPDX-License-Identifier: MIT
#include <algorithm>

#include "formats/file_format.hpp"
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/jpeg/jpeg_source.hpp"

namespace darkroom {

const FileFormat& jpeg_format();

namespace {

constexpr std::array<std::string_view, 2> jpeg_extensions{".jpg", ".jpeg"};
constexpr std::array jpeg_samples{SampleKind::Integer8};

/// The first piece of the profile, which holds its name: APP2 "ICC_PROFILE", 0, number, count.
FileFormat::Bytes profile_of_jpeg(FileFormat::Bytes file) {
    constexpr std::string_view mark("ICC_PROFILE\0", 12);
    const auto byte = [&](std::size_t at) { return std::to_integer<std::size_t>(file[at]); };
    for (std::size_t position = 2; file.size() >= position + 4;) {
        const std::size_t marker = byte(position + 1), length = byte(position + 2) << 8 | byte(position + 3);
        constexpr std::size_t start_of_scan = 0xda, second_application = 0xe2;
        if (byte(position) != 0xff || marker == start_of_scan || length < 2 || length > file.size() - position - 2)
            break;
        const FileFormat::Bytes data = file.subspan(position + 4, length - 2);
        if (marker == second_application && data.size() > mark.size() + 2 &&
            std::ranges::equal(data.first(mark.size()), std::as_bytes(std::span(mark))))
            return data.subspan(mark.size() + 2);
        position += length + 2;
    }
    return {};
}

}  // namespace

const FileFormat& jpeg_format() {
    static constexpr FileFormat row{
        .name = "JPEG",
        .extensions = jpeg_extensions,
        .begins = [](std::string_view start) { return start.starts_with("\xff\xd8\xff"); },
        .check = [](FileFormat::Bytes file) -> Result<std::vector<std::byte>> {
            DARKROOM_TRY(check_jpeg(file));
            return std::vector<std::byte>();
        },
        // A bit for each block of 8x8 (ITU-T T.81).
        .least_bytes = [](const FilePart& part) { return double(part.width) * part.height / 64 / 8; },
        .open = [](FileFormat::Bytes file, std::size_t) { return open_jpeg(file); },
        .openimageio = "jpeg",
        .color = [](FileFormat::Bytes file, bool) { return color_of_profile(profile_of_jpeg(file)); },
        .samples = jpeg_samples,
        .has_quality = true,
        .max_side = 65500,  // ITU-T T.81 has 16 bits for a side, libjpeg a little less
    };
    return row;
}

}  // namespace darkroom
