// SPDX-License-Identifier: MIT
#pragma once
// UI echo in double precision: e = (u - 1/2) / size + 1/2, bent as green is; c' = c + k c(e), a' = max(a, k a(e)).

#include <algorithm>
#include <darkroom/effects/ui_echo.hpp>

#include "shared/reading_reference.hpp"

namespace darkroom {

inline Rgba ui_echo_reference(const void* parameters, Rgba color, const ReferencePlace& place,
                              const ReferenceSampler& read) {
    const UiEcho& values = *static_cast<const UiEcho*>(parameters);
    const double size = double{values.size}, strength = double{values.strength};
    const ReferenceUv uv =
        barrel_reference((place.u - 0.5) / size + 0.5, (place.v - 0.5) / size + 0.5, place.barrel[1]);
    const Rgba ghost = read(uv.u, uv.v);
    return {color.r + ghost.r * strength, color.g + ghost.g * strength, color.b + ghost.b * strength,
            std::max(color.a, ghost.a * strength)};
}

}  // namespace darkroom
