// Sprites: unlit, opaque where their texture is, and like any surface in depth and motion. Without a normal: they do not occlude.
#include "frame.glsl"
#include "sprite/billboard_varyings.glsl"
#include "sprite/billboard_texture.glsl"
#include "output.glsl"

layout(location = 0) in Varyings square;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec2 velocity;

void main() {
    vec4 texel = billboard_texel(square) * square.tint;
    if (texel.a < 0.5) discard;
    color = finish(texel.rgb, 1.0);
    normal = vec4(0.0, 0.0, 0.0, 1.0);
    velocity = motion(square.clip, square.previous_clip);
}
