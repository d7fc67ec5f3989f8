// What the shaders of the interface share. Colours of the lists are sRGB-encoded.
layout(constant_id = 0) const uint target_is_linear = 0;
layout(set = 0, binding = 0) uniform sampler2D first_image;
layout(set = 0, binding = 1) uniform sampler2D second_image;

struct View {
    vec4 region;  // origin and size, in texture coordinates of the whole image
    uint transfer;
    float low;
    float high;
    float unused;
};
layout(push_constant) uniform Block {
    vec2 scale;
    vec2 offset;
    View first;
    View second;
    float divider;
    float exposure;  // a multiplier
    uint channels;
    uint flags;
}
block;

// IEC 61966-2-1; values below 0 and above 1 go on along the same formulas.
float srgb_decode(float code) { return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4); }
float srgb_encode(float linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}
vec3 srgb_decode(vec3 c) { return vec3(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)); }
vec3 srgb_encode(vec3 c) { return vec3(srgb_encode(c.r), srgb_encode(c.g), srgb_encode(c.b)); }

// An attachment with an sRGB format encodes what it is given.
vec4 to_target(vec4 encoded) {
    return target_is_linear != 0 ? vec4(srgb_decode(encoded.rgb), encoded.a) : encoded;
}
