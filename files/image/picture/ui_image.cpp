// SPDX-License-Identifier: MIT
#include "image/picture/ui_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/srgb.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/resize.hpp"

namespace darkroom {

Result<std::vector<std::uint8_t>> read_ui_image(const std::filesystem::path& path, std::uint32_t width,
                                                std::uint32_t height, std::vector<std::string>* warnings) {
    const std::string place = printable(path.string()) + ": ";
    DARKROOM_TRY_VALUE(
        FrameFile frame,
        read_frame(path,
                   {.has_depth = false, .has_normals = false, .has_velocity = false, .has_shadow_depths = false}));
    if (!is_integer(frame.samples))
        return user_error(fmt::format("{}samples are {}: an interface is a picture of integers (PNG, TIFF)", place,
                                      name_of(frame.samples)));
    if (warnings != nullptr)
        for (const std::string& warning : frame.warnings) warnings->push_back(place + warning);
    // Interfaces are laid over codes, so their edges are mixed as codes.
    std::vector<float>& pixels = frame.color.pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (i % 4 != 3) pixels[i] = srgb_encode(std::clamp(pixels[i], 0.0F, 1.0F)) * pixels[i | 3];
    if (frame.color.width != width || frame.color.height != height) {
        FrameFile codes;
        codes.color = std::move(frame.color);
        Result<FrameFile> sized = resize(std::move(codes), {width, height});
        if (!sized) return failure(Error{sized.error().fault, place + sized.error().text});
        frame.color = std::move(sized->color);
    }
    std::vector<std::uint8_t> bytes(frame.color.pixels.size());
    std::ranges::transform(frame.color.pixels, bytes.begin(), [](float value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
    });
    // A filter may leave more colour than alpha: that would be light.
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::min(bytes[i], bytes[i | 3]);
    return bytes;
}

}  // namespace darkroom
