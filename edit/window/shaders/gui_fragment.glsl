layout(location = 0) in vec2 texel;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

void main() { result = to_target(color * textureLod(first_image, texel, 0.0)); }
