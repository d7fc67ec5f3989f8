// SPDX-License-Identifier: MIT
#include "image/codec/jpeg_check.hpp"

#include <cstdint>

#include "image/exr/check.hpp"

namespace darkroom {

// ITU-T T.81, annex B.1: FF and a code; 00, restarts (D0 to D7), TEM (01) and fill (FF) have no length; after a scan's
// header comes entropy-coded data, in which only FF 00 and restarts occur.
Result<> check_jpeg(std::span<const std::byte> file) {
    constexpr std::uint32_t end_of_image = 0xd9;
    const auto at = [&](std::size_t place) { return std::to_integer<std::uint32_t>(file[place]); };
    std::size_t position = 2;
    while (position + 1 < file.size()) {
        const std::uint32_t code = at(position + 1);
        if (at(position) != 0xff || code == 0xff) {
            ++position;
            continue;
        }
        if (code == end_of_image) return {};
        // B.2.2: the header of a frame has length, precision, height, width and the number of components.
        const bool is_frame = code >= 0xc0 && code <= 0xcf && code != 0xc4 && code != 0xc8 && code != 0xcc;
        if (is_frame && position + 9 < file.size()) {
            const std::uint64_t height = at(position + 5) << 8 | at(position + 6);
            const std::uint64_t width = at(position + 7) << 8 | at(position + 8);
            if (auto checked = check_decoded_size(width * height * at(position + 9), file.size()); !checked)
                return checked;
        }
        const bool has_no_length = code == 0x00 || code == 0x01 || (code >= 0xd0 && code <= 0xd8);
        if (has_no_length || position + 3 >= file.size())
            position += 2;
        else
            position += 2 + (at(position + 2) << 8 | at(position + 3));
    }
    return user_error("truncated: unexpected end of file, no end-of-image marker");
}

}  // namespace darkroom
