// SPDX-License-Identifier: MIT
#pragma once
// ACES 1.3, Reference Gamut Compression (Academy of Motion Picture Arts and Sciences,
// LMT.Academy.ReferenceGamutCompress and the technical documentation of the gamut mapping group, 2021), in double
// precision, in the primaries of a display in place of AP1. NaN counts as 0.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/gamut_compression.hpp>
#include <darkroom/reference.hpp>
#include <tuple>

#include "shared/color_state_reference.hpp"
#include "shared/finite_reference.hpp"

namespace darkroom {

/// Of the distance from grey, which is 1 on the gamut's edge.
inline double gamut_compression_curve(double distance, double limit, double threshold, double power) {
    if (distance < threshold) return distance;
    const double scale =
        (limit - threshold) / std::pow(std::pow((1 - threshold) / (limit - threshold), -power) - 1, 1 / power);
    const double over = (distance - threshold) / scale;
    return threshold + scale * over / std::pow(1 + std::pow(over, power), 1 / power);
}

inline Rgba gamut_compression_reference(Rgba color, const ReferencePixel&, const GamutCompression& parameters) {
    using namespace color_state_detail;
    Color light{finite_reference(color.r), finite_reference(color.g), finite_reference(color.b)};
    if (parameters.into == GamutCompressionInto::P3) light = multiplied(p3, light);
    if (parameters.into == GamutCompressionInto::Rec2020) light = multiplied(rec2020, light);
    const double achromatic = std::max({light[0], light[1], light[2]});
    const auto compressed = [&](double value, float limit, float threshold) {
        if (achromatic == 0) return value;
        const double distance = (achromatic - value) / std::abs(achromatic);
        return achromatic -
               gamut_compression_curve(distance, double{limit}, double{threshold}, double{parameters.power}) *
                   std::abs(achromatic);
    };
    const auto& [limit, threshold] = std::tie(parameters.limit, parameters.threshold);
    light = {compressed(light[0], limit.x, threshold.x), compressed(light[1], limit.y, threshold.y),
             compressed(light[2], limit.z, threshold.z)};
    if (parameters.into == GamutCompressionInto::P3) light = solved(p3, light);
    if (parameters.into == GamutCompressionInto::Rec2020) light = solved(rec2020, light);
    return {light[0], light[1], light[2], color.a};
}

}  // namespace darkroom
