// SPDX-License-Identifier: MIT
// Any domain. The bend shrinks what it bends outward, so the layer is read larger first.
#include "shared/place.glsl"

Place ui_warp(Place place, UiWarp parameters) {
    precise vec2 uv = (place.uv - 0.5) * (1.0 + 0.5 * abs(parameters.strength)) + 0.5 + parameters.offset;
    place.uv = uv;
    place.barrel += parameters.strength;
    return place;
}
