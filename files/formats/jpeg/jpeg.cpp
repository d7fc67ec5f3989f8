// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "formats/exif.hpp"
#include "formats/file_format.hpp"
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/jpeg/jpeg_source.hpp"

namespace darkroom {

const FileFormat& jpeg_format();

namespace {

constexpr std::array<std::string_view, 2> jpeg_extensions{".jpg", ".jpeg"};
constexpr std::array jpeg_samples{SampleKind::Integer8};

using Bytes = FileFormat::Bytes;

constexpr std::size_t first_application = 0xe1, second_application = 0xe2;

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// What stands behind the first such mark of a segment before the picture, and where in the file.
struct Segment {
    std::size_t at = 0;
    Bytes data;
};
Segment segment_of(Bytes file, std::size_t wanted, std::string_view mark) {
    const auto byte = [&](std::size_t at) { return std::to_integer<std::size_t>(file[at]); };
    for (std::size_t position = 2; file.size() >= position + 4;) {
        const std::size_t marker = byte(position + 1), length = byte(position + 2) << 8 | byte(position + 3);
        constexpr std::size_t start_of_scan = 0xda;
        if (byte(position) != 0xff || marker == start_of_scan || length < 2 || length > file.size() - position - 2)
            break;
        const Bytes data = file.subspan(position + 4, length - 2);
        if (marker == wanted && text_of(data).starts_with(mark))
            return {position + 4 + mark.size(), data.subspan(mark.size())};
        position += length + 2;
    }
    return {};
}

/// Of the first piece of the profile, which holds its name: behind its number and their count.
Bytes profile_of_jpeg(Bytes file) {
    const Bytes data = segment_of(file, second_application, std::string_view("ICC_PROFILE\0", 12)).data;
    return data.size() > 2 ? data.subspan(2) : Bytes();
}

Bytes exif_of_jpeg(Bytes file) { return segment_of(file, first_application, std::string_view("Exif\0\0", 6)).data; }

std::string_view xmp_of_jpeg(Bytes file) {
    return text_of(segment_of(file, first_application, std::string_view("http://ns.adobe.com/xap/1.0/\0", 29)).data);
}

/// CIPA DC-007 (2009), 5.2.3: further pictures, but for smaller copies of the first.
std::vector<Bytes> further_pictures(Bytes file) {
    constexpr std::size_t pictures = 0xb002, entry_bytes = 16;
    const Segment segment = segment_of(file, second_application, std::string_view("MPF\0", 4));
    const TiffTags tags(segment.data);
    const auto found = tags.find(tags.first_directory(), pictures);
    const auto list = found ? tags.number(found->at, 4) : std::nullopt;
    if (!list) return {};
    std::vector<Bytes> out;
    for (std::size_t at = *list; at < *list + found->count && !tags.bytes(at, entry_bytes).empty(); at += entry_bytes) {
        const std::size_t kind = *tags.number(at, 4) & 0xffffffU;
        const std::size_t size = *tags.number(at + 4, 4), offset = *tags.number(at + 8, 4);
        constexpr std::size_t small_copy = 0x010001, smaller_copy = 0x010002;
        // Offsets count from the segment's TIFF head; the first picture has none.
        if (offset == 0 || kind == small_copy || kind == smaller_copy) continue;
        const std::size_t start = std::min(segment.at + offset, file.size());
        out.push_back(file.subspan(start, std::min(size, file.size() - start)));
    }
    return out;
}

/// Of light beyond white: by ISO 21496-1, by Android's "Ultra HDR Image Format", or by Apple.
bool is_gain_map(Bytes picture) {
    const std::string_view xmp = xmp_of_jpeg(picture);
    return xmp.find("hdrgm:Version") != std::string_view::npos ||
           xmp.find("aux:hdrgainmap") != std::string_view::npos ||
           !segment_of(picture, second_application, std::string_view("urn:iso:std:iso:ts:21496:-1\0", 28)).data.empty();
}

std::string left_out_of_jpeg(Bytes file) {
    // Cameras write two or three; each that a list names may be as long as the file.
    constexpr std::size_t max_looked_into = 8;
    const std::vector<Bytes> further = further_pictures(file);
    if (std::ranges::any_of(std::span(further).first(std::min(further.size(), max_looked_into)), is_gain_map))
        return "has a gain map for light beyond white, which is not applied: the picture without it is read";
    return further.empty() ? "" : fmt::format("has {} pictures: the first is read", further.size() + 1);
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
        .color = [](Bytes file,
                    bool) { return with_exif(color_of_profile(profile_of_jpeg(file)), exif_of_jpeg(file)); },
        .left_out = left_out_of_jpeg,
        .samples = jpeg_samples,
        .has_quality = true,
        .max_side = 65500,  // ITU-T T.81 has 16 bits for a side, libjpeg a little less
    };
    return row;
}

}  // namespace darkroom
