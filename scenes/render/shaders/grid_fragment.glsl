// Lines every metre, a pixel wide at any distance. They are drawn on a surface, and not as lines, so that the depth
// bias of a surface sets them behind a floor in the same plane.
#include "frame.glsl"
#include "output.glsl"

layout(location = 0) in vec2 place;
layout(location = 0) out vec4 color;

void main() {
    vec2 pixel = max(fwidth(place), vec2(1e-6));
    vec2 distance_to_line = abs(place - round(place)) / pixel;  // pixels
    vec2 cover = clamp(1.0 - distance_to_line, 0.0, 1.0);
    float alpha = 0.5 * max(cover.x, cover.y);
    if (alpha == 0.0) discard;
    color = finish(vec3(0.3), alpha);
}
