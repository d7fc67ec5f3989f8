// SPDX-License-Identifier: MIT
#pragma once
// Frame blend in double precision. The first frame of each 1/60 s is kept, as the means of 4 x 4 (2 x 2) pixels. With
// a_i the steps since that of kept frame i began, its weight is w_i = clamp(1 - (a_i - 1) / frames, 0, 1), and the
// result picture (1 - amount) + amount sum(w_i frame_i) / sum(w_i), small frames being sampled bilinearly; kept frames
// that a cut has taken are the picture itself.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/frame_blend.hpp>
#include <darkroom/reference.hpp>
#include <string>
#include <vector>

#include "shared/finite_reference.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {

inline ReferenceImage frame_blend_reference_reduce(const ReferenceImage& picture, std::uint32_t side) {
    ReferenceImage out(std::max(1u, picture.width / side), std::max(1u, picture.height / side), {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (const double right : {0.25, 0.75})
                for (const double down : {0.25, 0.75}) {
                    const Rgba tap = sample_reference(picture, (x + right) / out.width, (y + down) / out.height);
                    Rgba& mean = out.at(x, y);
                    mean = {mean.r + finite_reference(tap.r) / 4, mean.g + finite_reference(tap.g) / 4,
                            mean.b + finite_reference(tap.b) / 4, 1};
                }
    return out;
}

/// Step n, which began at (n - 0.382) / 60 s, is in the history under its number.
inline ReferenceImage frame_blend_reference(const void* parameters, const ReferenceInput& input) {
    const FrameBlend& blend = *static_cast<const FrameBlend*>(parameters);
    ReferenceImage out = *input.picture;
    if (input.history == nullptr) return out;
    struct Kept {
        const ReferenceImage* image = nullptr;
        double weight = 0;
    };
    const double now = input.time * 60 + 0.382;
    std::vector<Kept> kept;
    double sum = 0;
    const auto last = static_cast<std::int64_t>(std::floor(now));
    const auto before = static_cast<std::int64_t>(std::floor((input.time - input.delta_time) * 60 + 0.382));
    for (std::int64_t step = before; step > before - frame_blend_slots; --step) {
        const double weight = std::clamp(1 - (now - static_cast<double>(step) - 1) / blend.frames, 0.0, 1.0);
        sum += weight;
        if (const auto found = input.history->find(std::to_string(step)); found != input.history->end())
            kept.push_back({&found->second, weight});
    }
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& pixel = out.at(x, y);
            Rgba past{0, 0, 0, 0};
            for (const auto& [image, weight] : kept) {
                const double share = sum > 0 ? double{blend.amount} * weight / sum : 0;
                const Rgba tap = sample_reference(*image, (x + 0.5) / out.width, (y + 0.5) / out.height);
                past = {past.r + tap.r * share, past.g + tap.g * share, past.b + tap.b * share, past.a + share};
            }
            pixel = {pixel.r * (1 - past.a) + past.r, pixel.g * (1 - past.a) + past.g, pixel.b * (1 - past.a) + past.b,
                     pixel.a};
        }
    const ReferenceImage small =
        frame_blend_reference_reduce(*input.picture, blend.area == FrameBlendArea::Quarter ? 2 : 4);
    for (std::int64_t step = std::max(before, last - frame_blend_slots) + 1; step <= last; ++step)
        (*input.history)[std::to_string(step)] = small;
    std::erase_if(*input.history,
                  [&](const auto& image) { return std::stoll(image.first) <= last - frame_blend_slots; });
    return out;
}

}  // namespace darkroom
