// SPDX-License-Identifier: MIT
// Where within the pixel a frame is drawn, for effects that gather frames.

#include <algorithm>
#include <cmath>
#include <darkroom/composer.hpp>

namespace darkroom {

namespace {

/// A whole picture's lines to one: no frame is smaller than that.
constexpr float max_scale = 65536;

float at_least_one(float scale) { return scale >= 1 ? std::min(scale, max_scale) : 1; }

/// Halton, On the efficiency of certain quasi-random sequences of points, 1960: the digits of `index` mirrored at the
/// point.
double radical_inverse(std::uint64_t index, std::uint64_t base) {
    double value = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(index % base);
    }
    return value;
}

}  // namespace

std::array<float, 2> Composer::jitter(std::uint64_t frame_index, float scale) {
    // As many places in each pixel of the output as 8 frames of its own size would give.
    constexpr double places = 8;
    const double square = std::pow(double{at_least_one(scale)}, 2);
    // The first entry of the sequence is 0: a corner of the pixel.
    const std::uint64_t entry = frame_index % static_cast<std::uint64_t>(std::llround(places * square)) + 1;
    return {static_cast<float>(radical_inverse(entry, 2) - 0.5), static_cast<float>(radical_inverse(entry, 3) - 0.5)};
}

float Composer::mip_bias(float scale) { return 0 - std::log2(at_least_one(scale)); }  // not -0

}  // namespace darkroom
