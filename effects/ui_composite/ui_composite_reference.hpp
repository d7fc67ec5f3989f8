// SPDX-License-Identifier: MIT
#pragma once
// UI composite in double precision. With opacity o in [0.1, 1], additivity k and w = a o (1 - k):
// c' = c (1 - w) + ui o (1 - 0.3 k).

#include <algorithm>
#include <darkroom/effects/ui_composite.hpp>
#include <darkroom/reference.hpp>

namespace darkroom {

inline Rgba ui_composite_reference(const Rgba& picture, const Rgba& layer, const UiComposite& values) {
    const double opacity = std::clamp(double{values.ui_opacity}, 0.1, 1.0), additive = double{values.additive};
    const double weight = std::clamp(layer.a * opacity * (1 - additive), 0.0, 1.0);
    const double light = opacity * (1 - 0.3 * additive);
    const auto over = [&](double base, double own) { return (weight < 1 ? base * (1 - weight) : 0) + own * light; };
    return {over(picture.r, layer.r), over(picture.g, layer.g), over(picture.b, layer.b),
            picture.a * (1 - weight) + weight};
}

inline ReferenceImage ui_composite_reference(const void* parameters, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    if (input.second == nullptr) return out;
    const UiComposite& values = *static_cast<const UiComposite*>(parameters);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = ui_composite_reference(out.at(x, y), input.second->clamped(x, y), values);
    return out;
}

}  // namespace darkroom
