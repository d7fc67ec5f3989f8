// SPDX-License-Identifier: MIT
#include "formats/png/png.hpp"

#include <string>

#include "formats/png/png_check.hpp"
#include "formats/png/png_source.hpp"
#include "formats/png/png_write.hpp"

namespace darkroom {
namespace {

constexpr std::array<std::string_view, 1> png_extensions{".png"};
constexpr std::array png_samples{SampleKind::Integer8, SampleKind::Integer16};
constexpr std::array<std::string_view, 13> png_levels{"0", "1", "2", "3",  "4",  "5", "6",
                                                      "7", "8", "9", "10", "11", "12"};

}  // namespace

const FileFormat& png_format() {
    static constexpr FileFormat row{
        .name = "PNG",
        .extensions = png_extensions,
        .begins = [](std::string_view start) { return start.starts_with("\x89PNG\r\n\x1a\n"); },
        .check = check_png,
        .open = [](FileFormat::Bytes file, std::size_t) { return open_png(file); },
        .openimageio = "png",
        .color = [](FileFormat::Bytes file, bool) { return png_color(file); },
        .left_out = png_left_out,
        .samples = png_samples,
        .has_alpha = true,
        .has_color_space = true,
        .compressions = png_levels,
        .encode = encode_png,
    };
    return row;
}

}  // namespace darkroom
