// SPDX-License-Identifier: MIT
#include "image/color/convert_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace darkroom {
namespace {

constexpr double largest = std::numeric_limits<float>::max();

float decoded_value(const TransferCurve& curve, float value) {
    return static_cast<float>(std::clamp(curve.decode(double{value}), -largest, largest));
}

// Every code of an 8- or 16-bit file decoded once; a picture has more pixels than there are codes. What was divided by
// alpha lies between codes, and above the last one where light is added that covers nothing.
void decode_codes(Picture& color, float last_code, const TransferCurve& curve) {
    std::vector<float> decoded(static_cast<std::size_t>(last_code) + 1);
    for (std::size_t code = 0; code < decoded.size(); ++code)
        decoded[code] = static_cast<float>(curve.decode(static_cast<double>(code) / double{last_code}));
    for (std::size_t i = 0; i < color.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        const float code = color.pixels[i] * last_code, nearest = std::round(code);
        const bool is_code = nearest >= 0 && nearest <= last_code && std::abs(code - nearest) < 1e-2f;
        color.pixels[i] = is_code ? decoded[static_cast<std::size_t>(nearest)] : decoded_value(curve, color.pixels[i]);
    }
}

}  // namespace

void decode(Picture& color, SampleKind samples, const TransferCurve& curve) {
    if (samples == SampleKind::Integer8) return decode_codes(color, 255, curve);
    if (samples == SampleKind::Integer16) return decode_codes(color, 65535, curve);
    if (curve.is_linear()) return;
    for (std::size_t i = 0; i < color.pixels.size(); ++i)
        if (i % 4 != 3) color.pixels[i] = decoded_value(curve, color.pixels[i]);
}

void convert(Picture& color, const ColorMatrix& matrix) {
    for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
        float* const pixel = &color.pixels[i];
        const std::array<double, 3> in{pixel[0], pixel[1], pixel[2]};
        if (!std::ranges::all_of(in, [](double value) { return std::isfinite(value); })) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = matrix[c * 3] * in[0] + matrix[c * 3 + 1] * in[1] + matrix[c * 3 + 2] * in[2];
            pixel[c] = static_cast<float>(std::clamp(value, -largest, largest));
        }
    }
}

}  // namespace darkroom
