// SPDX-License-Identifier: MIT
#pragma once
// Depth of field in double precision, pass by pass: scattering as gathering in rings, near and far fields apart, after
// Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (2014), and Abadie, "A Life of a Bokeh"
// (2018). The page has the equations.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/depth_of_field.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "depth_of_field/depth_of_field_lens.hpp"
#include "shared/finite_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

/// Radius of a circle in texels of the blurred picture, negative in the near field.
inline double depth_of_field_reference_circle(const DepthOfField& field, const Camera& camera, double planar,
                                              std::uint32_t height, std::uint32_t step) {
    const ThinLens lens = depth_of_field_lens(field, camera, height);
    const double limit = double{field.max_radius} / 100 * height;
    // NaN compares as not nearer than the sky.
    const double inverse = planar < 1e9 ? std::min(1 / std::max(planar, 0.0), 1e4) : 0.0;
    return std::clamp(lens.infinity * (1 - lens.focus * inverse), -limit, limit) / step;
}

/// Where the lens moves to in so many seconds, in dioptres: at constant speed, and at last in proportion to what is
/// left.
inline double depth_of_field_reference_moved(double dioptres, double target, double speed, double seconds) {
    const double way = seconds * speed, left = std::abs(target - dioptres);
    const double steady = std::clamp(left - autofocus_slow, 0.0, way);
    const double rest = (left - steady) * std::exp((steady - way) / autofocus_slow);
    return target < dioptres ? target + rest : target - rest;
}

/// The dioptres of what is seen at the place: the middle one of 5 by 5, a hundredth of the height to each side.
inline double depth_of_field_reference_seen(const DepthOfField& field, const ReferenceImage& depth) {
    constexpr std::int64_t side = autofocus_side;
    const std::int64_t apart = std::max((depth.height + 100) / 200, 1U);
    const auto x = static_cast<std::int64_t>(field.autofocus_place.x * static_cast<float>(depth.width)),
               y = static_cast<std::int64_t>(field.autofocus_place.y * static_cast<float>(depth.height));
    std::array<double, side * side> seen{};
    for (std::int64_t i = 0; i < side * side; ++i) {
        const double planar = depth.clamped(x + (i % side - side / 2) * apart, y + (i / side - side / 2) * apart).r;
        const double inverse = planar < 1e9 ? 1 / std::max(planar, 1e-6) : 0.0;
        seen[static_cast<std::size_t>(i)] = std::clamp(inverse, autofocus_farthest, autofocus_nearest);
    }
    std::ranges::sort(seen);
    return seen[seen.size() / 2];
}

/// The distance that is sharp. The history holds the dioptres in red, and in green those that the lens moves toward.
inline float depth_of_field_reference_focus(const DepthOfField& field, const ReferenceInput& input) {
    const double target = depth_of_field_reference_seen(field, *input.depth);
    double dioptres = target;
    if (input.history != nullptr) {
        if (const auto past = input.history->find("focus"); past != input.history->end())
            dioptres = depth_of_field_reference_moved(past->second.at(0, 0).r, past->second.at(0, 0).g,
                                                      double{field.autofocus_speed}, input.delta_time);
        (*input.history)["focus"] = ReferenceImage(1, 1, {dioptres, target, 0, 1});
    }
    return static_cast<float>(1 / dioptres);
}

