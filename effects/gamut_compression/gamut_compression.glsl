// SPDX-License-Identifier: MIT
// scene_linear or display_linear. NaN counts as 0.

#include "shared/color_state.glsl"
#include "shared/sanitize.glsl"

// ACES 1.3, Reference Gamut Compression, of distances from grey above the threshold: 1 at the limit. The published
// nd / (1 + nd^p)^(1/p) is written with nd^-p, which no distance makes infinite over infinite.
vec3 gamut_compression_curve(vec3 d, GamutCompression parameters) {
    vec3 threshold = parameters.threshold, reach = parameters.limit - threshold, power = vec3(parameters.power);
    vec3 scale = reach / pow(pow((1.0 - threshold) / reach, -power) - 1.0, 1.0 / power);
    vec3 over = max((d - threshold) / scale, vec3(1e-6));
    return threshold + scale * pow(1.0 + pow(over, -power), -1.0 / power);
}

vec4 gamut_compression(vec4 color, Pixel pixel, GamutCompression parameters) {
    color.rgb = sanitize(color).rgb;
    vec3 light = color.rgb;
    uint into = parameters.into;
    if (into == GamutCompression_into_p3) light = color_state_p3 * light;
    if (into == GamutCompression_into_rec2020) light = color_state_rec2020 * light;
    float achromatic = max(max(light.r, light.g), light.b), size = max(abs(achromatic), 1e-12);
    vec3 d = (achromatic - light) / size;
    bvec3 stays = lessThan(d, parameters.threshold);
    if (all(stays)) return color;
    light = mix(achromatic - gamut_compression_curve(d, parameters) * size, light, stays);
    if (into == GamutCompression_into_p3) light = color_state_from_p3 * light;
    if (into == GamutCompression_into_rec2020) light = color_state_from_rec2020 * light;
    return vec4(light, color.a);
}
