// SPDX-License-Identifier: MIT
#pragma once
// UI chroma in double precision: barrels of red, green and blue differ by +c, 0 and -c, c = strength 1080 / height.

#include <darkroom/effects/ui_chroma.hpp>

#include "shared/reading_reference.hpp"

namespace darkroom {

inline ReferencePlace ui_chroma_reference(const void* parameters, ReferencePlace place) {
    const double difference = double{static_cast<const UiChroma*>(parameters)->strength} * 1080 / place.height;
    place.barrel[0] += difference;
    place.barrel[2] -= difference;
    return place;
}

}  // namespace darkroom
