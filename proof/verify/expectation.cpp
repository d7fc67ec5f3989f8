// SPDX-License-Identifier: MIT
#include "verify/expectation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/thread/parallel.hpp"

namespace darkroom::verify {

namespace {

constexpr std::array<double Rgba::*, 4> channels{&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a};

// Of what is computed in floats: by how much inputs are moved, and how much of the largest number around is allowed
// besides. A float has 24 bits, of which chains of exponentials and logarithms lose up to eight (Vulkan specification,
// "Precision and Operation of SPIR-V Instructions"); half precision loses thirteen.
constexpr double float_moved = 0x1p-19, float_allowed = 0x1p-16;
constexpr double least_allowed = 1e-6;
/// The disturbances seldom hit the worst one.
constexpr double beyond_tried = 2;
/// Of sRGB, the steepest of the curves that are approximated (IEC 61966-2-1).
constexpr double curve_power = 2.4;
/// In steps of the sampler: half a one to the nearest place that it knows, and as much for the place itself, which a
/// kernel may interpolate between the vertices of a grid, at both ends of a span.
constexpr double filter_share = 2;

Result<ReferenceImage> develop(const Subject& subject, const Brought& brought, std::span<const SceneFrame> frames) {
    Composer composer(Device::assumed(), {.max_threads = 0});
    DARKROOM_TRY(fill(subject, composer, brought));
    ReferenceHistories histories;
    ReferenceImage out;
    for (const SceneFrame& frame : frames) {
        ReferenceChainInput input = frame.reference_input();
        input.histories = &histories;
        DARKROOM_TRY_VALUE(ReferenceChainOutput made, run_reference(composer, input));
        out = std::move(made.picture);
    }
    return out;
}

/// The largest around a pixel, of `value(x, y)`.
template <class Value>
double largest_around(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height, const Value& value) {
    double out = 0;
    for (std::uint32_t j = y == 0 ? 0 : y - 1; j < std::min(y + 2, height); ++j)
        for (std::uint32_t i = x == 0 ? 0 : x - 1; i < std::min(x + 2, width); ++i) out = std::max(out, value(i, j));
    return out;
}

double size_of(const Rgba& p) { return std::max({std::abs(p.r), std::abs(p.g), std::abs(p.b)}); }

double largest_change(const ReferenceImage& a, const ReferenceImage& b) {
    double out = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        out = std::max(out, size_of({p.r - q.r, p.g - q.g, p.b - q.b, 0}));
    }
    return out;
}

ReferenceImage allowance_of(const ReferenceImage& picture, const ReferenceImage& input,
                            std::span<const ReferenceImage> others, double relative, const Precision& precision) {
    const std::uint32_t width = picture.width, height = picture.height;
    const bool has_input = input.width == width && input.height == height;
    ReferenceImage parted(width, height, {0, 0, 0, 0}), out = parted;
    for (const ReferenceImage& other : others)
        for (std::size_t i = 0; i < parted.pixels.size(); ++i)
            for (double Rgba::*const c : channels)
                parted.pixels[i].*c =
                    std::max(parted.pixels[i].*c, std::abs(other.pixels[i].*c - picture.pixels[i].*c));
    // A table is nowhere larger than 1, so that its most is at least what the effect changes.
    const double tables = precision.table_step * (has_input ? largest_change(picture, input) : 0);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double size = largest_around(x, y, width, height, [&](std::uint32_t i, std::uint32_t j) {
                return std::max(size_of(picture.at(i, j)), has_input ? size_of(input.at(i, j)) : 0.0);
            });
            // An encoded value's step in light is the less the darker it is, but the larger a part of it.
            const double curves =
                precision.curve_step * std::max(size, curve_power * std::pow(size, 1 - 1 / curve_power));
            for (double Rgba::*const c : channels) {
                const double apart = largest_around(
                    x, y, width, height, [&](std::uint32_t i, std::uint32_t j) { return parted.at(i, j).*c; });
                out.at(x, y).*c =
                    least_allowed + relative * (c == &Rgba::a ? 1.0 : size) + curves + tables + beyond_tried * apart;
            }
        }
    return out;
}

}  // namespace

Result<Expectation> expect(const Subject& subject, std::span<const SceneFrame> frames, const Precision& precision,
                           std::size_t moved_count) {
    const double relative = float_allowed + precision.image_step * static_cast<double>(precision.passes);
    const double moved_by =
        std::max({float_moved, precision.image_step, curve_power * precision.curve_step, precision.count_step});
    std::vector<Result<ReferenceImage>> made(moved_count + 1);
    parallel_for(made.size(), 0, [&](std::size_t i) {
        if (i == 0) {
            made[i] = develop(subject, {}, frames);
            return;
        }
        using enum Disturbance::Toward;
        const Disturbance by{.relative = moved_by,
                             .filter = filter_share * precision.filter_step + precision.place_step,
                             .toward = i == 1   ? Zero
                                       : i == 2 ? Infinity
                                                : EitherSide};
        std::mt19937 random(static_cast<std::uint32_t>(i));
        std::vector<SceneFrame> moved;
        for (const SceneFrame& frame : frames) moved.push_back(frame.disturbed(random, by));
        made[i] = develop(subject, Brought().disturbed(random, by), moved);
    });
    std::vector<ReferenceImage> others;
    for (Result<ReferenceImage>& one : made) {
        if (!one) return failure(std::move(one));
        if (&one != &made[0]) others.push_back(std::move(*one));
    }
    ReferenceImage allowance = allowance_of(*made[0], frames.back().color(), others, relative, precision);
    return Expectation{std::move(*made[0]), std::move(allowance)};
}

Difference difference(const ReferenceImage& made, const Expectation& expectation) {
    Difference worst;
    for (std::uint32_t y = 0; y < made.height; ++y)
        for (std::uint32_t x = 0; x < made.width; ++x) {
            bool is_beyond = false;
            for (std::uint32_t channel = 0; channel < channels.size(); ++channel) {
                const double value = made.at(x, y).*channels[channel],
                             expected = expectation.picture.at(x, y).*channels[channel],
                             allowed = expectation.allowance.at(x, y).*channels[channel];
                const bool is_same = value == expected || (std::isnan(value) && std::isnan(expected));
                double excess = is_same ? 0 : std::abs(value - expected) / allowed;
                if (!std::isfinite(excess)) excess = std::numeric_limits<double>::max();
                is_beyond |= excess > 1;
                if (excess > worst.excess) worst = {worst.pixels, x, y, channel, value, expected, allowed, excess};
            }
            worst.pixels += is_beyond;
        }
    return worst;
}

}  // namespace darkroom::verify
