// SPDX-License-Identifier: MIT
#pragma once
// Volumetric light in double precision, with the very samples of the shaders: at half size, along the ray of every
// second pixel, `samples` steps with a blue-noise offset, each lit or not by the nearest texel of a shadow cascade;
// then the blur and the upsample, which mix pixels of like distance.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/volumetric.hpp>
#include <darkroom/reference.hpp>

#include "shared/blue_noise.hpp"
#include "shared/camera_reference.hpp"

namespace darkroom {

/// How much nearer to the light a point in the air is compared than it is, of the cascade's depth. That is a quarter of
/// a texel, whatever the range of depth is: what is lit stays off its own shadow, and a wall of one texel stays closed.
inline double volumetric_bias(const Matrix& world_to_cascade, std::uint32_t resolution) {
    const auto length = [&](std::size_t row) {
        return std::hypot(double{world_to_cascade[row]}, double{world_to_cascade[4 + row]},
                          double{world_to_cascade[8 + row]});
    };
    const double texel = 2 / (std::max(length(0), 1e-30) * std::max(resolution, 1u));
    return 0.25 * texel * length(2);
}

/// Henyey and Greenstein, "Diffuse radiation in the galaxy", 1941, with g = 0.8.
inline double volumetric_phase(double cosine) {
    constexpr double g = 0.8, pi = 3.14159265358979323846;
    return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// What a step of this length in metres leaves of the light.
inline double volumetric_left(const Volumetric& volumetric, double step) {
    const bool is_per_metre = volumetric.decay_form == VolumetricDecay::PerMetre;
    return std::pow(double{volumetric.decay}, is_per_metre ? step : 32.0 / volumetric.samples);
}

/// What the haze scatters where nothing casts a shadow, on `length` metres: the integral of what each metre leaves, or
/// a geometric series of the steps' shares.
inline double volumetric_unoccluded(const Volumetric& volumetric, double intensity, double cosine, double length) {
    const double samples = volumetric.samples, left = volumetric_left(volumetric, length / samples);
    const double all = std::pow(left, samples);
    const double per_step = volumetric.decay_form == VolumetricDecay::PerMetre ? -std::log(left) : 1 - left;
    const double series = left == 1 ? samples : (1 - all) / per_step;
    return intensity * volumetric_phase(cosine) * double{volumetric.density} * 0.01 * length / samples * series;
}

inline bool volumetric_is_lit(const ReferenceLight& light) {
    return !light.cascades.empty() && light.light.volumetric_intensity > 0 &&
           std::ranges::any_of(light.light.volumetric_color, [](float channel) { return channel > 0; });
}

/// 1 where the light's cascade for this distance along the view axis lets light through to a point of the world.
inline double volumetric_visible(const ReferenceLight& light, const Double3& point, double planar) {
    const std::size_t count = std::min(light.cascades.size(), Light::max_cascades);
    std::size_t cascade = 0;
    while (cascade < count && !(planar < double{light.light.splits[cascade]})) ++cascade;
    if (cascade == count) return 1;
    const Matrix& m = light.light.world_to_cascade[cascade];
    Double3 place{};
    for (std::size_t row = 0; row < 3; ++row)
        place[row] = double{m[row]} * point[0] + double{m[4 + row]} * point[1] + double{m[8 + row]} * point[2] +
                     double{m[12 + row]};
    const double u = place[0] * 0.5 + 0.5, v = place[1] * 0.5 + 0.5;
    if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return 1;
    const auto x = static_cast<std::size_t>(u * light.resolution), y = static_cast<std::size_t>(v * light.resolution);
    const double nearest = double{light.cascades[cascade][y * light.resolution + x]};
    return std::min(place[2] - volumetric_bias(m, light.resolution), 1.0) <= nearest ? 1 : 0;
}

/// NaN counts as sky.
inline double volumetric_clean_distance(double planar) { return planar < 1e9 ? std::max(planar, 0.0) : 1e9; }

/// The light of all lights at one half-size pixel; alpha: its planar distance.
inline Rgba volumetric_march(const Volumetric& volumetric, const ReferenceInput& input, const ReferenceCamera& camera,
                             std::uint32_t x, std::uint32_t y) {
    const std::uint32_t noise = (y % blue_noise_size) * blue_noise_size + x % blue_noise_size;
    const double jitter = (blue_noise_ranks()[noise] + 0.5) / static_cast<double>(blue_noise_ranks().size());
    const double planar = volumetric_clean_distance(input.depth->at(x * 2, y * 2).r);
    const double u = (x * 2 + 0.5) / input.depth->width, v = (y * 2 + 0.5) / input.depth->height;
    const Double3 first = camera.view_position(u, v, 0), second = camera.view_position(u, v, 1);
    const Double3 unit{second[0] - first[0], second[1] - first[1], second[2] - first[2]};
    const double true_of_planar = std::hypot(unit[0], unit[1], unit[2]);
    const Double3 moved = camera.world_direction(first), turned = camera.world_direction(unit);
    const double march = std::min(planar * true_of_planar, double{volumetric.max_distance});
    const double step = march / volumetric.samples, left = volumetric_left(volumetric, step);
    const bool is_per_metre = volumetric.decay_form == VolumetricDecay::PerMetre;

    Rgba out{0, 0, 0, std::min(planar, 60000.0)};
    std::uint32_t number = 0;
    for (const ReferenceLight& light : input.lights) {
        if (light.cascades.empty() || number++ >= max_shadow_lights || !volumetric_is_lit(light)) continue;
        double sum = 0, transmittance = is_per_metre ? std::pow(left, jitter) : 1;
        for (std::int32_t i = 0; i < volumetric.samples; ++i, transmittance *= left) {
            const double along = (i + jitter) * step / true_of_planar;
            Double3 point{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = camera.eye[axis] + moved[axis] + turned[axis] * along;
            sum += volumetric_visible(light, point, along) * transmittance;
        }
        const auto& d = light.light.direction;
        const double cosine = (turned[0] * double{d[0]} + turned[1] * double{d[1]} + turned[2] * double{d[2]}) /
                              (true_of_planar * std::max(std::hypot(double{d[0]}, double{d[1]}, double{d[2]}), 1e-6));
        const double scattered = sum * step * double{volumetric.density} * 0.01 *
                                 double{light.light.volumetric_intensity} * volumetric_phase(cosine);
        const auto add = [&](double& channel, float color) {
            channel += std::min(std::max(double{color}, 0.0) * scattered, 16000.0);
        };
        add(out.r, light.light.volumetric_color[0]);
        add(out.g, light.light.volumetric_color[1]);
        add(out.b, light.light.volumetric_color[2]);
    }
    return out;
}

inline ReferenceImage volumetric_blur(const ReferenceImage& image, std::int64_t step_x, std::int64_t step_y) {
    ReferenceImage out(image.width, image.height);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const double own = image.at(x, y).a;
            Rgba sum{0, 0, 0, 0};
            for (std::int64_t i = -2; i <= 2; ++i) {
                const Rgba& tap = image.clamped(x + i * step_x, y + i * step_y);
                const double weight = std::exp(-0.2 * static_cast<double>(i * i)) *
                                      std::max(1 - 10 * std::abs(tap.a - own) / std::max(own, 1e-3), 0.0);
                sum = {sum.r + tap.r * weight, sum.g + tap.g * weight, sum.b + tap.b * weight, sum.a + weight};
            }
            out.at(x, y) = {sum.r / sum.a, sum.g / sum.a, sum.b / sum.a, own};
        }
    return out;
}

/// What a full-size pixel gets of its four half-size neighbours.
inline Rgba volumetric_upsample(const ReferenceImage& half, double planar, double max_distance, std::uint32_t x,
                                std::uint32_t y) {
    planar = std::clamp(volumetric_clean_distance(planar), 1e-3, 60000.0);
    Rgba sum{0, 0, 0, 0};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const double part_x = (x & 1) * 0.5, part_y = (y & 1) * 0.5;
        const double bilinear = ((i & 1) != 0 ? part_x : 1 - part_x) * ((i >> 1) != 0 ? part_y : 1 - part_y);
        const Rgba& tap = half.clamped(std::int64_t{x / 2} + (i & 1), std::int64_t{y / 2} + (i >> 1));
        const double weight = (bilinear + 1e-3) / (0.01 + std::abs(tap.a / planar - 1));
        const double light = weight * std::min(planar / std::max(std::min(tap.a, max_distance), 1e-3), 1.0);
        sum = {sum.r + tap.r * light, sum.g + tap.g * light, sum.b + tap.b * light, sum.a + weight};
    }
    return {sum.r / sum.a, sum.g / sum.a, sum.b / sum.a, 0};
}

inline ReferenceImage volumetric_reference(const void* parameters, const ReferenceInput& input) {
    const Volumetric& volumetric = *static_cast<const Volumetric*>(parameters);
    ReferenceImage out = *input.picture;
    if (input.depth == nullptr || std::ranges::none_of(input.lights, volumetric_is_lit)) return out;
    const ReferenceCamera camera(input.camera);
    ReferenceImage half(std::max(out.width / 2, 1u), std::max(out.height / 2, 1u));
    for (std::uint32_t y = 0; y < half.height; ++y)
        for (std::uint32_t x = 0; x < half.width; ++x)
            half.at(x, y) = volumetric_march(volumetric, input, camera, x, y);
    half = volumetric_blur(volumetric_blur(half, 1, 0), 0, 1);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba light =
                volumetric_upsample(half, input.depth->at(x, y).r, double{volumetric.max_distance}, x, y);
            Rgba& color = out.at(x, y);
            color = {color.r + light.r, color.g + light.g, color.b + light.b, color.a};
        }
    return out;
}

}  // namespace darkroom
