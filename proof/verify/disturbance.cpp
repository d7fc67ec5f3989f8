// SPDX-License-Identifier: MIT
#include "verify/disturbance.hpp"

#include <algorithm>
#include <cmath>

namespace darkroom::verify {

namespace {

constexpr double far_away = 1e9;

/// -1 or 1.
double side(std::mt19937& random) { return random() % 2 == 0 ? -1 : 1; }

double rounding_side(std::mt19937& random, Disturbance::Toward toward) {
    switch (toward) {
        case Disturbance::Toward::Zero:
            return -1;
        case Disturbance::Toward::Infinity:
            return 1;
        default:
            return side(random);
    }
}

/// Beside the picture's edge there may be black.
double span_around(const ReferenceImage& image, std::uint32_t x, std::uint32_t y, double Rgba::*channel) {
    double low = image.at(x, y).*channel, high = low;
    if (x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height) {
        low = std::min(low, 0.0);
        high = std::max(high, 0.0);
    }
    for (const int dy : {-1, 0, 1})
        for (const int dx : {-1, 0, 1}) {
            const double value = image.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy).*channel;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    return high - low;
}

}  // namespace

ReferenceImage moved(const ReferenceImage& image, std::mt19937& random, const Disturbance& by) {
    ReferenceImage out = image;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (double Rgba::*const channel : {&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a}) {
                const double value = image.at(x, y).*channel;
                if (value > far_away) continue;
                double& number = out.at(x, y).*channel;
                number += by.relative * value * rounding_side(random, by.toward);
                if (by.absolute > 0) number += by.absolute * side(random);
                if (by.filter > 0) number += by.filter * span_around(image, x, y, channel) * side(random);
            }
    return out;
}

}  // namespace darkroom::verify
