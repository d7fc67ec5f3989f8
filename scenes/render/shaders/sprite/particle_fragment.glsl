// Particles: unlit, and blended as light that alpha has weighed; without a texture a soft round disc.
#include "frame.glsl"
#include "sprite/billboard_varyings.glsl"
#include "sprite/billboard_texture.glsl"
#include "output.glsl"

layout(location = 0) in Varyings square;
layout(location = 0) out vec4 color;

void main() {
    vec4 texel = billboard_texel(square) * square.tint;
    float inside = max(1.0 - dot(square.disc, square.disc), 0.0);
    vec4 finished = finish(texel.rgb, texel.a * inside * inside);
    color = vec4(finished.rgb, square.covers) * finished.a;
}
