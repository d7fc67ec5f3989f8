// SPDX-License-Identifier: MIT
#pragma once
// Fog in double precision: f = (1 - exp(-density x)) / (1 - exp(-density (end - start))), x the distance behind
// `start`, times exp(-falloff max(y - origin, 0)) where height counts; the picture is mixed with the colour by f.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/fog.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "shared/camera_reference.hpp"

namespace darkroom {

/// How much of the fog's colour there is at a distance from the camera (m) and a world height (m).
inline double fog_amount(double distance, double height, const Fog& fog) {
    const double span = double{fog.end} - double{fog.start};
    const double x = std::clamp(distance - double{fog.start}, 0.0, span);
    const double density = double{fog.density};
    if (density == 0) return 0;
    double amount = std::expm1(-density * x) / std::expm1(-density * span);
    if (fog.height_enabled.on != 0)
        amount *= std::exp(-double{fog.height_falloff} * std::max(height - double{fog.height_origin}, 0.0));
    return amount;
}

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
            const double length = std::hypot(view[0], view[1], view[2]);
            const double distance = is_sky ? double{fog.end} : length;
            const double up = camera.world_direction(view)[1] / length;
            const double amount =
                fog_amount(distance, camera.eye[1] + up * distance, fog) * (is_sky ? fog_share_in_sky(up, fog) : 1);
            Rgba& pixel = out.at(x, y);
            pixel.r += (double{fog.color.r} - pixel.r) * amount;
            pixel.g += (double{fog.color.g} - pixel.g) * amount;
            pixel.b += (double{fog.color.b} - pixel.b) * amount;
        }
    }
    return out;
}

}  // namespace darkroom
