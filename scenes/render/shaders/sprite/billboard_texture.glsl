// The texture of a billboard, within its frame of the atlas: the filter takes nothing from the neighbouring frames.
// Needs frame.glsl and billboard_varyings.glsl.
layout(set = 1, binding = 0) uniform sampler2D billboard_texture;

vec4 billboard_texel(Varyings square) {
    float gradient_scale = 1.0 + frame.camera_forward.w;
    vec2 along_x = dFdx(square.uv) * gradient_scale, along_y = dFdy(square.uv) * gradient_scale;
    // Half a texel of the mip level that will be read.
    vec2 reach = max(0.5 / vec2(textureSize(billboard_texture, 0)), 0.5 * max(abs(along_x), abs(along_y)));
    vec2 low = min(square.uv_frame.xy, square.uv_frame.zw), high = max(square.uv_frame.xy, square.uv_frame.zw);
    reach = min(reach, 0.5 * (high - low));
    return textureGrad(billboard_texture, clamp(square.uv, low + reach, high - reach), along_x, along_y);
}
