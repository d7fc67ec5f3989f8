// SPDX-License-Identifier: MIT
#pragma once
// Colour grade in double precision, step by step as its page has it.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <darkroom/effects/color_grade.hpp>
#include <darkroom/reference.hpp>

#include "color_grade/color_grade_white.hpp"
#include "shared/finite_reference.hpp"

namespace darkroom {

/// F. N. Fritsch and J. Butland, "A Method for Constructing Local Monotone Piecewise Cubic Interpolants", 1984: slopes
/// in the points, which never overshoot. At the ends it is that of what lies beyond, 1, as far as it may be.
inline double color_grade_slope(const Curve& curve, std::size_t point) {
    const auto secant = [&](std::size_t i) {
        return (double{curve.y[i + 1]} - double{curve.y[i]}) /
               std::max(double{curve.x[i + 1]} - double{curve.x[i]}, 1e-6);
    };
    const std::size_t last = curve.count - 1;
    if (point == 0 || point == last) return std::clamp(3 * secant(point == 0 ? 0 : last - 1), 0.0, 1.0);
    const double before = secant(point - 1), behind = secant(point);
    if (before * behind <= 0) return 0;
    const double left = double{curve.x[point]} - double{curve.x[point - 1]},
                 right = double{curve.x[point + 1]} - double{curve.x[point]};
    const double a = 2 * right + left, b = right + 2 * left;
    return (a + b) / (a / before + b / behind);
}

/// A monotone cubic between the points; outside, in and out differ by as much as at the end.
inline double color_grade_reference_curve(const Curve& curve, double in) {
    if (curve.count == 0) return in;
    const std::size_t last = curve.count - 1;
    if (in <= double{curve.x[0]}) return in + (double{curve.y[0]} - double{curve.x[0]});
    if (in >= double{curve.x[last]}) return in + (double{curve.y[last]} - double{curve.x[last]});
    std::size_t i = 0;
    while (in > double{curve.x[i + 1]}) ++i;
    const double x = curve.x[i], width = double{curve.x[i + 1]} - x, t = (in - x) / width;
    const double from = curve.y[i], to = curve.y[i + 1];
    // Hermite's form.
    return from * (1 + 2 * t) * (1 - t) * (1 - t) + to * t * t * (3 - 2 * t) +
           width * (color_grade_slope(curve, i) * t * (1 - t) * (1 - t) -
                    color_grade_slope(curve, i + 1) * t * t * (1 - t));
}

inline Rgba color_grade_reference(Rgba color, const ReferencePixel&, const ColorGrade& grade) {
    using namespace color_grade;
    const auto triple = [](const auto& value) { return Triple{double{value.r}, double{value.g}, double{value.b}}; };
    const auto row = [](const Vec3& value) { return Triple{double{value.x}, double{value.y}, double{value.z}}; };
    const auto smoothstep = [](const Vec2& range, double v) {
        const double t = std::clamp((v - double{range.x}) / std::max(double{range.y}, 1e-6), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };

    const Matrix3 mixer{row(grade.mixer_red), row(grade.mixer_green), row(grade.mixer_blue)};
    const Matrix3 balance = white_balance(double{grade.temperature}, double{grade.tint});
    Triple light = product(mixer, product(balance, Triple{finite_reference(color.r), finite_reference(color.g),
                                                          finite_reference(color.b)}));

    const double luminance = dot(luminance_weights, light);
    const double dark = 1 - smoothstep(grade.shadows_range, luminance);
    const double bright = smoothstep(grade.highlights_range, luminance);
    const Triple shadows = triple(grade.shadows), midtones = triple(grade.midtones);
    const Triple highlights = triple(grade.highlights), lift = triple(grade.lift), gamma = triple(grade.gamma);
    const Triple gain = triple(grade.gain);
    const std::array<const Curve*, 3> curves{&grade.curve_red, &grade.curve_green, &grade.curve_blue};
    for (std::size_t i = 0; i < 3; ++i) {
        light[i] *= (shadows[i] * dark + midtones[i] * (1 - dark)) * (1 - bright) + highlights[i] * bright;
        light[i] = std::clamp(light[i] * gain[i] + lift[i], -65536.0, 65536.0);
        // Light below the smallest half float is scaled as that is, and negative light as its mirror image.
        const double magnitude = std::max(std::abs(light[i]), 0x1p-24);
        const double pivot = grade.pivot;
        const double contrasted = pivot * std::pow(std::pow(magnitude, 1 / gamma[i]) / pivot, double{grade.contrast});
        const double stops = color_grade_reference_curve(*curves[i], std::log2(contrasted / 0.18));
        light[i] *= std::min(0.18 * std::exp2(stops), 65536.0) / magnitude;
    }

    light = product(hue_rotation(double{grade.hue}), light);
    const auto [least, most] = std::minmax({light[0], light[1], light[2]});
    const double colorful = most > 0 ? std::min((most - least) / most, 1.0) : 0.0;
    const double scale = double{grade.saturation} * (1 + double{grade.vibrance} * (1 - colorful));
    const double grey = dot(luminance_weights, light);
    return {std::lerp(grey, light[0], scale), std::lerp(grey, light[1], scale), std::lerp(grey, light[2], scale),
            color.a};
}

}  // namespace darkroom
