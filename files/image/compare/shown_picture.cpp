// SPDX-License-Identifier: MIT
#include "image/compare/shown_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/srgb.hpp"
#include "formats/png/png_write.hpp"
#include "image/picture/resize.hpp"

namespace darkroom {

namespace {

constexpr std::array<float, 4> not_finite{1.0f, 0.0f, 1.0f, 1.0f};
/// In place of one, until the gain is known: no absolute difference is below 0.
constexpr float no_difference = -1.0f;

bool is_finite(const float* pixel) {
    return std::all_of(pixel, pixel + 3, [](float value) { return std::isfinite(value); });
}

/// Two NaNs are alike, as they are to compare().
bool is_same(const float* a, const float* b) {
    return std::equal(a, a + 3, b, [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

Picture shown_picture(Picture picture, PictureEncoding encoding) {
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
        float* const pixel = &picture.pixels[i];
        if (!is_finite(pixel)) {
            std::copy(not_finite.begin(), not_finite.end(), pixel);
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            pixel[c] = std::clamp(pixel[c], 0.0f, 1.0f);
            if (encoding == PictureEncoding::SceneLinear) pixel[c] = srgb_encode(pixel[c]);
        }
        pixel[3] = 1.0f;
    }
    return picture;
}

ShownDifference shown_difference(const Picture& reference, const Picture& test, PictureEncoding encoding) {
    ShownDifference out{.picture = shown_picture(reference, encoding)};
    const Picture shown_test = shown_picture(test, encoding);
    float largest = 0;
    for (std::size_t i = 0; i < out.picture.pixels.size(); i += 4) {
        float* const to = &out.picture.pixels[i];
        const float *const a = &reference.pixels[i], *const b = &test.pixels[i];
        if (is_same(a, b)) {
            std::fill_n(to, 3, 0.0f);
        } else if (is_finite(a) && is_finite(b)) {
            for (std::size_t c = 0; c < 3; ++c) {
                to[c] = std::abs(to[c] - shown_test.pixels[i + c]);
                largest = std::max(largest, to[c]);
            }
        } else {
            to[0] = no_difference;
        }
    }
    constexpr std::uint32_t max_gain = 128;
    while (out.gain < max_gain && largest * static_cast<float>(2 * out.gain) <= 1) out.gain *= 2;
    for (std::size_t i = 0; i < out.picture.pixels.size(); i += 4) {
        float* const pixel = &out.picture.pixels[i];
        if (pixel[0] == no_difference)
            std::copy(not_finite.begin(), not_finite.end(), pixel);
        else
            for (std::size_t c = 0; c < 3; ++c) pixel[c] *= static_cast<float>(out.gain);
    }
    return out;
}

Result<Picture> no_larger_than(Picture picture, std::uint32_t most) {
    const std::uint32_t longer = std::max(picture.width, picture.height);
    if (longer <= most) return picture;
    const auto scaled = [&](std::uint32_t side) {
        return std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::uint64_t{side} * most / longer));
    };
    const std::uint32_t width = scaled(picture.width), height = scaled(picture.height);
    FrameFile frame;
    frame.color = std::move(picture);
    DARKROOM_TRY_VALUE(FrameFile small, resize(std::move(frame), {width, height}));
    return std::move(small.color);
}

Result<std::vector<std::byte>> png_of(const Picture& picture) {
    std::vector<std::uint8_t> codes;
    codes.reserve(picture.pixels.size() / 4 * 3);
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            codes.push_back(static_cast<std::uint8_t>(std::clamp(picture.pixels[i + c], 0.0f, 1.0f) * 255 + 0.5f));
    return encode_png({.width = picture.width, .height = picture.height, .samples = codes.data()});
}

}  // namespace darkroom
