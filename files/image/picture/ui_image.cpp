// SPDX-License-Identifier: MIT
#include "image/picture/ui_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text/param_text.hpp"
#include "image/picture/picture_numbers.hpp"
#include "image/picture/resize.hpp"

namespace darkroom {
namespace {

Result<> check_samples(const FilePart& part) {
    for (const SampleKind kind : part.kinds)
        if (kind == SampleKind::Half || kind == SampleKind::Float)
            return user_error(
                fmt::format("samples are {}: an interface is a picture of integers (PNG, TIFF)", name_of(kind)));
    return {};
}

}  // namespace

Result<std::vector<std::uint8_t>> read_ui_image(const std::filesystem::path& path, std::uint32_t width,
                                                std::uint32_t height) {
    DARKROOM_TRY_VALUE(ResourceImage image, read_numbers(path, check_samples));
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        for (std::size_t k = 0; k < 3; ++k) image.rgba[i + k] *= image.rgba[i + 3];
    if (image.width != width || image.height != height) {
        FrameFile frame;
        frame.color.width = image.width;
        frame.color.height = image.height;
        frame.color.pixels = std::move(image.rgba);
        Result<FrameFile> sized = resize(std::move(frame), {width, height});
        if (!sized)
            return failure(
                Error{sized.error().fault, fmt::format("{}: {}", printable(path.string()), sized.error().text)});
        image.rgba = std::move(sized->color.pixels);
    }
    std::vector<std::uint8_t> bytes(image.rgba.size());
    std::ranges::transform(image.rgba, bytes.begin(), [](float value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
    });
    // A filter may leave more colour than alpha: that would be light.
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::min(bytes[i], bytes[i | 3]);
    return bytes;
}

}  // namespace darkroom
