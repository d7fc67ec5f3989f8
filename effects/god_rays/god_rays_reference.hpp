// SPDX-License-Identifier: MIT
#pragma once
// God rays in double precision: the sky's light above the threshold, averaged to a quarter of the size and weighted by
// its nearness to the light, the edge black; then for every quarter-size pixel the mean over equal steps toward the
// light, each weighing decay^(i / samples); then bilinear samples of that, added.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/god_rays.hpp>
#include <darkroom/reference.hpp>

#include "shared/camera_reference.hpp"
#include "shared/finite_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

inline ReferenceImage god_rays_mask(const GodRays& rays, const ReferenceInput& input, const GodRaysLight& light) {
    const ReferenceImage& source = *input.source;
    ReferenceImage out(std::max(source.width / 4, 1u), std::max(source.height / 4, 1u));
    const double aspect = static_cast<double>(source.width) / source.height;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba sum{0, 0, 0, 0};
            for (std::uint32_t i = 0; i < 16; ++i) {
                const std::int64_t column = std::int64_t{x} * 4 + (i & 3), row = std::int64_t{y} * 4 + (i >> 2);
                if (input.depth != nullptr && input.depth->clamped(column, row).r < 1e9) continue;
                const Rgba& color = source.clamped(column, row);
                const double r = finite_light_reference(color.r), g = finite_light_reference(color.g),
                             b = finite_light_reference(color.b);
                const double luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                const double kept = std::clamp(luminance - double{rays.threshold}, 0.0, double{rays.ceiling}) /
                                    std::max(luminance, 1e-6) / 16;
                sum = {sum.r + r * kept, sum.g + g * kept, sum.b + b * kept, 0};
            }
            const double u = (x + 0.5) / out.width - light.u, v = (y + 0.5) / out.height - light.v;
            const double near = std::clamp(1 - std::hypot(u * aspect, v) / double{rays.radius}, 0.0, 1.0);
            const std::uint32_t inside = std::min({x, y, out.width - 1 - x, out.height - 1 - y});
            const double weight = near * near * std::min(0.5 * inside, 1.0);
            out.at(x, y) = {sum.r * weight, sum.g * weight, sum.b * weight, 0};
        }
    return out;
}

inline ReferenceImage god_rays_streaks(const GodRays& rays, const ReferenceImage& mask, const GodRaysLight& light) {
    ReferenceImage out(mask.width, mask.height);
    const double left = std::pow(double{rays.decay}, 1.0 / rays.samples);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / out.width, v = (y + 0.5) / out.height;
            Rgba sum{0, 0, 0, 0};
            double weight = double{rays.intensity} * light.fade / rays.samples;
            for (std::int32_t i = 0; i < rays.samples; ++i, weight *= left) {
                const double part = double{rays.density} * i / rays.samples;
                const double at_u = u + (light.u - u) * part, at_v = v + (light.v - v) * part;
                const Rgba tap = sample_reference(mask, at_u, at_v);
                sum = {sum.r + tap.r * weight, sum.g + tap.g * weight, sum.b + tap.b * weight, 0};
            }
            out.at(x, y) = {sum.r * double{rays.tint.r}, sum.g * double{rays.tint.g}, sum.b * double{rays.tint.b}, 0};
        }
    return out;
}

/// Where the light is, by the reference's own camera.
inline GodRaysLight god_rays_reference_light(const GodRays& rays, const ReferenceInput& input) {
    GodRaysLight out{.u = double{rays.position.x}, .v = double{rays.position.y}};
    if (rays.follows_light && !input.lights.empty()) {
        const ReferenceCamera camera(input.camera);
        const auto& toward = input.lights.front().light.direction;
        const Double3 view = camera.view_direction({double{toward[0]}, double{toward[1]}, double{toward[2]}});
        if (!(view[2] < 0)) return out;
        const auto [u, v] = camera.uv({view[0] * 1e9, view[1] * 1e9, view[2] * 1e9});
        if (!std::isfinite(u) || !std::isfinite(v)) return out;
        out.u = u;
        out.v = v;
    }
    const double beside = std::max(std::abs(out.u - 0.5), std::abs(out.v - 0.5)) - 0.5;
    out.fade = std::clamp(1 - 2 * beside, 0.0, 1.0);
    return out;
}

inline ReferenceImage god_rays_reference(const void* parameters, const ReferenceInput& input) {
    const GodRays& rays = *static_cast<const GodRays*>(parameters);
    ReferenceImage out = *input.picture;
    const GodRaysLight light = god_rays_reference_light(rays, input);
    if (!(light.fade > 0)) return out;
    const ReferenceImage streaks = god_rays_streaks(rays, god_rays_mask(rays, input, light), light);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba more = sample_reference(streaks, (x + 0.5) / out.width, (y + 0.5) / out.height);
            Rgba& color = out.at(x, y);
            color = {color.r + more.r, color.g + more.g, color.b + more.b, color.a};
        }
    return out;
}

}  // namespace darkroom
