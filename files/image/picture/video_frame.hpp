// SPDX-License-Identifier: MIT
#pragma once
// Encoded pictures as other programs take them through a pipe, one after the other: YUV4MPEG2, or samples alone. It
// writes no file and knows no codec.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

enum class VideoFormat : std::uint8_t {
    Y4m,       ///< YUV4MPEG2: 8 bits, 4:4:4, BT.709 in limited range
    Rgb24,     ///< red, green, blue, 8 bits each
    Rgba64le,  ///< red, green, blue, alpha, 16 bits each, low byte first
};

/// Frames a second as YUV4MPEG2 says it. Rates of television are N * 1000 / 1001.
struct FrameRate {
    std::uint32_t numerator = 24, denominator = 1;
    [[nodiscard]] bool operator==(const FrameRate&) const = default;
};
/// The nearest rate that is a whole number, one of television, or a thousandth. `frames_per_second` is in [0.001, 1e6].
[[nodiscard]] FrameRate frame_rate(double frames_per_second);

/// What stands before the first picture; empty for samples alone.
[[nodiscard]] std::string video_head(VideoFormat format, std::uint32_t width, std::uint32_t height, FrameRate rate);

/// One picture of `rgba`, four bytes a pixel, sRGB-encoded: what y4m and rgb24 are made of. Alpha is dropped. The
/// primaries and the curve of YUV4MPEG2 are nowhere said in it; here they stay those of sRGB.
[[nodiscard]] std::vector<std::byte> video_frame(VideoFormat format, std::span<const std::uint8_t> rgba);
/// One picture of rgba64le: four encoded floats a pixel, clamped to [0, 1]; NaN is 0. Without `alpha` it is opaque.
[[nodiscard]] std::vector<std::byte> video_frame_16(std::span<const float> rgba, bool alpha);

}  // namespace darkroom
