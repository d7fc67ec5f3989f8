// SPDX-License-Identifier: MIT
#pragma once
// Fog in double precision: f = (1 - exp(-density x)) / (1 - exp(-density (end - start))), x the distance behind
// `start`. Where height counts, x is multiplied by the mean of exp(-falloff max(y - origin, 0)) along it, or f by what
// that is at the end of the way; the picture is mixed with the colour by f.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/fog.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "shared/camera_reference.hpp"

namespace darkroom {

/// How much of the fog's colour there is at a distance from the camera (m), on a way that reaches `height` (m, world)
/// there and began at the height `eye`.
inline double fog_amount(double distance, double height, const Fog& fog, double eye) {
    const double span = double{fog.end} - double{fog.start};
    const double x = std::clamp(distance - double{fog.start}, 0.0, span);
    const double density = double{fog.density}, falloff = double{fog.height_falloff}, origin{fog.height_origin};
    if (density == 0) return 0;
    const auto thinned = [&](double y) { return std::exp(-falloff * std::max(y - origin, 0.0)); };
    double depth = density * x, amount = 1;
    if (fog.height_enabled.on != 0 && fog.height_form == FogHeight::EndPoint) amount = thinned(height);
    if (fog.height_enabled.on != 0 && fog.height_form == FogHeight::Integral && x > 0) {
        // The antiderivative of what is left at a height.
        const auto below = [&](double y) {
            const double above = std::max(y - origin, 0.0);
            return std::min(y - origin, 0.0) + (falloff == 0 ? above : -std::expm1(-falloff * above) / falloff);
        };
        const double up = (height - eye) / distance, first = eye + up * double{fog.start}, last = first + up * x;
        depth *= std::abs(last - first) > 1e-6 ? (below(last) - below(first)) / (last - first) : thinned(first);
    }
    return amount * std::expm1(-depth) / std::expm1(-density * span);
}
/// The same where height does not count.
inline double fog_amount(double distance, const Fog& fog) { return fog_amount(distance, 0, fog, 0); }

[[nodiscard]] inline double fog_horizon_sine(const Fog& fog) {
    return std::sin(double{fog.horizon} * std::numbers::pi / 180);
}

/// What is left of it in the sky, in a direction that rises by `up` for every metre: all at the horizon and below.
[[nodiscard]] inline double fog_share_in_sky(double up, const Fog& fog) {
    if (fog.sky.on != 0) return 1;
    if (fog.horizon == 0) return 0;
    const double share = std::clamp(1 - up / fog_horizon_sine(fog), 0.0, 1.0);
    return share * share * (3 - 2 * share);
}

inline ReferenceImage fog_reference(const void* parameters, const ReferenceInput& input) {
    const Fog& fog = *static_cast<const Fog*>(parameters);
    ReferenceImage out = *input.picture;
    const ReferenceCamera camera(input.camera);
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double planar = input.depth->at(x, y).r;
            const bool is_sky = planar >= 1e9;
            const Double3 view = camera.view_position((x + 0.5) / out.width, (y + 0.5) / out.height, planar);
            // Rays that run side by side begin beside the eye.
            const Double3 first = camera.view_position((x + 0.5) / out.width, (y + 0.5) / out.height, 0);
            const Double3 ray{view[0] - first[0], view[1] - first[1], view[2] - first[2]};
            const double length = std::hypot(ray[0], ray[1], ray[2]);
            const double distance = is_sky ? double{fog.end} : length;
            const double eye = camera.eye[1] + camera.world_direction(first)[1];
            const double up = camera.world_direction(ray)[1] / length;
            const double amount =
                fog_amount(distance, eye + up * distance, fog, eye) * (is_sky ? fog_share_in_sky(up, fog) : 1);
            Rgba& pixel = out.at(x, y);
            pixel.r += (double{fog.color.r} - pixel.r) * amount;
            pixel.g += (double{fog.color.g} - pixel.g) * amount;
            pixel.b += (double{fog.color.b} - pixel.b) * amount;
        }
    }
    return out;
}

}  // namespace darkroom
