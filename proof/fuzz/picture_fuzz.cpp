// SPDX-License-Identifier: MIT
// Pictures of every kind but OpenEXR: what the checks let through, and what the
// decoders of a confined process make of it, here in one process. libpng,
// libjpeg, libtiff and libwebp are not instrumented, ours around them is.

#include <fmt/format.h>

#include <algorithm>

#include "formats/exif.hpp"
#include "formats/exr/exr.hpp"
#include "formats/icc_profile.hpp"
#include "fuzz/target.hpp"
#include "image/picture/picture_source.hpp"

namespace darkroom::fuzz::picture_fuzz {
namespace {

using Opened = Result<std::unique_ptr<PictureSource>>;
constexpr std::uint64_t max_samples = 1 << 20;

std::string wrong_rows(PictureSource& source) {
    const FilePart& part = source.parts().front();
    if (part.channels.empty() || part.kinds.size() != part.channels.size())
        return "a picture has other kinds than channels";
    if (std::uint64_t{part.width} * part.height * part.channels.size() > max_samples) return {};
    std::vector<float> memory(std::size_t{part.width} * part.height * part.channels.size());
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < part.channels.size(); ++i)
        places.push_back({.channel = i,
                          .first = reinterpret_cast<std::byte*>(memory.data() + i),
                          .pixel_bytes = static_cast<std::ptrdiff_t>(part.channels.size() * sizeof(float)),
                          .row_bytes = static_cast<std::ptrdiff_t>(part.width * part.channels.size() * sizeof(float))});
    const Result<> done = source.read_rows(0, 0, part.height, places);
    return done ? std::string() : wrong_error(done.error());
}

std::string run(std::string_view input) {
    const std::span<const std::byte> bytes = bytes_of(input);
    const int orientation = orientation_of_exif(bytes);
    if (orientation < 1 || orientation > 8) return fmt::format("orientation {}", orientation);
    const std::string profile = profile_description(bytes);
    if (std::string wrong = profile.empty() ? std::string() : wrong_line(profile); !wrong.empty()) return wrong;
    const auto format = format_of_file(bytes);
    if (!format || *format == &exr_format()) return {};
    const Result<std::vector<std::byte>> seen = (*format)->check(bytes);
    if (!seen) return wrong_error(seen.error());
    if ((*format)->color != nullptr) static_cast<void>((*format)->color(bytes, true));
    if ((*format)->open == nullptr) return {};
    try {
        const Opened source = (*format)->open(seen->empty() ? bytes : std::span<const std::byte>(*seen), 1);
        if (!source) return wrong_error(source.error());
        return *source == nullptr || (*source)->parts().empty() ? std::string() : wrong_rows(**source);
    } catch (const std::exception&) {
        return {};  // which the process that decodes takes for an error
    }
}

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    for (const char* const end : {".png", ".jpg", ".tif", ".tiff", ".webp", ".hdr"})
        std::ranges::move(files(fmt::format("data/*{}", end)), std::back_inserter(out));
    for (const char* const start : {"\x89PNG\r\n\x1a\n", "\xff\xd8\xff\xe0", "RIFF\4\0\0\0WEBPVP8 ", "#?RADIANCE\n"})
        out.emplace_back(start);
    out.emplace_back(std::string("II*\0\10\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0\0\0\0\0", 26));
    return out;
}

const Registration picture({.name = "picture", .run = run, .seeds = seeds, .longest = 16384, .max_mebibytes = 1100});

}  // namespace
}  // namespace darkroom::fuzz::picture_fuzz
