// Lines of one colour, without motion or normal: edges of meshes and normal arrows.
layout(location = 0) flat in vec4 line_color;
layout(location = 0) out vec4 out_color;

void main() { out_color = line_color; }
