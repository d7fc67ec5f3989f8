// SPDX-License-Identifier: MIT
#include "image/picture/video_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/assert.hpp"

namespace darkroom {
namespace {

constexpr std::string_view frame_head = "FRAME\n";

/// ITU-R BT.709-6, 3.2 to 3.5, for 8 bits: luma in [16, 235], differences of colour in [16, 240] around 128.
std::array<std::byte, 3> to_bt709(double red, double green, double blue) {
    constexpr double red_weight = 0.2126, blue_weight = 0.0722;
    const double luma = red_weight * red + (1 - red_weight - blue_weight) * green + blue_weight * blue;
    const double cb = (blue - luma) / (2 * (1 - blue_weight)), cr = (red - luma) / (2 * (1 - red_weight));
    const auto code = [](double value) { return static_cast<std::byte>(std::lround(value)); };
    return {code(16 + 219 * luma), code(128 + 224 * cb), code(128 + 224 * cr)};
}

std::vector<std::byte> planes_of(std::span<const std::uint8_t> rgba) {
    const std::size_t pixels = rgba.size() / 4;
    std::vector<std::byte> out(frame_head.size() + 3 * pixels);
    std::ranges::transform(frame_head, out.begin(), [](char c) { return static_cast<std::byte>(c); });
    std::byte* const planes = out.data() + frame_head.size();
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::uint8_t* const pixel = &rgba[4 * i];
        const auto codes = to_bt709(pixel[0] / 255.0, pixel[1] / 255.0, pixel[2] / 255.0);
        for (std::size_t plane = 0; plane < 3; ++plane) planes[plane * pixels + i] = codes[plane];
    }
    return out;
}

}  // namespace

FrameRate frame_rate(double frames_per_second) {
    const auto whole = static_cast<std::uint32_t>(std::lround(frames_per_second));
    if (whole > 0 && std::abs(frames_per_second - whole) < 1e-6 * whole) return {whole, 1};
    // 24000/1001 is 23.97602..., and written as 23.976 or 23.98.
    const auto nominal = static_cast<std::uint32_t>(std::lround(frames_per_second * 1.001));
    const bool is_of_television = nominal % 24 == 0 || nominal % 30 == 0;
    const double error = std::abs(frames_per_second - nominal / 1.001);
    if (nominal > 0 && error < (is_of_television ? 5e-3 : 1e-3)) return {nominal * 1000, 1001};
    return {std::max(1U, static_cast<std::uint32_t>(std::lround(frames_per_second * 1000))), 1000};
}

std::string video_head(VideoFormat format, std::uint32_t width, std::uint32_t height, FrameRate rate) {
    if (format != VideoFormat::Y4m) return {};
    return fmt::format("YUV4MPEG2 W{} H{} F{}:{} Ip A1:1 C444 XCOLORRANGE=LIMITED\n", width, height, rate.numerator,
                       rate.denominator);
}

std::vector<std::byte> video_frame(VideoFormat format, std::span<const std::uint8_t> rgba) {
    DARKROOM_ASSERT(format != VideoFormat::Rgba64le && rgba.size() % 4 == 0);
    if (format == VideoFormat::Y4m) return planes_of(rgba);
    std::vector<std::byte> out;
    out.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) out.push_back(static_cast<std::byte>(rgba[i]));
    return out;
}

std::vector<std::byte> video_frame_16(std::span<const float> rgba, bool alpha) {
    DARKROOM_ASSERT(rgba.size() % 4 == 0);
    std::vector<std::byte> out;
    out.reserve(rgba.size() * 2);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        // The order of the comparison sends NaN to 0.
        const float value = i % 4 == 3 && !alpha ? 1.0f : rgba[i] > 0 ? std::min(rgba[i], 1.0f) : 0.0f;
        const auto code = static_cast<std::uint16_t>(value * 65535.0f + 0.5f);
        out.push_back(static_cast<std::byte>(code & 0xff));
        out.push_back(static_cast<std::byte>(code >> 8));
    }
    return out;
}

}  // namespace darkroom
