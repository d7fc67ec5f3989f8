// SPDX-License-Identifier: MIT
// Any domain. Alpha is read with green.
#include "shared/place.glsl"

Place ui_chroma(Place place, UiChroma parameters) {
    float difference = parameters.strength * (1080.0 / float(output_size().y));
    place.barrel += vec3(difference, 0.0, -difference);
    return place;
}
