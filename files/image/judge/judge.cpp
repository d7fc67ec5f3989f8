// SPDX-License-Identifier: MIT
#include "image/judge/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/srgb.hpp"
#include "image/compare/flip.hpp"

namespace darkroom {

namespace {

float code_of(float encoded) { return std::nearbyint(std::clamp(encoded, 0.0F, 1.0F) * 255); }

template <class Map>
ShownCodes mapped(const Picture& picture, const Map& map) {
    ShownCodes out(picture.width, picture.height);
    for (std::size_t i = 0; i < out.values.size() / 3; ++i) map(&picture.pixels[4 * i], &out.values[3 * i]);
    return out;
}

}  // namespace

ShownCodes codes_of_light(const Picture& light) {
    return mapped(light, [](const float* from, float* to) {
        // A comparison with NaN is false.
        std::array<float, 3> rgb{};
        for (std::size_t c = 0; c < 3; ++c) rgb[c] = from[c] > 0 ? std::min(from[c], 65504.0F) : 0;
        const float most = std::max({rgb[0], rgb[1], rgb[2]});
        for (std::size_t c = 0; c < 3; ++c) to[c] = code_of(srgb_encode(rgb[c] / (1 + most)));
    });
}

ShownCodes codes_of_display(const Picture& encoded) {
    return mapped(encoded, [](const float* from, float* to) {
        for (std::size_t c = 0; c < 3; ++c) to[c] = code_of(from[c] > 0 ? from[c] : 0);
    });
}

Picture picture_of(const ShownCodes& codes) {
    Picture out(codes.width, codes.height);
    for (std::size_t i = 0; i < codes.values.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out.pixels[4 * i + c] = codes.values[3 * i + c] / 255;
        out.pixels[4 * i + 3] = 1;
    }
    return out;
}

double ErrorSum::psnr() const {
    if (samples == 0) return std::numeric_limits<double>::quiet_NaN();
    if (squares == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255 * static_cast<double>(samples) / squares);
}

Result<> Judge::add(long long number, const ShownCodes& truth, const ShownCodes& test, const RegionMap& map) {
    DARKROOM_TRY_VALUE(const FlipErrors flip_errors, flip(picture_of(truth), picture_of(test)));
    std::vector<float> error(truth.values.size());
    for (std::size_t i = 0; i < error.size(); ++i) error[i] = test.values[i] - truth.values[i];
    ErrorSum of_frame;
    const bool has_before = error_before_.size() == error.size();
    for (std::size_t pixel = 0; pixel < map.size(); ++pixel) {
        double square = 0, change = 0;
        for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            square += double{error[i]} * double{error[i]};
            if (has_before) change += std::pow(double{error[i]} - double{error_before_[i]}, 2);
        }
        of_frame.add(square, 3);
        if (has_before) verdict_.flicker.add(change, 3);
        for (std::size_t r = 0; r < judged_region_count; ++r) {
            const auto region = static_cast<JudgedRegion>(r);
            if (!map.has(pixel, region)) continue;
            verdict_.regions[r].add(square, 3);
            if (has_before && map_before_.has(pixel, region)) verdict_.region_flicker[r].add(change, 3);
        }
        if (map.age(pixel) < max_recovery_frames) verdict_.recovery[map.age(pixel)].add(square, 3);
    }
    verdict_.error.add(of_frame.squares, of_frame.samples);
    verdict_.frames.push_back({.number = number, .psnr = of_frame.psnr(), .flip = flip_errors.mean});
    flips_ += flip_errors.mean;
    verdict_.flip_mean = flips_ / static_cast<double>(verdict_.frames.size());
    error_before_ = std::move(error);
    map_before_ = map;
    return {};
}

}  // namespace darkroom
