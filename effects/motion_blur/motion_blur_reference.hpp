// SPDX-License-Identifier: MIT
#pragma once
// Motion blur in double precision, after McGuire, Hennessy, Bukowski and Osman, "A Reconstruction Filter for Plausible
// Motion Blur" (2012), with the two directions of Guertin, McGuire and Nowrouzezahrai, "A Fast and Stable Feature-Aware
// Motion Blur Filter" (2014) and the sample weights of Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare" (2014). The page has the equations.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/motion_blur.hpp>
#include <darkroom/reference.hpp>

#include "shared/camera_reference.hpp"
#include "shared/finite_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

/// How far a texel smears to either side, and its distance.
struct MotionBlurReach {
    double x = 0, y = 0, length = 0, planar = 0;
    [[nodiscard]] double dot(const MotionBlurReach& other) const { return x * other.x + y * other.y; }
    [[nodiscard]] double cosine(const MotionBlurReach& other) const {
        return dot(other) / std::max(length * other.length, 1e-6);
    }
};
struct MotionBlurMap {
    std::uint32_t width = 0, height = 0;
    std::vector<MotionBlurReach> texels;
    MotionBlurMap(std::uint32_t w, std::uint32_t h) : width(w), height(h), texels(std::size_t{w} * h) {}
    [[nodiscard]] MotionBlurReach& at(std::uint32_t x, std::uint32_t y) { return texels[std::size_t{y} * width + x]; }
    [[nodiscard]] const MotionBlurReach& clamped(std::int64_t x, std::int64_t y) const {
        const auto column = std::clamp<std::int64_t>(x, 0, width - 1), row = std::clamp<std::int64_t>(y, 0, height - 1);
        return texels[static_cast<std::size_t>(row * width + column)];
    }
};

/// Previous minus current place in the picture of a point that stands still, in pixels.
inline std::array<double, 2> motion_blur_reference_velocity(const Camera& camera, const ReferenceImage& picture,
                                                            double u, double v, double planar) {
    const ReferenceCamera now(camera);
    Camera earlier = camera;
    earlier.view = camera.previous_view;
    earlier.projection = camera.previous_projection;
    const ReferenceCamera before(earlier);
    const Double3 place = now.view_position(u, v, std::min(planar, 1e9));
    Double3 world = now.world_direction(place);
    for (std::size_t axis = 0; axis < 3; ++axis) world[axis] += now.eye[axis] - before.eye[axis];
    const Double3 seen = before.view_direction(world);
    const auto& p = earlier.projection;
    if (double{p[11]} * seen[2] + double{p[15]} <= 0) return {0, 0};
    const auto [was_u, was_v] = before.uv(seen);
    return {(was_u - u) * picture.width + double{camera.jitter[0]} - double{camera.previous_jitter[0]},
            (was_v - v) * picture.height + double{camera.jitter[1]} - double{camera.previous_jitter[1]}};
}

inline MotionBlurMap motion_blur_reference_map(const MotionBlur& blur, const ReferenceInput& input,
                                               std::uint32_t step) {
    const ReferenceImage& picture = *input.picture;
    MotionBlurMap out(std::max(1u, picture.width / step), std::max(1u, picture.height / step));
    const double open = input.camera.is_cut ? 0 : double{blur.shutter_angle} / 360;
    const double limit = double{blur.max_radius} / 100 * picture.height / step;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const std::uint32_t column = x * step, row = y * step;
            const double planar = input.depth->at(column, row).r;
            std::array<double, 2> velocity{};
            if (input.velocity != nullptr) {
                const Rgba& given = input.velocity->at(column, row);
                velocity = {finite_reference(given.r), finite_reference(given.g)};
            } else {
                velocity = motion_blur_reference_velocity(input.camera, picture, (column + 0.5) / picture.width,
                                                          (row + 0.5) / picture.height, planar);
            }
            const double scale = open / 2 / step;
            const double length = std::hypot(velocity[0], velocity[1]) * scale;
            const double shorter = scale * std::min(1.0, limit / std::max(length, 1e-6));
            out.at(x, y) = {velocity[0] * shorter, velocity[1] * shorter, std::min(length, limit),
                            planar < 60000 ? std::max(planar, 1e-4) : 60000};
        }
    return out;
}

