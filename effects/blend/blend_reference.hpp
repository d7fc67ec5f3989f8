// SPDX-License-Identifier: MIT
#pragma once
// Blend in double precision: c' = c + (mode(c, second) - c) * amount.

#include <darkroom/effects/blend.hpp>
#include <darkroom/reference.hpp>

#include "shared/blend_modes_reference.hpp"

namespace darkroom {

inline ReferenceImage blend_image_reference(const void* parameters, const ReferenceInput& input) {
    const Blend& values = *static_cast<const Blend*>(parameters);
    const double amount = values.amount;
    ReferenceImage out = *input.picture;
    if (input.second == nullptr) return out;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& base = out.at(x, y);
            const Rgba blended = blend_reference(base, input.second->clamped(x, y), values.mode);
            base.r += (blended.r - base.r) * amount;
            base.g += (blended.g - base.g) * amount;
            base.b += (blended.b - base.b) * amount;
        }
    }
    return out;
}

}  // namespace darkroom
