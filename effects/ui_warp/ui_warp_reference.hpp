// SPDX-License-Identifier: MIT
#pragma once
// UI warp in double precision: u = (p - 1/2) (1 + |s| / 2) + 1/2 + offset, then the barrel of strength s.

#include <cmath>
#include <darkroom/effects/ui_warp.hpp>

#include "shared/reading_reference.hpp"

namespace darkroom {

inline ReferencePlace ui_warp_reference(const void* parameters, ReferencePlace place) {
    const UiWarp& values = *static_cast<const UiWarp*>(parameters);
    const double scale = 1 + 0.5 * std::abs(double{values.strength});
    place.u = (place.u - 0.5) * scale + 0.5 + double{values.offset.x};
    place.v = (place.v - 0.5) * scale + 0.5 + double{values.offset.y};
    for (double& strength : place.barrel) strength += double{values.strength};
    return place;
}

}  // namespace darkroom
