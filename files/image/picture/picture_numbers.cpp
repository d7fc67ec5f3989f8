// SPDX-License-Identifier: MIT
#include "image/picture/picture_numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/text/param_text.hpp"
#include "formats/file_format.hpp"
#include "image/picture/alpha.hpp"
#include "image/picture/oriented_source.hpp"

namespace darkroom {
namespace {

Result<ResourceImage> read(std::span<const std::byte> bytes, Result<> (*check)(const FilePart&),
                           std::string* left_out) {
    DARKROOM_TRY_VALUE(const OpenedSource opened, open_upright(bytes));
    if (left_out != nullptr && opened.format->left_out != nullptr) *left_out = opened.format->left_out(bytes);
    const FilePart& part = opened.source->parts().front();
    if (check != nullptr) DARKROOM_TRY(check(part));
    ResourceImage image{part.width, part.height, {}};
    image.rgba.assign(std::size_t{image.width} * image.height * 4, 1.0f);

    const std::size_t count = part.channels.size();
    const std::array<std::size_t, 4> of_colors{0, 1, 2, 3}, of_grey{0, 0, 0, 1};
    const auto& channels = count < 3 ? of_grey : of_colors;
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < 4 && channels[i] < count; ++i)
        places.push_back({.channel = channels[i],
                          .first = reinterpret_cast<std::byte*>(image.rgba.data() + i),
                          .pixel_bytes = 4 * sizeof(float),
                          .row_bytes = static_cast<std::ptrdiff_t>(std::size_t{image.width} * 4 * sizeof(float))});
    DARKROOM_TRY(opened.source->read_rows(0, 0, part.height, places));
    for (float& value : image.rgba)
        if (!std::isfinite(value)) value = 0;
    const bool is_light = part.kinds[0] == SampleKind::Half || part.kinds[0] == SampleKind::Float;
    if (part.is_associated && !is_light) make_straight(image.rgba);
    return image;
}

}  // namespace

Result<ResourceImage> read_numbers(const std::filesystem::path& path, Result<> (*check)(const FilePart&),
                                   std::string* left_out) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, read_image_file(path));
    Result<ResourceImage> image = read(bytes, check, left_out);
    if (!image)
        return failure(Error{image.error().fault, fmt::format("{}: {}", printable(path.string()), image.error().text)});
    return image;
}

}  // namespace darkroom
