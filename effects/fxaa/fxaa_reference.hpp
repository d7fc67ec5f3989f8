// SPDX-License-Identifier: MIT
#pragma once
// FXAA in double precision (Timothy Lottes, "FXAA", 2009; quality form of version 3.11, 2011; but that an end is placed
// in the middle of where it may be, and not at the far side). A pixel whose contrast is an edge moves toward its
// neighbour across that edge, by half a pixel where the edge's step ends and by nothing in the step's middle.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/fxaa.hpp>
#include <darkroom/reference.hpp>
#include <span>

#include "shared/light_reference.hpp"

namespace darkroom {

inline double fxaa_reference_luma(const Rgba& color) { return 0.299 * color.r + 0.587 * color.g + 0.114 * color.b; }

/// Distances between the pixels that a search looks at.
inline std::span<const int> fxaa_reference_steps(FxaaQuality quality) {
    static constexpr std::array low{1, 2, 3, 12};
    static constexpr std::array medium{1, 2, 2, 2, 2, 2, 4, 12};
    static constexpr std::array high{1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8};
    static constexpr std::array ultra{1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 4, 8};
    if (quality == FxaaQuality::Low) return low;
    if (quality == FxaaQuality::Medium) return medium;
    return quality == FxaaQuality::High ? std::span<const int>(high) : ultra;
}

/// How far pixel (x, y) moves, and toward which neighbour.
struct FxaaMove {
    int dx = 0, dy = 0;
    double amount = 0;
};

inline FxaaMove fxaa_reference_move(const ReferenceImage& picture, std::int64_t x, std::int64_t y, const Fxaa& fxaa) {
    const auto luma = [&](int dx, int dy) { return fxaa_reference_luma(picture.clamped(x + dx, y + dy)); };
    const double m = luma(0, 0), n = luma(0, -1), s = luma(0, 1), w = luma(-1, 0), e = luma(1, 0);
    const double highest = std::max({m, n, s, w, e}), range = highest - std::min({m, n, s, w, e});
    if (!(range >= std::max(double{fxaa.edge_threshold_min}, highest * double{fxaa.edge_threshold}))) return {};

    const double nw = luma(-1, -1), ne = luma(1, -1), sw = luma(-1, 1), se = luma(1, 1);
    const double mean = (2 * (n + s + w + e) + nw + ne + sw + se) / 12;
    const double t = std::min(std::abs(mean - m) / range, 1.0), lone = t * t * (3 - 2 * t);
    const double blur = lone * lone * double{fxaa.subpixel};

    const auto bend = [](double a, double b, double c) { return std::abs(a - 2 * b + c); };
    const double change_down = bend(nw, w, sw) + 2 * bend(n, m, s) + bend(ne, e, se);
    const double change_right = bend(nw, n, ne) + 2 * bend(w, m, e) + bend(sw, s, se);
    // Often both are equal, by the sum's own symmetry: rounding shall not decide then.
    const bool is_horizontal = change_down >= change_right - 1.0 / 1024;
    const double before = is_horizontal ? n : w, behind = is_horizontal ? s : e;
    const int side = std::abs(before - m) >= std::abs(behind - m) ? -1 : 1;
    const double other = side < 0 ? before : behind, edge = (m + other) / 2;
    const double enough = std::abs(other - m) / 4;

    struct End {
        double distance = 0, difference = 0;
    };
    const auto end_of = [&](int direction) {
        int seen = 0, at = 0;
        double difference = 0;
        for (const int step : fxaa_reference_steps(fxaa.quality)) {
            at += step;
            const int along = direction * at;
            const double inner = is_horizontal ? luma(along, 0) : luma(0, along);
            const double outer = is_horizontal ? luma(along, side) : luma(side, along);
            difference = (inner + outer) / 2 - edge;
            if (std::abs(difference) >= enough) break;
            seen = at;
        }
        // The end is one of the pixels behind the last that is none: it is taken from their middle.
        return End{0.5 * (seen + 1 + at), difference};
    };
    const End first = end_of(-1), second = end_of(1), nearest = first.distance < second.distance ? first : second;
    const bool is_step = (nearest.difference < 0) != (m - edge < 0);
    const double shift = is_step ? 0.5 - nearest.distance / (first.distance + second.distance) : 0.0;
    return {is_horizontal ? 0 : side, is_horizontal ? side : 0, std::max(shift, blur)};
}

inline ReferenceImage fxaa_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const Fxaa& fxaa = *static_cast<const Fxaa*>(parameters);
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const FxaaMove move = fxaa_reference_move(picture, x, y, fxaa);
            if (!(move.amount > 0)) continue;
            const Rgba own = light_reference(picture.at(x, y), input.color);
            const Rgba toward =
                light_reference(picture.clamped(std::int64_t{x} + move.dx, std::int64_t{y} + move.dy), input.color);
            out.at(x, y) = coded_reference(toward_reference(own, own, toward, move.amount), input.color);
        }
    }
    return out;
}

}  // namespace darkroom
