// One square that faces the camera, six vertices of an instance.
#include "frame.glsl"
#include "sprite/billboard_varyings.glsl"

layout(location = 0) in vec4 place;           // world position of the anchor; w: width
layout(location = 1) in vec4 previous_place;  // a moment ago; w: height
layout(location = 2) in vec4 tint;
layout(location = 3) in vec4 uv_frame;  // left, top, right, bottom
layout(location = 4) in vec3 settings;  // anchor: 0 bottom edge, 1 top edge; 1: a disc without texture; 0: is added

layout(location = 0) out Varyings to_fragment;

vec3 row(mat4 m, int i) { return vec3(m[0][i], m[1][i], m[2][i]); }

/// Right and up of the previous camera, out of its matrix: rows 0 and 1 are these, scaled, plus what an off-center
/// projection adds along the direction of view, which is row 3 (0 for an orthographic camera).
mat2x3 previous_axes() {
    vec3 along = row(frame.previous_view_projection, 3);
    float square = max(dot(along, along), 1e-12);
    vec3 right = row(frame.previous_view_projection, 0);
    vec3 up = row(frame.previous_view_projection, 1) * sign(frame.projection[1].y);
    right -= along * (dot(right, along) / square);
    up -= along * (dot(up, along) / square);
    return mat2x3(normalize(right), normalize(up));
}

void main() {
    const vec2 corners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));
    vec2 corner = corners[gl_VertexIndex];  // y up
    vec2 offset = (corner - vec2(0.5, settings.x)) * vec2(place.w, previous_place.w);
    vec3 position = place.xyz + mat2x3(row(frame.view, 0), row(frame.view, 1)) * offset;
    gl_Position = frame.view_projection * vec4(position, 1.0);

    to_fragment.tint = tint;
    to_fragment.uv_frame = uv_frame;
    to_fragment.uv = mix(uv_frame.xw, uv_frame.zy, corner);
    to_fragment.disc = settings.y == 0.0 ? vec2(0) : corner * 2.0 - 1.0;
    to_fragment.covers = settings.z;
    to_fragment.clip = gl_Position;
    vec3 previous = previous_place.xyz + previous_axes() * offset;
    to_fragment.previous_clip = frame.previous_view_projection * vec4(previous, 1.0);
}