/// Colour, and the circle in alpha.
inline ReferenceImage depth_of_field_reference_color(const DepthOfField& field, const ReferenceInput& input,
                                                     std::uint32_t step) {
    const ReferenceImage& picture = *input.picture;
    const std::int64_t right = picture.width - 1, bottom = picture.height - 1;
    ReferenceImage out(std::max(1u, picture.width / step), std::max(1u, picture.height / step));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            std::array<double, 4> circles{}, sorted{};
            std::array<const Rgba*, 4> colors{};
            for (std::uint32_t i = 0; i < 4; ++i) {
                const std::int64_t column = std::min(std::int64_t{x} * step + (step == 2 ? i & 1 : 0), right);
                const std::int64_t row = std::min(std::int64_t{y} * step + (step == 2 ? i >> 1 : 0), bottom);
                colors[i] = &picture.clamped(column, row);
                circles[i] = depth_of_field_reference_circle(field, input.camera, input.depth->clamped(column, row).r,
                                                             picture.height, step);
            }
            sorted = circles;
            std::ranges::sort(sorted);
            const double own = sorted[sorted[1] < 0 && (x + y) % 2 == 1 ? 2 : 1];
            Rgba sum{0, 0, 0, 0};
            for (std::size_t i = 0; i < 4; ++i) {
                const double weight =
                    std::clamp(1.5 + 0.25 * std::abs(own) * step - std::abs(circles[i] - own) * step, 0.0, 1.0);
                sum = {sum.r + colors[i]->r * weight, sum.g + colors[i]->g * weight, sum.b + colors[i]->b * weight,
                       sum.a + weight};
            }
            const DepthOfFieldBlur blur = depth_of_field_blur(step);
            out.at(x, y) = {finite_reference(sum.r / sum.a), finite_reference(sum.g / sum.a),
                            finite_reference(sum.b / sum.a), own < 0 ? -blur.left(-own) : blur.left_behind(own)};
        }
    return out;
}

/// The largest near circle of each tile and those around it; in red.
inline ReferenceImage depth_of_field_reference_tiles(const ReferenceImage& color, const ReferenceImage& picture) {
    const std::uint32_t side = depth_of_field_tile({picture.width, picture.height});
    const auto part = [](std::uint32_t pixels, std::uint32_t of) { return std::max(1u, pixels / of); };
    const auto largest = [](const ReferenceImage& from, std::uint32_t width, std::uint32_t height, auto&& value) {
        ReferenceImage out(width, height);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                for (std::uint32_t row = y * from.height / height; row * height < (y + 1) * from.height; ++row)
                    for (std::uint32_t column = x * from.width / width; column * width < (x + 1) * from.width; ++column)
                        out.at(x, y).r = std::max(out.at(x, y).r, value(from.at(column, row)));
        return out;
    };
    const ReferenceImage small = largest(color, part(picture.width, 8), part(picture.height, 8),
                                         [](const Rgba& texel) { return std::max(-texel.a, 0.0); });
    const ReferenceImage tiles = largest(small, part(picture.width, side), part(picture.height, side),
                                         [](const Rgba& texel) { return texel.r; });
    ReferenceImage out = tiles;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (int i = 0; i < 9; ++i)
                out.at(x, y).r =
                    std::max(out.at(x, y).r, tiles.clamped(std::int64_t{x} + i % 3 - 1, std::int64_t{y} + i / 3 - 1).r);
    return out;
}

/// What is gathered about a texel.
struct DepthOfFieldReach {
    double circle = 0, radius = 0, rings_a_texel = 1, spacing = 1;
    std::uint32_t rings = 1;
};

inline DepthOfFieldReach depth_of_field_reference_reach(const DepthOfField& field, const ReferenceImage& color,
                                                        const ReferenceImage& tiles, std::uint32_t x, std::uint32_t y) {
    DepthOfFieldReach reach;
    reach.circle = color.at(x, y).a;
    reach.radius = std::max(tiles.at(x * tiles.width / color.width, y * tiles.height / color.height).r, reach.circle);
    reach.rings = static_cast<std::uint32_t>(std::clamp(std::ceil(reach.radius), 2.0, double(field.rings)));
    reach.radius = std::max(reach.radius, 1e-3);
    reach.rings_a_texel = reach.rings / reach.radius;
    // The mean square of the samples' distances, that of a disc being half its radius squared.
    double sum = 0, samples = 1;
    for (std::uint32_t ring = 1; ring <= reach.rings; ++ring) {
        const double count = 8.0 * ring * (ring == reach.rings ? 0.5 : 1);
        sum += count * ring * ring;
        samples += count;
    }
    reach.spacing = reach.radius * std::sqrt(samples / (2 * sum));
    return reach;
}

