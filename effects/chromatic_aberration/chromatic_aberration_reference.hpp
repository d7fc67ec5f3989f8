// SPDX-License-Identifier: MIT
#pragma once
// Chromatic aberration in double precision: red from uv + 0.012 a (uv - 0.5), blue from uv - 0.012 a (uv - 0.5).

#include <darkroom/effects/chromatic_aberration.hpp>
#include <darkroom/reference.hpp>

#include "shared/sample_reference.hpp"

namespace darkroom {

inline ReferenceImage chromatic_aberration_reference(const void* parameters, const ReferenceInput& input) {
    const double scale = 0.012 * double{static_cast<const ChromaticAberration*>(parameters)->chromatic_aberration};
    ReferenceImage out = *input.picture;
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) / out.width, v = (y + 0.5) / out.height;
            out.at(x, y).g = finite_reference(out.at(x, y).g);
            out.at(x, y).r = finite_sample_reference(*input.picture, u + (u - 0.5) * scale, v + (v - 0.5) * scale).r;
            out.at(x, y).b = finite_sample_reference(*input.picture, u - (u - 0.5) * scale, v - (v - 0.5) * scale).b;
        }
    }
    return out;
}

}  // namespace darkroom
