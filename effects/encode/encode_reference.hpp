// SPDX-License-Identifier: MIT
#pragma once
// The transfer functions in double precision, as their standards have them. NaN counts as 0, and no
// light is beyond the range of half precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/encode.hpp>
#include <darkroom/reference.hpp>

#include "shared/color_state_reference.hpp"
#include "shared/finite_reference.hpp"

namespace darkroom {

inline Rgba encode_reference(Rgba color, const ReferencePixel&, const Encode& parameters) {
    const double white = parameters.white_nits, peak = parameters.peak_nits;
    const std::array<double, 3> light{finite_reference(color.r), finite_reference(color.g), finite_reference(color.b)};
    const auto each = [&color](const std::array<double, 3>& values, auto function) {
        return Rgba{function(values[0]), function(values[1]), function(values[2]), color.a};
    };
    switch (parameters.transfer) {
        case TransferFunction::Srgb:
            return each(light, [](double v) { return srgb_encoded(std::clamp(v, 0.0, 1.0)); });
        case TransferFunction::Gamma22:
            return each(light, [](double v) { return std::pow(std::clamp(v, 0.0, 1.0), 1.0 / 2.2); });
        case TransferFunction::Pq: {
            // ITU-R BT.2087: Rec. 709 primaries in Rec. 2020.
            const auto [r, g, b] = light;
            const std::array<double, 3> wide{0.627403896 * r + 0.329283038 * g + 0.043313066 * b,
                                             0.069097289 * r + 0.919540395 * g + 0.011362316 * b,
                                             0.016391439 * r + 0.088013308 * g + 0.895595253 * b};
            return each(wide, [=](double v) { return pq_encoded(std::clamp(v * white, 0.0, peak) / 10000.0); });
        }
        case TransferFunction::Scrgb:
            return each(light, [=](double v) { return std::clamp(v * white, -peak, peak) / 80.0; });
        case TransferFunction::Hlg:
        case TransferFunction::P3: {
            const bool is_hlg = parameters.transfer == TransferFunction::Hlg;
            const ColorState state{.domain = Domain::Encoded,
                                   .primaries = is_hlg ? Primaries::Rec2020 : Primaries::P3,
                                   .transfer = is_hlg ? Transfer::Hlg : Transfer::Linear,
                                   .white_nits = parameters.white_nits,
                                   .peak_nits = parameters.peak_nits};
            const auto numbers = numbers_of({light[0] * white, light[1] * white, light[2] * white}, state);
            return is_hlg ? each(numbers, [](double v) { return v; })
                          : each(numbers, [](double v) { return srgb_encoded(std::clamp(v, 0.0, 1.0)); });
        }
        case TransferFunction::None:
            break;
    }
    return color;
}

}  // namespace darkroom
