// SPDX-License-Identifier: MIT
#include "formats/exif.hpp"
#include "formats/file_format.hpp"
#include "formats/webp/webp_check.hpp"
#include "formats/webp/webp_source.hpp"

namespace darkroom {

const FileFormat& webp_format();

namespace {

constexpr std::array<std::string_view, 1> webp_extensions{".webp"};

}  // namespace

const FileFormat& webp_format() {
    static constexpr FileFormat row{
        .name = "WebP",
        .extensions = webp_extensions,
        .begins =
            [](std::string_view start) {
                return start.starts_with("RIFF") && start.size() > 8 && start.substr(8).starts_with("WEBP");
            },
        .check = [](FileFormat::Bytes file) -> Result<std::vector<std::byte>> {
            DARKROOM_TRY(check_webp(file));
            return std::vector<std::byte>();
        },
        // Runs of one colour may cost next to nothing.
        .least_bytes = [](const FilePart& part) { return double(part.width) * part.height / 8 / 4096; },
        .open = [](FileFormat::Bytes file, std::size_t) { return open_webp(file); },
        .openimageio = "webp",
        .color =
            [](FileFormat::Bytes file, bool) {
                const Result<WebpPicture> picture = check_webp(file);
                return picture ? with_exif(color_of_profile(picture->profile), picture->exif) : FileColor();
            },
        .orientation = [](FileFormat::Bytes file, const PictureSource&) -> Result<int> {
            const Result<WebpPicture> picture = check_webp(file);
            return picture ? orientation_of_exif(picture->exif) : 1;
        },
    };
    return row;
}

}  // namespace darkroom
