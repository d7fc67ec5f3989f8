// SPDX-License-Identifier: MIT
#pragma once
// The transfer functions in double precision, as their standards have them. NaN counts as 0, and no
// light is beyond the range of half precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/encode.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom {

/// SMPTE ST 2084:2014, inverse EOTF, for [0, 1] of 10000 cd/m2.
inline double pq_encoded(double light) {
    const double m1 = 2610.0 / 16384.0, m2 = 2523.0 / 4096.0 * 128.0;
    const double c1 = 3424.0 / 4096.0, c2 = 2413.0 / 4096.0 * 32.0, c3 = 2392.0 / 4096.0 * 32.0;
    const double y = std::pow(light, m1);
    return std::pow((c1 + c2 * y) / (1.0 + c3 * y), m2);
}

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
        case TransferFunction::None:
            break;
    }
    return color;
}

}  // namespace darkroom
