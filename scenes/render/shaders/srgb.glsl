// IEC 61966-2-1; `linear` is in [0, 1].
vec3 srgb_encode(vec3 linear) {
    vec3 power = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(power, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}
