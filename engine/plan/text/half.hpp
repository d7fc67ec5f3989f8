// SPDX-License-Identifier: MIT
#pragma once
// Half-precision numbers in main memory, without rounding: what is half already may travel as half. Who has to round
// is in the wrong place here.

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace darkroom {

[[nodiscard]] inline float half_to_float(std::uint16_t half) {
    const float sign = (half & 0x8000U) != 0 ? -1.0F : 1.0F;
    const std::uint32_t exponent = half >> 10U & 0x1fU;
    const std::uint32_t mantissa = half & 0x3ffU;
    if (exponent == 0) return sign * std::ldexp(static_cast<float>(mantissa), -24);
    const std::uint32_t wide = exponent == 0x1fU ? 0xffU : exponent + 112U;
    return std::bit_cast<float>((half & 0x8000U) << 16U | wide << 23U | mantissa << 13U);
}

/// The half with exactly this finite value, or nothing.
[[nodiscard]] inline std::optional<std::uint16_t> exact_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16U & 0x8000U;
    const std::uint32_t magnitude = bits & 0x7fffffffU;
    const auto exponent = static_cast<int>(magnitude >> 23U) - 127;
    if (magnitude == 0) return static_cast<std::uint16_t>(sign);
    if (exponent < -24 || exponent > 15) return std::nullopt;
    if (exponent >= -14) {
        if ((magnitude & 0x1fffU) != 0) return std::nullopt;
        return static_cast<std::uint16_t>(sign | ((magnitude >> 13U) - (112U << 10U)));
    }
    const std::uint32_t significand = (magnitude & 0x7fffffU) | 0x800000U;
    const int shift = -1 - exponent;  // 14 for the largest subnormal exponent, -15
    if ((significand & ((1U << shift) - 1U)) != 0) return std::nullopt;
    return static_cast<std::uint16_t>(sign | significand >> shift);
}

}  // namespace darkroom
