// SPDX-License-Identifier: MIT
#pragma once
// Lens flare in double precision: John Chapman, "Pseudo Lens Flare", 2013, and "Screen Space Lens Flare", 2017. A light
// at p from the middle has ghosts at p / s_i, s_i = (-1)^(i + 1) (1 + spacing i), and a halo where p = r d - q for the
// place q in the direction d.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/lens_flare.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "shared/small_light.hpp"

namespace darkroom {

/// What the place is multiplied by to find what makes this ghost.
inline double lens_flare_scale(const LensFlare& flare, std::int32_t ghost) {
    return (ghost % 2 == 0 ? -1 : 1) * (1 + double{flare.spacing} * ghost);
}
/// The colours of the ghosts go once around, and add up to white.
inline std::array<double, 3> lens_flare_color(const LensFlare& flare, std::int32_t ghost) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = static_cast<double>(ghost) / flare.ghosts - static_cast<double>(i) / 3;
        out[i] = flare.ghosts < 3 ? 1 : 1 + 0.5 * std::cos(2 * std::numbers::pi * turn);
    }
    return out;
}
inline std::int32_t lens_flare_rays(const LensFlare& flare) {
    return flare.blades % 2 == 0 ? flare.blades : 2 * flare.blades;
}

/// Ghosts are out of focus, so each light is seen as the aperture: its radius at the corners, in heights of the
/// picture.
inline constexpr double lens_flare_aperture_radius = 0.06;
/// Of which these are the places that count alike, beside the middle: rings, 8 more on each than on the one inside.
inline constexpr std::size_t lens_flare_rings = 4, lens_flare_places = 4 * lens_flare_rings * (lens_flare_rings + 1);

/// In heights of the picture, from the middle: along a polygon of as many sides as the aperture has blades, which
/// stands for all within half a step of it.
inline std::array<double, 2> lens_flare_place(const LensFlare& flare, std::size_t number) {
    std::size_t ring = 1;
    for (; number >= 8 * ring; ++ring) number -= 8 * ring;
    const double way = static_cast<double>(number) / static_cast<double>(8 * ring) * flare.blades;
    const double corner = std::floor(way), part = way - corner, turn = 2 * std::numbers::pi / flare.blades;
    const double far =
        lens_flare_aperture_radius * static_cast<double>(ring) / (static_cast<double>(lens_flare_rings) + 0.5);
    return {far * (std::cos(turn * corner) * (1 - part) + std::cos(turn * (corner + 1)) * part),
            far * (std::sin(turn * corner) * (1 - part) + std::sin(turn * (corner + 1)) * part)};
}

/// The light above the threshold in half of the small picture, each seen as the aperture.
inline ReferenceImage lens_flare_light_reference(const LensFlare& flare, const ReferenceImage& source) {
    const std::uint32_t part = bright_part({source.width, source.height});
    const ReferenceImage half = quarter_light_reference(bright_reference(source, double{flare.threshold}),
                                                        source.width / (2 * part), source.height / (2 * part));
    ReferenceImage light(half.width, half.height, {0, 0, 0, 1});
    const double aspect = static_cast<double>(source.width) / source.height;
    for (std::uint32_t y = 0; y < light.height; ++y)
        for (std::uint32_t x = 0; x < light.width; ++x) {
            const double u = (x + 0.5) / light.width, v = (y + 0.5) / light.height,
                         share = 1.0 / (lens_flare_places + 1);
            Rgba sum = weighed_sum_reference({0, 0, 0, 1}, half.at(x, y), share);
            for (std::size_t i = 0; i < lens_flare_places; ++i) {
                const auto [right, down] = lens_flare_place(flare, i);
                sum = weighed_sum_reference(sum, sample_reference(half, u + right / aspect, v + down), share);
            }
            light.at(x, y) = sum;
        }
    return light;
}

/// In a picture of `extent` pixels.
inline ReferenceImage lens_flare_parts_reference(const LensFlare& flare, const ReferenceImage& light, double aspect,
                                                 VkExtent2D extent) {
    ReferenceImage out(std::max(extent.width, 1u), std::max(extent.height, 1u), {0, 0, 0, 1});
    const double apart = double{flare.dispersion};
    const auto inside = [](double x, double y) {
        return std::clamp((0.5 - std::abs(x)) * 8, 0.0, 1.0) * std::clamp((0.5 - std::abs(y)) * 8, 0.0, 1.0);
    };
    constexpr double Rgba::*channels[] = {&Rgba::r, &Rgba::g, &Rgba::b};
    const std::array tint{double{flare.tint.r}, double{flare.tint.g}, double{flare.tint.b}};
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double px = (x + 0.5) / out.width - 0.5, py = (y + 0.5) / out.height - 0.5;
            const double far = std::hypot(px * aspect, py);
            // The middle has no direction: any.
            const double way_x = far > 1e-5 ? px * aspect / far : 1, way_y = far > 1e-5 ? py / far : 0;
            const double wave = std::cos(0.5 * lens_flare_rays(flare) * std::atan2(way_y, way_x));
            const double burst = 1 + double{flare.starburst} * (std::pow(wave, 8) * 256 / 70 - 1);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double shift = (static_cast<double>(channel) - 1) * apart;
                double sum = 0;
                const auto add = [&](double u, double v, double weight) {
                    sum += weight * inside(u, v) * sample_reference(light, u + 0.5, v + 0.5).*channels[channel];
                };
                for (std::int32_t ghost = 0; ghost < flare.ghosts; ++ghost) {
                    const double scale = lens_flare_scale(flare, ghost) * (1 + shift);
                    add(px * scale, py * scale, lens_flare_color(flare, ghost)[channel]);
                }
                const double radius = double{flare.halo_radius} * (1 - shift);
                add(way_x * radius / aspect - px, way_y * radius - py, double{flare.halo});
                out.at(x, y).*channels[channel] = std::min(sum * burst * tint[channel], 65504.0);
            }
        }
    return out;
}

inline ReferenceImage lens_flare_reference(const void* parameters, const ReferenceInput& input) {
    const LensFlare& flare = *static_cast<const LensFlare*>(parameters);
    ReferenceImage out = *input.picture;
    const ReferenceImage light = lens_flare_light_reference(flare, *input.source);
    const std::uint32_t part = bright_part({out.width, out.height});
    const ReferenceImage parts = lens_flare_parts_reference(flare, light, static_cast<double>(out.width) / out.height,
                                                            {out.width / part, out.height / part});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = weighed_sum_reference(out.at(x, y),
                                                 sample_reference(parts, (x + 0.5) / out.width, (y + 0.5) / out.height),
                                                 double{flare.intensity});
    return out;
}

}  // namespace darkroom
