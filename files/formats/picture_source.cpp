// SPDX-License-Identifier: MIT
#include "formats/picture_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace darkroom {

Result<> check_decoded_size(std::uint64_t bytes, std::size_t file_size) {
    constexpr std::uint64_t always_decoded = std::uint64_t{1} << 30, decoded_per_byte = 128;
    const std::uint64_t most = std::max<std::uint64_t>(always_decoded, file_size * decoded_per_byte);
    if (bytes <= most) return {};
    return user_error(fmt::format("its pixels need {} bytes, a file of {} bytes may need {}", bytes, file_size, most));
}

void PictureSource::set_display_window(const PixelWindow& window) {
    for (FilePart& part : parts_) {
        part.x -= window.x, part.y -= window.y;
        part.display_width = window.width, part.display_height = window.height;
    }
}

Result<> PictureSource::read_rows(std::size_t part, std::uint32_t row, std::uint32_t rows,
                                  std::span<const SamplePlace> places) {
    if (places.empty() || rows == 0) return {};
    try {
        return read(part, row, rows, places);
    } catch (const std::exception& exception) {
        return user_error(fmt::format("damaged or truncated: {}", one_printable_line(exception.what())));
    }
}

}  // namespace darkroom
