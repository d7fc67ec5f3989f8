// SPDX-License-Identifier: MIT
#pragma once
// The lens in numbers: what the passes and the reference are told of it.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/depth_of_field.hpp>
#include <darkroom/frame.hpp>
#include <numbers>

namespace darkroom {

/// Radius of a point's circle at infinity, in pixels of a picture of this height, and the distance that is sharp. At a
/// distance d the radius is infinity (1 - focus / d): half of A |d - F| / d * f / (F - f) * height / sensor, with the
/// focal length f, the aperture's diameter A = f / f_stop and F the distance (Potmesil and Chakravarty, "A Lens and
/// Aperture Camera Model for Synthetic Image Generation", 1981, equation 3).
struct ThinLens {
    double infinity = 0, focus = 1;
};

[[nodiscard]] inline ThinLens depth_of_field_lens(const DepthOfField& field, const Camera& camera, double height) {
    const double sensor = double{field.sensor_height} / 1000;
    const double focal = sensor / 2 * std::abs(double{camera.projection[5]});
    // Nothing nearer than the focal length can be sharp.
    const double focus = std::max(double{field.focus_distance}, focal * 1.01);
    const double aperture = focal / double{field.f_stop};
    return {aperture / 2 * focal / (focus - focal) * height / sensor, focus};
}

/// In dioptres: the nearest and the farthest that a lens focuses at by itself, and from where on it moves the slower
/// the nearer it is to what it moves toward. It takes the middle one of so many by so many distances about a place,
/// lest a leaf or a gap count.
inline constexpr double autofocus_nearest = 10, autofocus_farthest = 1e-5, autofocus_slow = 0.1;
inline constexpr std::uint32_t autofocus_side = 5;

/// The thin lens for a distance that the GPU knows: focused at D dioptres, the radius of a circle at a distance d is
/// strength / (1 - focal D) (D - 1 / d) pixels.
struct AutofocusLens {
    double strength = 0, focal = 0;
    double nearest = autofocus_nearest;  ///< dioptres
};

[[nodiscard]] inline AutofocusLens autofocus_lens(const DepthOfField& field, const Camera& camera, double height) {
    const double sensor = double{field.sensor_height} / 1000;
    const double focal = sensor / 2 * std::abs(double{camera.projection[5]});
    return {.strength = focal / double{field.f_stop} / 2 * focal * height / sensor,
            .focal = focal,
            .nearest = 1 / (focal * 1.01)};
}

/// What the passes blur by themselves, as a circle whose radius has the square `own` does, in texels of `step` pixels,
/// and from which radius on something counts as blurred. Radii are in texels.
struct DepthOfFieldBlur {
    double step = 1, own = 0, least = 0.01, to = 1, slope = 1;
    /// What is left to blur of a circle of the near field: variances are subtracted where they are large enough, in a
    /// smooth way. Up to half a pixel nothing is, so that what is sharp covers nothing beside itself.
    [[nodiscard]] double left(double radius) const {
        return full(radius) * std::clamp(2 * radius * step - 1, 0.0, 1.0);
    }
    [[nodiscard]] double full(double radius) const {
        const double rest = radius * radius - own;
        return std::sqrt(0.5 * (rest + std::hypot(rest, own)));
    }
    /// The same of the far field, where smaller circles are made of the pixels around.
    [[nodiscard]] double left_behind(double radius) const {
        return radius * step < 2 ? 0 : std::sqrt(std::max(radius * radius - own, 0.001));
    }
    /// How much of what is blurred is laid over the sharp picture: nearly the share of the circle's variance in that of
    /// what is blurred so, by which a point is spread as the circle does.
    [[nodiscard]] double weight(double left) const {
        const double missing = std::clamp((to - left) * slope, 0.0, 1.0);
        return 1 - missing * missing;
    }
    /// The same over what is made of the pixels around.
    [[nodiscard]] double weight_behind(double radius) const {
        return std::clamp((radius * step - 2.5) * 1.2, 0.0, 1.0);
    }
};
[[nodiscard]] inline DepthOfFieldBlur depth_of_field_blur(std::uint32_t step) {
    // The variance of a disc is a quarter of its radius squared. That of samples at the nearest texel is 1/12; of half
    // a size it is 1/16, the mean of two by two pixels, and 3/16, the bilinear mix of texels at quarters, and that of
    // samples less, as the smallest rings lie within a texel.
    DepthOfFieldBlur blur{.step = double(step), .own = step == 1 ? 4.0 / 12 : 4.0 / 16 + 4 * 3.0 / 16 + 0.1};
    // A radius of half a pixel is sharp.
    blur.to = 0.85 * std::sqrt(blur.own);
    blur.slope = 1 / (blur.to - blur.full(0.5 / step));
    return blur;
}

/// Place `i` of the 8 `ring` ones of a ring, in rings: evenly spread over the area of the aperture's shape. y is down.
[[nodiscard]] inline std::array<double, 2> depth_of_field_place(const DepthOfField& field, std::uint32_t ring,
                                                                std::uint32_t i) {
    constexpr double pi = std::numbers::pi;
    // Rings are turned against each other, lest there be spokes: the golden ratio.
    const double offset = ring * (std::numbers::phi - 1);
    const double turn = (i + offset - std::floor(offset)) / (8.0 * ring);
    double angle = 2 * pi * turn, radius = ring;
    if (field.blades >= 3) {
        // Places along a straight side are as far from each other everywhere.
        const double sides = field.blades, side = std::floor(turn * sides), along = 2 * (turn * sides - side) - 1;
        const double bent = std::atan(along * std::tan(pi / sides)), round = double{field.roundness};
        const double straight = std::cos(pi / sides) / std::cos(bent);
        angle = 2 * pi * (side + 0.5) / sides + std::lerp(bent, along * pi / sides, round);
        radius *= std::lerp(straight, 1.0, round);
    }
    angle += double{field.rotation} * pi / 180;
    // A texel gets the light of those that it lies in the circle of: the shape, mirrored.
    return {-radius * std::cos(angle) / double{field.anamorphic_ratio}, radius * std::sin(angle)};
}

/// Side of the square tiles whose largest near circle is known, in pixels, for pictures of at most this extent: a
/// multiple of 8, and more than the largest radius. A pixel may belong to the tile beside its own by the rounding of
/// sizes: hence 8 pixels more.
inline std::uint32_t depth_of_field_tile(VkExtent2D extent) { return ((extent.height + 24) / 25 + 15) / 8 * 8; }

}  // namespace darkroom
