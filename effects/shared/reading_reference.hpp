// SPDX-License-Identifier: MIT
#pragma once
// Readings in double precision, as shared/place.glsl and the planner have them: maps compose from the last to the first
// into the places of red, green (with alpha) and blue, and taps add to what is read there.

#include <darkroom/effect.hpp>
#include <darkroom/reference.hpp>
#include <span>

#include "shared/sample_reference.hpp"

namespace darkroom {

struct ReferenceUv {
    double u = 0, v = 0;
};
/// c (1 + strength |c|^2), c the distance from the middle in uv.
inline ReferenceUv barrel_reference(double u, double v, double strength) {
    const double x = u - 0.5, y = v - 0.5, factor = 1 + strength * (x * x + y * y);
    return {x * factor + 0.5, y * factor + 0.5};
}

/// A map or a tap with its values.
struct ReadingStep {
    ReferenceMapFunction map = nullptr;
    ReferenceTapFunction tap = nullptr;
    const void* parameters = nullptr;
};

/// The picture as it is read by these steps, in their stack's order.
inline ReferenceImage read_reference(const ReferenceImage& picture, std::span<const ReadingStep> steps,
                                     std::uint32_t width, std::uint32_t height) {
    const ReferenceSampler read = [&](double u, double v) { return sample_reference(picture, u, v); };
    ReferenceImage out(width, height);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            ReferencePlace place{.u = (x + 0.5) / width, .v = (y + 0.5) / height, .height = height};
            for (auto step = steps.rbegin(); step != steps.rend(); ++step)
                if (step->map != nullptr) place = step->map(step->parameters, place);
            const auto at = [&](std::size_t channel) {
                const ReferenceUv uv = barrel_reference(place.u, place.v, place.barrel[channel]);
                return read(uv.u, uv.v);
            };
            Rgba color = at(1);
            color.r = at(0).r;
            color.b = at(2).b;
            for (const ReadingStep& step : steps)
                if (step.tap != nullptr) color = step.tap(step.parameters, color, place, read);
            out.at(x, y) = color;
        }
    }
    return out;
}

/// Of a map, or a tap: by itself it is a reading of one step.
template <ReferenceMapFunction function>
Reference map_reference() {
    return {[](const void* parameters, const ReferenceInput& input) {
                const ReadingStep step{.map = function, .parameters = parameters};
                return read_reference(*input.picture, {&step, 1}, input.picture->width, input.picture->height);
            },
            function};
}
template <ReferenceTapFunction function>
Reference tap_reference() {
    return {[](const void* parameters, const ReferenceInput& input) {
                const ReadingStep step{.tap = function, .parameters = parameters};
                return read_reference(*input.picture, {&step, 1}, input.picture->width, input.picture->height);
            },
            function};
}

}  // namespace darkroom
