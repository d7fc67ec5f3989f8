// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <optional>

#include "formats/file_format.hpp"
#include "formats/jpeg/gain_map.hpp"
#include "formats/jpeg/jpeg_check.hpp"
#include "formats/jpeg/jpeg_marks.hpp"
#include "formats/jpeg/jpeg_source.hpp"

namespace darkroom {

const FileFormat& jpeg_format();

namespace {

constexpr std::array<std::string_view, 2> jpeg_extensions{".jpg", ".jpeg"};
constexpr std::array jpeg_samples{SampleKind::Integer8};

using Bytes = FileFormat::Bytes;

Result<std::vector<std::byte>> check_all(Bytes file) {
    DARKROOM_TRY(check_jpeg(file));
    if (const std::optional<GainMap> map = find_gain_map(file).map)
        if (const Result<> done = check_jpeg(map->picture); !done)
            return user_error("its gain map: " + done.error().text);
    return std::vector<std::byte>();
}

FileColor color_of_all(Bytes file, bool is_integer) {
    FileColor out = color_of_jpeg(file);
    if (is_integer) return out;
    const GainMap map = find_gain_map(file).map.value_or(GainMap{});
    out.coding = ColorCoding{map.result, {}};
    out.said += fmt::format("{}gain map ({})", out.said.empty() ? "" : ", ", map.said);
    return out;
}

std::string left_out_of_jpeg(Bytes file) {
    const FoundGainMap found = find_gain_map(file);
    if (found.map) return "";
    if (!found.why_not.empty())
        return fmt::format(
            "has a gain map for light beyond white, which is not applied, since {}: the picture without it is read",
            found.why_not);
    const std::size_t further = further_jpegs(file).size();
    return further == 0 ? "" : fmt::format("has {} pictures: the first is read", further + 1);
}

}  // namespace

const FileFormat& jpeg_format() {
    static constexpr FileFormat row{
        .name = "JPEG",
        .extensions = jpeg_extensions,
        .begins = [](std::string_view start) { return start.starts_with("\xff\xd8\xff"); },
        .check = check_all,
        // A bit for each block of 8x8 (ITU-T T.81).
        .least_bytes = [](const FilePart& part) { return double(part.width) * part.height / 64 / 8; },
        .open = [](FileFormat::Bytes file, std::size_t) { return open_jpeg(file); },
        .openimageio = "jpeg",
        .color = color_of_all,
        .left_out = left_out_of_jpeg,
        .samples = jpeg_samples,
        .has_quality = true,
        .max_side = 65500,  // ITU-T T.81 has 16 bits for a side, libjpeg a little less
    };
    return row;
}

}  // namespace darkroom
