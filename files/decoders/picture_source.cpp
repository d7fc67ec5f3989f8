// SPDX-License-Identifier: MIT
#include "decoders/picture_source.hpp"

#include <fmt/format.h>

#include <exception>

namespace darkroom {

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
