// SPDX-License-Identifier: MIT
#include "formats/exr/exr.hpp"

#include "formats/exr/exr_check.hpp"
#include "formats/exr/exr_source.hpp"

namespace darkroom {
namespace {

constexpr std::array<std::string_view, 1> exr_extensions{".exr"};
constexpr std::array exr_samples{SampleKind::Half, SampleKind::Float};

}  // namespace

const FileFormat& exr_format() {
    static constexpr FileFormat row{
        .name = "OpenEXR",
        .extensions = exr_extensions,
        .begins = [](std::string_view start) { return start.starts_with("\x76\x2f\x31\x01"); },
        .check = [](FileFormat::Bytes file) -> Result<std::vector<std::byte>> {
            DARKROOM_TRY(check_exr(file));
            return std::vector<std::byte>();
        },
        .open = [](FileFormat::Bytes file, std::size_t max_threads) { return ExrSource::open(file, max_threads); },
        .openimageio = "openexr",
        .orientation = [](FileFormat::Bytes, const PictureSource&) -> Result<int> { return 1; },
        .samples = exr_samples,
        .has_alpha = true,
        .has_color_space = true,
        .compressions = exr_compressions,
    };
    return row;
}

}  // namespace darkroom
