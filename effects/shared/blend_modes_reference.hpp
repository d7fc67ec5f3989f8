// SPDX-License-Identifier: MIT
#pragma once
// The formulas of blend_modes.glsl in double precision, for one channel.

#include <algorithm>
#include <cmath>
#include <darkroom/blend_mode.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline double blend_reference(double base, double layer, BlendMode mode) {
    const auto unit = [](double v) { return std::clamp(v, 0.0, 1.0); };
    const auto screen = [unit](double a, double b) { return a + b - unit(a) * unit(b); };
    switch (mode) {
        case BlendMode::Mix:
            return layer;
        case BlendMode::Add:
            return base + layer;
        case BlendMode::Screen:
            return screen(base, layer);
        case BlendMode::Multiply:
            return base * layer;
        case BlendMode::Lighten:
            return std::max(base, layer);
        case BlendMode::Darken:
            return std::min(base, layer);
        case BlendMode::Difference:
            return std::abs(base - layer);
        case BlendMode::Overlay:
            return base < 0.5 ? 2.0 * base * layer : screen(2.0 * base - 1.0, layer);
        case BlendMode::SoftLight:
            return base + (2.0 * unit(layer) - 1.0) * unit(base) * (1.0 - unit(base));
    }
    return layer;
}

/// Colour only: alpha is the base's.
inline Rgba blend_reference(const Rgba& base, const Rgba& layer, BlendMode mode) {
    return {blend_reference(base.r, layer.r, mode), blend_reference(base.g, layer.g, mode),
            blend_reference(base.b, layer.b, mode), base.a};
}

}  // namespace darkroom
