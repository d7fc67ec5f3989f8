// The square of the grid on y = 0, 40 m wide.
#include "frame.glsl"
layout(location = 0) out vec2 place;  // x and z, metres

void main() {
    const float half_width = 20.0;
    place = (vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0) * half_width;
    gl_Position = frame.view_projection * vec4(place.x, 0.0, place.y, 1.0);
}
