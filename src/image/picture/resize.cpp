// SPDX-License-Identifier: MIT
#include "image/picture/resize.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "image/codec/codecs.hpp"

namespace darkroom {

namespace {

Result<Picture> filtered(Picture& picture, std::uint32_t width, std::uint32_t height) {
    const Result<const Codecs*> library = codecs();
    if (!library) return failure(library.error());
    Picture out(width, height);
    auto done = (*library)->resample({picture.width, picture.height, picture.pixels.data()},
                                     {width, height, out.pixels.data()});
    if (!done) return failure(std::move(done));
    return out;
}

template <std::uint32_t Channels>
Plane<Channels> nearest_pixels(const Plane<Channels>& plane, std::uint32_t width, std::uint32_t height) {
    Plane<Channels> out(width, height);
    for (std::uint32_t y = 0; y < height; ++y) {
        const auto from_y =
            static_cast<std::uint32_t>((2 * std::uint64_t{y} + 1) * plane.height / (2 * std::uint64_t{height}));
        for (std::uint32_t x = 0; x < width; ++x) {
            const auto from_x =
                static_cast<std::uint32_t>((2 * std::uint64_t{x} + 1) * plane.width / (2 * std::uint64_t{width}));
            std::copy_n(plane.at(from_x, from_y), Channels, out.at(x, y));
        }
    }
    return out;
}

}  // namespace

Result<FrameFile> resize(FrameFile frame, std::uint32_t width, std::uint32_t height) {
    if (width == 0 || height == 0)
        return user_error(fmt::format("size {}x{}: a picture has at least 1x1", width, height));
    const std::uint32_t old_width = frame.color.width, old_height = frame.color.height;
    if (width == old_width && height == old_height) return frame;
    widen(frame);
    Result<Picture> color = filtered(frame.color, width, height);
    if (!color) return failure(std::move(color));
    frame.color = std::move(*color);
    if (frame.depth) frame.depth = nearest_pixels(*frame.depth, width, height);
    if (frame.normals) frame.normals = nearest_pixels(*frame.normals, width, height);
    if (frame.velocity) {
        frame.velocity = nearest_pixels(*frame.velocity, width, height);
        const float scale_x = static_cast<float>(width) / static_cast<float>(old_width);
        const float scale_y = static_cast<float>(height) / static_cast<float>(old_height);
        for (std::size_t i = 0; i + 1 < frame.velocity->values.size(); i += 2) {
            frame.velocity->values[i] *= scale_x;
            frame.velocity->values[i + 1] *= scale_y;
        }
    }
    return frame;
}

}  // namespace darkroom
