// A triangle over the whole picture on the far plane, which is at depth 0.
layout(location = 0) out vec2 clip_place;

void main() {
    clip_place = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    gl_Position = vec4(clip_place, 0.0, 1.0);
}
