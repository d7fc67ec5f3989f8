// SPDX-License-Identifier: MIT
#pragma once
// A bilinear tap in double precision, clamped to the edge: what sample_linear() is in shaders.

#include <cmath>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"

namespace darkroom {

inline Rgba sample_reference(const ReferenceImage& image, double u, double v) {
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const double fx = x - left, fy = y - top;
    const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(top);
    const Rgba a = image.clamped(column, row), b = image.clamped(column + 1, row), c = image.clamped(column, row + 1),
               d = image.clamped(column + 1, row + 1);
    const auto mix = [&](double Rgba::*m) {
        return (a.*m * (1 - fx) + b.*m * fx) * (1 - fy) + (c.*m * (1 - fx) + d.*m * fx) * fy;
    };
    return {mix(&Rgba::r), mix(&Rgba::g), mix(&Rgba::b), mix(&Rgba::a)};
}

/// What warps make of it: NaN counts as 0.
inline Rgba finite_sample_reference(const ReferenceImage& image, double u, double v) {
    const Rgba tap = sample_reference(image, u, v);
    return {finite_reference(tap.r), finite_reference(tap.g), finite_reference(tap.b), finite_reference(tap.a)};
}

}  // namespace darkroom