/// The longest motion among the texels under each of a smaller map.
inline MotionBlurMap motion_blur_reference_tiles(const MotionBlurMap& map, std::uint32_t width, std::uint32_t height) {
    MotionBlurMap out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (std::uint32_t row = y * map.height / height; row * height < (y + 1) * map.height; ++row)
                for (std::uint32_t column = x * map.width / width; column * width < (x + 1) * map.width; ++column) {
                    const MotionBlurReach& reach = map.clamped(column, row);
                    if (reach.length > out.at(x, y).length) out.at(x, y) = reach;
                }
    return out;
}

inline MotionBlurMap motion_blur_reference_around(const MotionBlurMap& tiles) {
    MotionBlurMap out(tiles.width, tiles.height);
    for (std::uint32_t y = 0; y < tiles.height; ++y)
        for (std::uint32_t x = 0; x < tiles.width; ++x)
            for (int down = -1; down <= 1; ++down)
                for (int right = -1; right <= 1; ++right) {
                    const MotionBlurReach& reach = tiles.clamped(std::int64_t{x} + right, std::int64_t{y} + down);
                    if (reach.length > out.at(x, y).length) out.at(x, y) = reach;
                }
    return out;
}

inline Rgba motion_blur_reference_clean(const Rgba& color) {
    return {finite_reference(color.r), finite_reference(color.g), finite_reference(color.b), finite_reference(color.a)};
}

inline ReferenceImage motion_blur_reference_clean(const ReferenceImage& picture) {
    ReferenceImage out = picture;
    for (Rgba& color : out.pixels) color = motion_blur_reference_clean(color);
    return out;
}

inline ReferenceImage motion_blur_reference_half(const ReferenceImage& picture, const ReferenceImage& depth) {
    ReferenceImage out(std::max(1u, picture.width / 2), std::max(1u, picture.height / 2));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba sum{0, 0, 0, 0};
            double weights = 0;
            const double planar = depth.at(2 * x, 2 * y).r;
            const auto is_like = [&](double other) { return std::abs(1 / other - 1 / planar) < 0.1 / other; };
            for (int i = 0; i < 4; ++i) {
                const std::int64_t column = 2 * x + (i & 1), row = 2 * y + (i >> 1);
                if (i > 0 && !is_like(depth.clamped(column, row).r)) continue;
                const Rgba& color = picture.clamped(column, row);
                sum = {sum.r + color.r, sum.g + color.g, sum.b + color.b, sum.a + color.a};
                ++weights;
            }
            out.at(x, y) =
                motion_blur_reference_clean({sum.r / weights, sum.g / weights, sum.b / weights, sum.a / weights});
        }
    return out;
}

/// Colours by their weights, and those in alpha.
struct MotionBlurSum {
    Rgba sum{0, 0, 0, 0};
    void add(const Rgba& color, double weight) {
        sum = {sum.r + color.r * weight, sum.g + color.g * weight, sum.b + color.b * weight, sum.a + weight};
    }
};

