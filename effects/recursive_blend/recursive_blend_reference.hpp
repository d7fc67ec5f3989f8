// SPDX-License-Identifier: MIT
#pragma once
// Recursive blend in double precision: result = picture (1 - k) + last result k, k = weight^(60 dt); in 8 bits the
// result is clamped to [0, 1] and rounded to the nearest of 256 steps, half up. Without a last result it is the
// picture.

#include <algorithm>
#include <cmath>
#include <darkroom/effects/recursive_blend.hpp>
#include <darkroom/reference.hpp>

#include "shared/finite_reference.hpp"

namespace darkroom {

inline ReferenceImage recursive_blend_reference(const void* parameters, const ReferenceInput& input) {
    const RecursiveBlend& blend = *static_cast<const RecursiveBlend*>(parameters);
    const bool is_coarse = blend.precision == RecursiveBlendPrecision::EightBit;
    const ReferenceImage* past = nullptr;
    if (input.history != nullptr && input.history->contains("trail")) past = &input.history->at("trail");
    const double kept = past == nullptr ? 0 : std::pow(double{blend.weight}, 60 * input.delta_time);
    ReferenceImage out = *input.picture;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const auto mixed = [&](double Rgba::*channel) {
            const double before = past == nullptr ? 0 : past->pixels[i].*channel;
            const double value = finite_reference(out.pixels[i].*channel) * (1 - kept) + before * kept;
            // A double is as little 9/10 as a float is: the tie is where the shader has it.
            return is_coarse ? std::floor(std::clamp(value, 0.0, 1.0) * 255 + 0.5 + 1.0 / 4096) / 255 : value;
        };
        out.pixels[i] = {mixed(&Rgba::r), mixed(&Rgba::g), mixed(&Rgba::b), finite_reference(out.pixels[i].a)};
    }
    if (input.history != nullptr) (*input.history)["trail"] = out;
    return out;
}

}  // namespace darkroom
