// Two scales and two offsets: from Dear ImGui's coordinates to clip space.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 color;
layout(location = 0) out vec2 texel_out;
layout(location = 1) out vec4 color_out;

void main() {
    texel_out = texel;
    color_out = color;
    gl_Position = vec4(position * block.scale + block.offset, 0.0, 1.0);
}
