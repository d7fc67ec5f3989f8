// SPDX-License-Identifier: MIT
#pragma once
// Auto exposure in double precision. Pixels are counted in 256 bins, bin = floor(8 (log2 L + 16)), by the weight
// round(15 (1 - k (1 - n^2))), n = 1 - (x^2 + y^2) / 2 with x and y in [-1, 1]. The metered stops m are the mean
// between two percentiles, from middle grey, a bin's pixels being where they are on average; the exposure moves toward
// compensation + curve(m) - clamp(m, darkest, brightest), at constant speed and in the last stop in proportion to what
// is left. A mask multiplies the weight before it is rounded. Metering by a histogram's
// percentiles: Alex Vlachos, "Post Processing in The Orange Box" (2008).

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/auto_exposure.hpp>
#include <darkroom/reference.hpp>
#include <darkroom/resource.hpp>

#include "shared/sample_reference.hpp"

namespace darkroom {

struct AutoExposureBin {
    double count = 0, sum = 0;  ///< of weights, and of the places of the pixels, in bins
};
using AutoExposureBins = std::array<AutoExposureBin, 256>;

/// Of 8 bits; NaN is 0.
inline std::uint8_t auto_exposure_mask_code(float weight) {
    return weight > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(weight, 1.0f))) : std::uint8_t{0};
}

/// The mask as it is sampled; empty: there is none.
inline ReferenceImage auto_exposure_reference_mask(const AutoExposure& parameters, const ReferenceInput& input) {
    const ResourceImage* const picture = find_resource<ResourceImage>(input.resources, parameters.metering_mask);
    if (picture == nullptr) return {};
    ReferenceImage out(picture->width, picture->height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i].r = auto_exposure_mask_code(picture->rgba[4 * i]) / 255.0;
    return out;
}

inline AutoExposureBins auto_exposure_reference_bins(const ReferenceImage& picture, double center_weight,
                                                     const ReferenceImage& mask = {}) {
    AutoExposureBins bins{};
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const Rgba& color = picture.at(x, y);
            const double sum = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
            const double luminance = std::isnan(sum) ? 0 : sum;
            const double place = 8 * (std::log2(std::clamp(luminance, 0x1p-16, 65504.0)) + 16);
            const double right = (2 * x + 1.0) / picture.width - 1, down = (2 * y + 1.0) / picture.height - 1;
            const double near = 1 - (right * right + down * down) / 2;
            const double share = mask.pixels.empty()
                                     ? 1
                                     : sample_reference(mask, (x + 0.5) / picture.width, (y + 0.5) / picture.height).r;
            const double weight = std::floor(15 * (1 - center_weight * (1 - near * near)) * share + 0.5);
            AutoExposureBin& bin = bins[static_cast<std::size_t>(place)];
            bin.count += weight;
            bin.sum += weight * place;
        }
    return bins;
}

/// Mean between the percentiles, in stops from middle grey; 0 where nothing counts.
inline double auto_exposure_reference_meter(const AutoExposureBins& bins, double low, double high) {
    double all = 0, through = 0, sum = 0, moment = 0;
    for (const AutoExposureBin& bin : bins) all += bin.count;
    for (const AutoExposureBin& bin : bins) {
        if (bin.count == 0) continue;
        const double before = through;
        through += bin.count;
        const double part = std::clamp(through, low * all, high * all) - std::clamp(before, low * all, high * all);
        sum += part;
        moment += part * bin.sum / bin.count;
    }
    return all > 0 ? moment / sum / 8 - 16 - std::log2(0.18) : 0;
}

inline double auto_exposure_reference_curve(const Curve& curve, double at) {
    if (curve.count == 0) return 0;
    double result = curve.y[0];
    for (std::uint32_t i = 1; i < curve.count; ++i) {
        const double x = curve.x[i - 1], y = curve.y[i - 1];
        if (at > x) result = std::lerp(y, double{curve.y[i]}, std::min((at - x) / (double{curve.x[i]} - x), 1.0));
    }
    return result;
}

inline double auto_exposure_reference_target(const AutoExposure& parameters, double metered) {
    return parameters.compensation + auto_exposure_reference_curve(parameters.compensation_curve, metered) -
           std::clamp(metered, double{parameters.darkest}, double{parameters.brightest});
}

inline double auto_exposure_reference_moved(const AutoExposure& parameters, double stops, double target,
                                            double seconds) {
    const double way = seconds * double{target < stops ? parameters.speed_up : parameters.speed_down};
    const double left = std::abs(target - stops), steady = std::clamp(left - 1, 0.0, way);
    const double rest = (left - steady) * std::exp(steady - way);
    return target < stops ? target + rest : target - rest;
}

/// The history holds stops in red, and in green those that they move toward.
inline ReferenceImage auto_exposure_reference(const void* parameters, const ReferenceInput& input) {
    const AutoExposure& own = *static_cast<const AutoExposure*>(parameters);
    const double metered =
        auto_exposure_reference_meter(auto_exposure_reference_bins(*input.source, double{own.center_weight},
                                                                   auto_exposure_reference_mask(own, input)),
                                      double{own.low}, double{own.high});
    const double target = auto_exposure_reference_target(own, metered);
    double stops = target;
    if (input.history != nullptr) {
        if (const auto past = input.history->find("adapted"); past != input.history->end())
            stops =
                auto_exposure_reference_moved(own, past->second.at(0, 0).r, past->second.at(0, 0).g, input.delta_time);
        (*input.history)["adapted"] = ReferenceImage(1, 1, {stops, target, metered, 1});
    }
    ReferenceImage out = *input.picture;
    const double factor = std::exp2(stops);
    for (Rgba& pixel : out.pixels) pixel = {pixel.r * factor, pixel.g * factor, pixel.b * factor, pixel.a};
    return out;
}

}  // namespace darkroom
