// SPDX-License-Identifier: MIT
#include "formats/jpeg/jpeg_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "formats/exr/exr_check.hpp"

namespace darkroom {
namespace {

struct JpegStream {
    std::uint64_t pixels = 0, samples = 0;  // of its largest frame
    std::uint64_t scans = 0;
    bool has_end = false;
};

// ITU-T T.81, annex B.1: FF and a code; 00, restarts (D0 to D7), TEM (01) and fill (FF) have no length; after a scan's
// header comes entropy-coded data, in which only FF 00 and restarts occur.
JpegStream walk(std::span<const std::byte> stream) {
    constexpr std::uint32_t end_of_image = 0xd9, start_of_scan = 0xda;
    const auto at = [&](std::size_t place) { return std::to_integer<std::uint32_t>(stream[place]); };
    JpegStream out;
    std::size_t position = 2;
    while (position + 1 < stream.size()) {
        const std::uint32_t code = at(position + 1);
        if (at(position) != 0xff || code == 0xff) {
            ++position;
            continue;
        }
        if (code == end_of_image) {
            out.has_end = true;
            return out;
        }
        // B.2.2: the header of a frame has length, precision, height, width and the number of components.
        const bool is_frame = code >= 0xc0 && code <= 0xcf && code != 0xc4 && code != 0xc8 && code != 0xcc;
        if (is_frame && position + 9 < stream.size()) {
            const std::uint64_t height = at(position + 5) << 8 | at(position + 6);
            const std::uint64_t width = at(position + 7) << 8 | at(position + 8);
            out.pixels = std::max(out.pixels, width * height);
            out.samples = std::max(out.samples, width * height * at(position + 9));
        }
        if (code == start_of_scan) ++out.scans;
        const bool has_no_length = code == 0x00 || code == 0x01 || (code >= 0xd0 && code <= 0xd8);
        if (has_no_length || position + 3 >= stream.size())
            position += 2;
        else
            position += 2 + (at(position + 2) << 8 | at(position + 3));
    }
    return out;
}

Result<> add_scans(const JpegStream& stream, std::uint64_t& work) {
    if (stream.scans > JpegScans::max_scans)
        return user_error(
            fmt::format("its picture comes in {} scans, at most {} are allowed", stream.scans, JpegScans::max_scans));
    work += stream.scans * stream.pixels;
    if (work > JpegScans::max_work)
        return user_error(fmt::format("{} scans of {} pixels: scans times pixels may be {}", stream.scans,
                                      stream.pixels, JpegScans::max_work));
    return {};
}

}  // namespace

Result<> JpegScans::add(std::span<const std::byte> stream) { return add_scans(walk(stream), work_); }

Result<> check_jpeg(std::span<const std::byte> file) {
    const JpegStream stream = walk(file);
    DARKROOM_TRY(check_decoded_size(stream.samples, file.size()));
    std::uint64_t work = 0;
    DARKROOM_TRY(add_scans(stream, work));
    if (!stream.has_end) return user_error("truncated: unexpected end of file, no end-of-image marker");
    return {};
}

}  // namespace darkroom
