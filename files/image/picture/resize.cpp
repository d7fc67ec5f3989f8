// SPDX-License-Identifier: MIT
#include "image/picture/resize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/codec/codecs.hpp"

namespace darkroom {

namespace {

Result<Picture> filtered(Picture& picture, std::uint32_t width, std::uint32_t height) {
    DARKROOM_TRY_VALUE(const Codecs* const library, codecs());
    Picture out(width, height);
    DARKROOM_TRY(
        library->resample({picture.width, picture.height, picture.pixels.data()}, {width, height, out.pixels.data()}));
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

Result<Plane<3>> filtered_plane(const Plane<3>& plane, std::uint32_t width, std::uint32_t height) {
    const auto copy = [](const std::vector<float>& from, std::size_t stride, std::vector<float>& to,
                         std::size_t to_stride) {
        for (std::size_t i = 0; i < from.size() / stride; ++i)
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i * stride), 3,
                        to.begin() + static_cast<std::ptrdiff_t>(i * to_stride));
    };
    Picture picture(plane.width, plane.height);
    copy(plane.values, 3, picture.pixels, 4);
    DARKROOM_TRY_VALUE(const Picture sized, filtered(picture, width, height));
    Plane<3> out(width, height);
    copy(sized.pixels, 4, out.values, 3);
    return out;
}

/// Columns and rows of a plane.
template <class Of>
Of part_of(const Of& plane, std::uint32_t left, std::uint32_t top, std::uint32_t width, std::uint32_t height) {
    Of out(width, height);
    const auto values = static_cast<std::size_t>(out.at(1, 0) - out.at(0, 0));
    for (std::uint32_t y = 0; y < height; ++y) std::copy_n(plane.at(left, top + y), values * width, out.at(0, y));
    return out;
}

/// The middle of a frame, with the ratio of width to height. What the camera saw of the rest is cut off its projection,
/// too, whose first two rows make x and y.
FrameFile cropped(FrameFile frame, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t old_width = frame.color.width, old_height = frame.color.height;
    const double ratio = double(width) / height;
    const auto kept = [](std::uint32_t most, double side) {
        return static_cast<std::uint32_t>(std::clamp(std::lround(side), 1L, long{most}));
    };
    const std::uint32_t new_width = kept(old_width, old_height * ratio);
    const std::uint32_t new_height = kept(old_height, old_width / ratio);
    const std::uint32_t left = (old_width - new_width) / 2, top = (old_height - new_height) / 2;
    if (new_width == old_width && new_height == old_height) return frame;
    widen(frame);
    const auto cut = [&](auto& plane) { plane = part_of(plane, left, top, new_width, new_height); };
    cut(frame.color);
    if (frame.depth) cut(*frame.depth);
    if (frame.normals) cut(*frame.normals);
    if (frame.velocity) cut(*frame.velocity);
    if (frame.reactive) cut(*frame.reactive);
    if (frame.transparency) cut(*frame.transparency);
    for (std::optional<Matrix>* const projection : {&frame.camera.projection, &frame.camera.previous_projection}) {
        if (!*projection) continue;
        const auto narrow = [&](std::size_t row, double old_side, double new_side, double first) {
            const double scale = old_side / new_side, middle = (2 * first + new_side) / old_side - 1;
            for (std::size_t column = 0; column < 4; ++column) {
                float& value = (**projection)[column * 4 + row];
                value = static_cast<float>(scale * (double{value} - middle * double{(**projection)[column * 4 + 3]}));
            }
        };
        narrow(0, old_width, new_width, left);
        narrow(1, old_height, new_height, top);
    }
    return frame;
}

}  // namespace

NewSize NewSize::of(std::uint32_t old_width, std::uint32_t old_height) const {
    if (sizing != Sizing::Fit || old_width == 0 || old_height == 0) return *this;
    const double scale = std::min(double(width) / old_width, double(height) / old_height);
    const auto scaled = [&](std::uint32_t side) {
        return static_cast<std::uint32_t>(std::max(1L, std::lround(side * scale)));
    };
    return {std::min(width, scaled(old_width)), std::min(height, scaled(old_height)), Sizing::Stretch};
}

Result<FrameFile> resize(FrameFile frame, const NewSize& asked_for) {
    const auto [width, height, sizing] = asked_for.of(frame.color.width, frame.color.height);
    if (width == 0 || height == 0)
        return user_error(fmt::format("size {}x{}: a picture has at least 1x1", width, height));
    if (sizing == Sizing::Fill) frame = cropped(std::move(frame), width, height);
    const std::uint32_t old_width = frame.color.width, old_height = frame.color.height;
    if (width == old_width && height == old_height) return frame;
    widen(frame);
    DARKROOM_TRY_VALUE(frame.color, filtered(frame.color, width, height));
    if (frame.reactive) frame.reactive = nearest_pixels(*frame.reactive, width, height);
    if (frame.transparency) {
        DARKROOM_TRY_VALUE(frame.transparency, filtered_plane(*frame.transparency, width, height));
    }
    if (frame.depth) frame.depth = nearest_pixels(*frame.depth, width, height);
    if (frame.normals) frame.normals = nearest_pixels(*frame.normals, width, height);
    const float scale_x = static_cast<float>(width) / static_cast<float>(old_width);
    const float scale_y = static_cast<float>(height) / static_cast<float>(old_height);
    for (auto* const jitter : {&frame.camera.jitter, &frame.camera.previous_jitter})
        if (*jitter) *jitter = {(**jitter)[0] * scale_x, (**jitter)[1] * scale_y};
    if (frame.velocity) {
        frame.velocity = nearest_pixels(*frame.velocity, width, height);
        for (std::size_t i = 0; i + 1 < frame.velocity->values.size(); i += 2) {
            frame.velocity->values[i] *= scale_x;
            frame.velocity->values[i + 1] *= scale_y;
        }
    }
    return frame;
}

}  // namespace darkroom
