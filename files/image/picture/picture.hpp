// SPDX-License-Identifier: MIT
#pragma once
// A picture in main memory: four 32-bit floats a pixel, rows from the top. It knows nothing of files, of colour spaces
// or of the GPU; what the numbers mean (scene-linear, encoded) is said where a picture is made or taken.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace darkroom {

/// Row-major, top row first, red green blue alpha. `pixels.size()` is always `width * height * 4`.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> pixels;

    Picture() = default;
    Picture(std::uint32_t picture_width, std::uint32_t picture_height)
        : width(picture_width), height(picture_height), pixels(std::size_t{picture_width} * picture_height * 4) {}

    [[nodiscard]] bool empty() const { return pixels.empty(); }
    [[nodiscard]] float* at(std::uint32_t x, std::uint32_t y) { return &pixels[(std::size_t{y} * width + x) * 4]; }
    [[nodiscard]] const float* at(std::uint32_t x, std::uint32_t y) const {
        return &pixels[(std::size_t{y} * width + x) * 4];
    }
    [[nodiscard]] bool operator==(const Picture&) const = default;
};

/// `Channels` floats a pixel of something that is no colour: depth (1), velocity (2), normals (3). Same layout as
/// Picture.
template <std::uint32_t Channels>
struct Plane {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> values;

    Plane() = default;
    Plane(std::uint32_t plane_width, std::uint32_t plane_height)
        : width(plane_width), height(plane_height), values(std::size_t{plane_width} * plane_height * Channels) {}

    [[nodiscard]] bool empty() const { return values.empty(); }
    [[nodiscard]] float* at(std::uint32_t x, std::uint32_t y) {
        return &values[(std::size_t{y} * width + x) * Channels];
    }
    [[nodiscard]] const float* at(std::uint32_t x, std::uint32_t y) const {
        return &values[(std::size_t{y} * width + x) * Channels];
    }
    [[nodiscard]] bool operator==(const Plane&) const = default;
};

}  // namespace darkroom