/// Samples that lie in a circle whose radius is given in rings, those on its edge in part.
inline double depth_of_field_reference_samples(double radius, std::uint32_t rings) {
    double sum = 1;
    for (std::uint32_t ring = 1; ring <= rings; ++ring) sum += 8.0 * ring * std::clamp(radius - ring + 0.5, 0.0, 1.0);
    return sum;
}

struct DepthOfFieldFields {
    Rgba behind{0, 0, 0, 0}, near{0, 0, 0, 0};
};

inline DepthOfFieldFields depth_of_field_reference_gather(const DepthOfField& field, const ReferenceImage& color,
                                                          const DepthOfFieldReach& reach, std::uint32_t step,
                                                          const ReferenceImage& picture, std::uint32_t x,
                                                          std::uint32_t y) {
    const DepthOfFieldBlur blur = depth_of_field_blur(step);
    const double diagonal = std::hypot(picture.width, picture.height);
    DepthOfFieldFields sums;
    if (reach.radius <= blur.least) return sums;
    const double away_x = ((x + 0.5) / color.width - 0.5) * 2 * picture.width / diagonal * double{field.cats_eye};
    const double away_y = ((y + 0.5) / color.height - 0.5) * 2 * picture.height / diagonal * double{field.cats_eye};
    const double cut = std::hypot(away_x, away_y);
    const double left = (2 * std::acos(cut / 2) - cut / 2 * std::sqrt(4 - cut * cut)) / std::numbers::pi;
    const auto add = [](Rgba& sum, const Rgba& texel, double weight) {
        sum = {sum.r + texel.r * weight, sum.g + texel.g * weight, sum.b + texel.b * weight, sum.a + weight};
    };
    for (std::uint32_t ring = 0; ring <= reach.rings; ++ring)
        for (std::uint32_t i = 0; i < std::max(8 * ring, 1u); ++i) {
            const auto place = ring == 0 ? std::array<double, 2>{} : depth_of_field_place(field, ring, i);
            const Rgba& texel =
                color.clamped(x + static_cast<std::int64_t>(std::floor(place[0] * reach.spacing + 0.5)),
                              y + static_cast<std::int64_t>(std::floor(place[1] * reach.spacing + 0.5)));
            const bool is_near = texel.a < 0;
            const double radius =
                (is_near ? -texel.a : std::min(texel.a, std::max(reach.circle, 0.0))) * reach.rings_a_texel;
            const double away =
                std::max(double(ring), std::hypot(place[0] + away_x * radius, place[1] + away_y * radius));
            const double covers = (ring == 0 ? 1.0 : std::clamp(radius - (cut == 0 ? ring : away) + 0.5, 0.0, 1.0)) /
                                  depth_of_field_reference_samples(radius, reach.rings);
            const double nearness = 1 - double(ring) / (reach.rings + 1);
            if (is_near)
                add(sums.near, texel, covers * blur.weight(-texel.a));
            else
                add(sums.behind, texel, reach.circle > 0 ? covers : nearness * nearness);
        }
    const auto divided = [](const Rgba& sum, double by) {
        return Rgba{sum.r / by, sum.g / by, sum.b / by, sum.a / by};
    };
    sums.near = divided(sums.near, std::max(left, sums.near.a));
    const Rgba behind = sums.behind.a > 0 ? sums.behind : sums.near;
    sums.behind = std::abs(reach.circle) > blur.least ? divided(behind, std::max(behind.a, 1e-6)) : Rgba{0, 0, 0, 0};
    return sums;
}

/// A small circle of the far field, in pixels: the mean of those around, each as far as it is covered. Of up to 1.5
/// pixels the mean over whole pixels would spread more than a disc does: less is taken.
inline Rgba depth_of_field_reference_small(const DepthOfField& field, const ReferenceInput& input, std::uint32_t x,
                                           std::uint32_t y, double own) {
    Rgba sum{0, 0, 0, 0};
    if (own < 1.5) own = 0.5 + std::pow(own - 0.5, 2);
    for (int i = 0; i < 25; ++i) {
        const std::int64_t column = std::int64_t{x} + i % 5 - 2, row = std::int64_t{y} + i / 5 - 2;
        const double circle = depth_of_field_reference_circle(field, input.camera, input.depth->clamped(column, row).r,
                                                              input.picture->height, 1);
        const double weight = std::clamp(
            std::min(circle, own) - std::hypot((i % 5 - 2) * double{field.anamorphic_ratio}, i / 5 - 2) + 0.5, 0.0,
            1.0);
        const Rgba& seen = input.picture->clamped(column, row);
        sum = {sum.r + finite_reference(seen.r) * weight, sum.g + finite_reference(seen.g) * weight,
               sum.b + finite_reference(seen.b) * weight, sum.a + weight};
    }
    return {sum.r / sum.a, sum.g / sum.a, sum.b / sum.a, 1};
}

