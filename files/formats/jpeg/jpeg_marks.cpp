// SPDX-License-Identifier: MIT
#include "formats/jpeg/jpeg_marks.hpp"

#include <algorithm>

#include "formats/exif.hpp"

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

}  // namespace

Bytes jpeg_segment(Bytes file, std::size_t application, std::string_view mark) {
    const auto byte = [&](std::size_t at) { return std::to_integer<std::size_t>(file[at]); };
    for (std::size_t position = 2; file.size() >= position + 4;) {
        const std::size_t marker = byte(position + 1), length = byte(position + 2) << 8 | byte(position + 3);
        constexpr std::size_t start_of_scan = 0xda, first_application = 0xe0;
        if (byte(position) != 0xff || marker == start_of_scan || length < 2 || length > file.size() - position - 2)
            break;
        const Bytes data = file.subspan(position + 4, length - 2);
        if (marker == first_application + application && text_of(data).starts_with(mark))
            return data.subspan(mark.size());
        position += length + 2;
    }
    return {};
}

std::string_view xmp_of_jpeg(Bytes file) {
    return text_of(jpeg_segment(file, 1, std::string_view("http://ns.adobe.com/xap/1.0/\0", 29)));
}

std::vector<Bytes> further_jpegs(Bytes file) {
    constexpr std::size_t pictures = 0xb002, entry_bytes = 16;
    const Bytes segment = jpeg_segment(file, 2, std::string_view("MPF\0", 4));
    const TiffTags tags(segment);
    const auto found = tags.find(tags.first_directory(), pictures);
    const auto list = found ? tags.number(found->at, 4) : std::nullopt;
    if (!list) return {};
    const auto head = static_cast<std::size_t>(segment.data() - file.data());
    std::vector<Bytes> out;
    for (std::size_t at = *list; at < *list + found->count && !tags.bytes(at, entry_bytes).empty(); at += entry_bytes) {
        const std::size_t kind = *tags.number(at, 4) & 0xffffffU;
        const std::size_t size = *tags.number(at + 4, 4), offset = *tags.number(at + 8, 4);
        constexpr std::size_t small_copy = 0x010001, smaller_copy = 0x010002;
        // Offsets count from the segment's TIFF head; the first picture has none.
        if (offset == 0 || kind == small_copy || kind == smaller_copy) continue;
        const std::size_t start = std::min(head + offset, file.size());
        out.push_back(file.subspan(start, std::min(size, file.size() - start)));
    }
    return out;
}

FileColor color_of_jpeg(Bytes file) {
    // Of the first piece of the profile, which holds its name: behind its number and their count.
    const Bytes profile = jpeg_segment(file, 2, std::string_view("ICC_PROFILE\0", 12));
    return with_exif(color_of_profile(profile.size() > 2 ? profile.subspan(2) : Bytes()),
                     jpeg_segment(file, 1, std::string_view("Exif\0\0", 6)));
}

}  // namespace darkroom
