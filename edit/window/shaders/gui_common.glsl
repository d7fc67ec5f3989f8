// What the shaders of the interface share. Colours of the lists are sRGB-encoded.
// What the attachment takes: codes of sRGB; light, which its format encodes; scRGB; PQ; HLG, of a display of this peak.
layout(constant_id = 0) const uint target = 0;
layout(constant_id = 1) const float target_peak = 203.0;
const uint target_linear = 1, target_scrgb = 2, target_pq = 3, target_hlg = 4;
const float white_nits = 203.0;
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

// SMPTE ST 2084, of cd/m2; ITU-R BT.2100's HLG, of light relative to the peak.
vec3 pq_encode(vec3 nits) {
    vec3 y = pow(clamp(nits / 10000.0, 0.0, 1.0), vec3(2610.0 / 16384.0));
    return pow((107.0 / 128.0 + 2413.0 / 128.0 * y) / (1.0 + 2392.0 / 128.0 * y), vec3(2523.0 / 32.0));
}
vec3 hlg_encode(vec3 light) {
    light = clamp(light, 0.0, 1.0);
    // Table 5, and beyond its range the extended formula of ITU-R BT.2390.
    float octaves = log2(target_peak / 1000.0);
    bool is_in_range = target_peak >= 400.0 && target_peak <= 2000.0;
    float ootf = is_in_range ? 1.2 + 0.42 * log(2.0) / log(10.0) * octaves : 1.2 * pow(1.111, octaves);
    vec3 scene = light * pow(max(dot(light, vec3(0.2627, 0.6780, 0.0593)), 1e-9), (1.0 - ootf) / ootf);
    vec3 power = 0.17883277 * log(max(12.0 * scene - 0.28466892, vec3(1e-6))) + 0.55991073;
    return mix(power, sqrt(3.0 * scene), lessThanEqual(scene, vec3(1.0 / 12.0)));
}

// Codes may go beyond 1 where the attachment has a higher range.
vec4 to_target(vec4 encoded) {
    if (target == 0) return encoded;
    vec3 light = srgb_decode(encoded.rgb);
    if (target == target_linear) return vec4(light, encoded.a);
    vec3 nits = min(light * white_nits, target_peak);
    if (target == target_scrgb) return vec4(nits / 80.0, encoded.a);
    // ITU-R BT.2087.
    nits = mat3(0.627403896, 0.069097289, 0.016391439, 0.329283038, 0.919540395, 0.088013308, 0.043313066, 0.011362316,
                0.895595253) * nits;
    return vec4(target == target_pq ? pq_encode(nits) : hlg_encode(nits / target_peak), encoded.a);
}
// The largest code of light that is shown.
float largest_code() { return target >= target_scrgb ? srgb_encode(target_peak / white_nits) : 1.0; }
