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

// ITU-R BT.2100-2, table 5: what a display of 1000 cd/m2 shows of a camera's light. That is 1 at the code 0.75 here,
// and the display's at 203 cd/m2.
void show_hlg(Picture& color) {
    constexpr double system_gamma = 1.2, camera_white = 0.26496256;
    const double white = 1000.0 / 203 * std::pow(camera_white, system_gamma);
    for (std::size_t i = 0; i < color.pixels.size(); i += 4) {
        float* const pixel = &color.pixels[i];
        const double luminance = 0.2627 * double{pixel[0]} + 0.6780 * double{pixel[1]} + 0.0593 * double{pixel[2]};
        const double gain = white * std::pow(std::max(luminance, 0.0), system_gamma - 1);
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = static_cast<float>(std::clamp(gain * double{pixel[c]}, -largest, largest));
    }
}

}  // namespace

void decode(Picture& color, SampleKind samples, const TransferCurve& curve) {
    if (samples == SampleKind::Integer8)
        decode_codes(color, 255, curve);
    else if (samples == SampleKind::Integer16)
        decode_codes(color, 65535, curve);
    else if (!curve.is_linear())
        for (std::size_t i = 0; i < color.pixels.size(); ++i)
            if (i % 4 != 3) color.pixels[i] = decoded_value(curve, color.pixels[i]);
    if (curve.kind == TransferCurve::Kind::Hlg) show_hlg(color);
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
