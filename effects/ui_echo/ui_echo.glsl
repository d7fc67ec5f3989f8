// SPDX-License-Identifier: MIT
// Any domain: light is added, and alpha is the larger one. Channels do not part in the ghost.
#include "shared/place.glsl"

vec4 ui_echo(vec4 color, Place place, UiEcho parameters) {
    vec2 uv = (place.uv - 0.5) / parameters.size + 0.5;
    vec4 ghost = ui_echo_read(barrel(uv, place.barrel.g)) * parameters.strength;
    return vec4(color.rgb + ghost.rgb, max(color.a, ghost.a));
}