inline Rgba motion_blur_reference_smear(const MotionBlur& blur, const ReferenceImage& color, const MotionBlurMap& map,
                                        const MotionBlurMap& fastest, std::uint32_t x, std::uint32_t y) {
    const auto fraction = [](double value) { return value - std::floor(value); };
    const auto noise_at = [&](std::uint32_t column, std::uint32_t row) {
        return fraction(52.9829189 * fraction(column * 0.06711056 + row * 0.00583715));
    };
    const auto moves = [](double length) { return std::clamp(length * 2 - 1, 0.0, 1.0); };
    const double noise = noise_at(x, y);
    const auto tile = [&](double center, std::uint32_t count, double aside) {
        return static_cast<std::int64_t>(std::floor(center * count + aside * 0.5 - 0.25));
    };
    const MotionBlurReach& peak = fastest.clamped(tile((x + 0.5) / map.width, fastest.width, noise),
                                                  tile((y + 0.5) / map.height, fastest.height, noise_at(y, x)));
    const MotionBlurReach& own = map.clamped(x, y);
    if (peak.length < 0.5) return {0, 0, 0, 0};
    const double alike = std::max(4 * own.cosine(peak) * own.cosine(peak) - 3, 0.0);
    const int rounds = blur.samples / 2;
    MotionBlurSum front, behind;
    for (int i = 0; i < rounds; ++i) {
        struct Tap {
            const MotionBlurReach& reach;
            Rgba color;
            double in_front;
        };
        const auto tap = [&](const MotionBlurReach& way, double place) {
            const auto column = std::int64_t{x} + static_cast<std::int64_t>(std::floor(way.x * place + 0.5));
            const auto row = std::int64_t{y} + static_cast<std::int64_t>(std::floor(way.y * place + 0.5));
            const MotionBlurReach& reach = map.clamped(column, row);
            return Tap{reach, color.clamped(column, row), std::clamp(10 * (own.planar / reach.planar - 1), 0.0, 1.0)};
        };
        const double place = 2 * (i + noise) / rounds - 1, away = std::abs(place) * peak.length;
        const Tap across = tap(peak, place);
        const double toward = across.reach.cosine(peak);
        const double share = std::min(peak.length / std::max(across.reach.length, 0.5) / rounds, 1.0);
        front.add(across.color, across.in_front * moves(across.reach.length) * toward * toward * share *
                                    std::clamp(across.reach.length - away + 1, 0.0, 1.0));
        behind.add(across.color, (1 - across.in_front) * alike * std::clamp(own.length - away + 1, 0.0, 1.0));
        const Tap along = tap(own, 2 * (i + fraction(noise + 0.5)) / rounds - 1);
        behind.add(along.color, 1 - along.in_front);
    }
    const double most = std::max(front.sum.a, 1.0), covered = front.sum.a / most;
    const double smears = moves(own.length) * (1 - covered) * std::clamp(behind.sum.a, 0.0, 1.0);
    const double scale = smears / std::max(behind.sum.a, 1e-6);
    return {front.sum.r / most + behind.sum.r * scale, front.sum.g / most + behind.sum.g * scale,
            front.sum.b / most + behind.sum.b * scale, covered + smears};
}

inline ReferenceImage motion_blur_reference(const void* parameters, const ReferenceInput& input) {
    const MotionBlur& blur = *static_cast<const MotionBlur*>(parameters);
    const ReferenceImage& picture = *input.picture;
    const bool is_half = blur.resolution == MotionBlurResolution::Half;
    const MotionBlurMap map = motion_blur_reference_map(blur, input, is_half ? 2 : 1);
    const std::uint32_t tile = motion_blur_tile({picture.width, picture.height});
    const auto part = [](std::uint32_t pixels, std::uint32_t side) { return std::max(1u, pixels / side); };
    const MotionBlurMap small = motion_blur_reference_tiles(map, part(picture.width, 8), part(picture.height, 8));
    const MotionBlurMap fastest = motion_blur_reference_around(
        motion_blur_reference_tiles(small, part(picture.width, tile), part(picture.height, tile)));
    const ReferenceImage color =
        is_half ? motion_blur_reference_half(picture, *input.depth) : motion_blur_reference_clean(picture);
    ReferenceImage smeared(map.width, map.height);
    for (std::uint32_t y = 0; y < smeared.height; ++y)
        for (std::uint32_t x = 0; x < smeared.width; ++x)
            smeared.at(x, y) = motion_blur_reference_smear(blur, color, map, fastest, x, y);
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba over = sample_reference(smeared, (x + 0.5) / out.width, (y + 0.5) / out.height);
            Rgba& pixel = out.at(x, y);
            pixel = {pixel.r * (1 - over.a) + over.r, pixel.g * (1 - over.a) + over.g, pixel.b * (1 - over.a) + over.b,
                     pixel.a};
        }
    return out;
}

}  // namespace darkroom
