// SPDX-License-Identifier: MIT
#include "image/picture/finite.hpp"

#include <cmath>

namespace darkroom {
namespace {

constexpr float largest_half = 65504.0f;
constexpr std::uint16_t half_one = 0x3c00;

bool is_nan(std::uint16_t half) { return !is_finite_half(half) && (half & 0x3ffu) != 0; }

}  // namespace

void make_finite(std::span<std::uint16_t> color, PixelCounts& counts) {
    constexpr std::uint16_t largest = 0x7bff;
    for (std::size_t i = 0; i < color.size(); i += 4) {
        std::uint16_t* const pixel = &color[i];
        if (is_finite_half(pixel[0]) && is_finite_half(pixel[1]) && is_finite_half(pixel[2]) &&
            is_finite_half(pixel[3]))
            continue;
        bool has_nan = false;
        bool has_infinity = false;
        for (int c = 0; c < 3; ++c) {
            if (is_finite_half(pixel[c])) continue;
            (is_nan(pixel[c]) ? has_nan : has_infinity) = true;
            pixel[c] = is_nan(pixel[c]) ? std::uint16_t{0} : static_cast<std::uint16_t>((pixel[c] & 0x8000u) | largest);
        }
        counts.nan_color += has_nan;
        counts.infinite_color += has_infinity;
        if (is_finite_half(pixel[3])) continue;
        ++(is_nan(pixel[3]) ? counts.nan_alpha : counts.infinite_alpha);
        pixel[3] = half_one;
    }
}

void make_finite(Picture& color, PixelCounts& counts) {
    for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
        float* pixel = &color.pixels[i];
        bool has_nan = false;
        bool has_infinity = false;
        for (int c = 0; c < 3; ++c) {
            if (std::isfinite(pixel[c])) continue;
            has_nan |= std::isnan(pixel[c]);
            has_infinity |= std::isinf(pixel[c]);
            pixel[c] = std::isnan(pixel[c]) ? 0.0f : std::copysign(largest_half, pixel[c]);
        }
        counts.nan_color += has_nan;
        counts.infinite_color += has_infinity;
        if (std::isfinite(pixel[3])) continue;
        ++(std::isnan(pixel[3]) ? counts.nan_alpha : counts.infinite_alpha);
        pixel[3] = 1.0f;
    }
}

}  // namespace darkroom