inline ReferenceImage depth_of_field_reference(const void* parameters, const ReferenceInput& input) {
    DepthOfField field = *static_cast<const DepthOfField*>(parameters);
    if (field.autofocus) field.focus_distance = depth_of_field_reference_focus(field, input);
    const ReferenceImage& picture = *input.picture;
    const std::uint32_t step = field.resolution == DepthOfFieldResolution::Half ? 2 : 1;
    const ReferenceImage color = depth_of_field_reference_color(field, input, step);
    const ReferenceImage tiles = depth_of_field_reference_tiles(color, picture);
    ReferenceImage behind(color.width, color.height), near = behind;
    for (std::uint32_t y = 0; y < color.height; ++y)
        for (std::uint32_t x = 0; x < color.width; ++x) {
            const auto fields = depth_of_field_reference_gather(
                field, color, depth_of_field_reference_reach(field, color, tiles, x, y), step, picture, x, y);
            behind.at(x, y) = fields.behind;
            near.at(x, y) = fields.near;
        }
    const auto filled = [&](const ReferenceImage& from) {
        ReferenceImage out = from;
        for (std::uint32_t y = 0; y < from.height; ++y)
            for (std::uint32_t x = 0; x < from.width; ++x) {
                const double spacing = depth_of_field_reference_reach(field, color, tiles, x, y).spacing;
                const double side = 0.5 * std::clamp(spacing - 1, 0.0, 1.0);
                Rgba sum{0, 0, 0, 0};
                for (int i = 0; i < 9; ++i) {
                    const Rgba& texel = from.clamped(std::int64_t{x} + i % 3 - 1, std::int64_t{y} + i / 3 - 1);
                    const double weight = (i % 3 == 1 ? 1 : side) * (i / 3 == 1 ? 1 : side) / std::pow(1 + 2 * side, 2);
                    sum = {sum.r + texel.r * weight, sum.g + texel.g * weight, sum.b + texel.b * weight,
                           sum.a + texel.a * weight};
                }
                out.at(x, y) = sum;
            }
        return out;
    };
    behind = filled(behind);
    near = filled(near);
    const DepthOfFieldBlur blur = depth_of_field_blur(step);
    ReferenceImage out = picture;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / step / color.width, v = (y + 0.5) / step / color.height;
            const Rgba over = sample_reference(near, u, v), far = sample_reference(behind, u, v);
            const double circle =
                depth_of_field_reference_circle(field, input.camera, input.depth->at(x, y).r, picture.height, step);
            const double weight = circle < 0 ? blur.weight(blur.left(std::abs(circle))) : blur.weight_behind(circle);
            const double blurred = far.a > 0 ? weight : 0.0;
            const bool is_small = circle * step > 0.5 && blurred < 1;
            Rgba& pixel = out.at(x, y);
            if (blurred == 0 && over.a == 0 && !is_small) continue;
            const Rgba sharp =
                is_small ? depth_of_field_reference_small(field, input, x, y, circle * step) : Rgba{pixel};
            const auto laid = [&](double under, double seen, double covering) {
                const double mixed = finite_reference(under) * (1 - blurred) + seen * blurred / std::max(far.a, 1e-6);
                return mixed * (1 - over.a) + covering;
            };
            pixel = {laid(sharp.r, far.r, over.r), laid(sharp.g, far.g, over.g), laid(sharp.b, far.b, over.b), pixel.a};
        }
    return out;
}

}  // namespace darkroom
