// SPDX-License-Identifier: MIT
#pragma once
// shared/rcas.glsl in double precision (AMD, "FidelityFX Super Resolution 1.0", 2021): c' = (c + l (n + s + w + e)) /
// (1 + 4 l), with l from the published limits, times a strength. One thing is ours: c' stays within what the five span.

#include <algorithm>
#include <array>
#include <darkroom/reference.hpp>
#include <limits>

namespace darkroom {

/// The pixel, and those above, below, left and right of it.
struct RcasPixels {
    Rgba own, n, s, w, e;
};

inline Rgba rcas_reference(const RcasPixels& p, double peak, double strength) {
    constexpr std::array<double Rgba::*, 3> channels{&Rgba::r, &Rgba::g, &Rgba::b};
    double lobe = -std::numeric_limits<double>::infinity();
    for (const auto c : channels) {
        const double low = std::min({p.n.*c, p.s.*c, p.w.*c, p.e.*c}),
                     high = std::max({p.n.*c, p.s.*c, p.w.*c, p.e.*c});
        const double hit_min = high > 0 ? std::max(std::min(low, p.own.*c), 0.0) / (4 * high) : 0;
        const double hit_max = low < peak ? (peak - std::max(high, p.own.*c)) / (4 * low - 4 * peak) : 0;
        lobe = std::max({lobe, -hit_min, hit_max});
    }
    lobe = std::max(-(0.25 - 1.0 / 16), std::min(lobe, 0.0)) * strength;
    Rgba out = p.own;
    for (const auto c : channels) {
        const auto [low, high] = std::minmax({p.n.*c, p.s.*c, p.w.*c, p.e.*c, p.own.*c});
        out.*c = std::clamp((lobe * (p.n.*c + p.s.*c + p.w.*c + p.e.*c) + p.own.*c) / (4 * lobe + 1), low, high);
    }
    return out;
}

}  // namespace darkroom
