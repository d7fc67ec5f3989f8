// SPDX-License-Identifier: MIT
// @effect duotone: Maps shadows and highlights to two colours.
// @accepts display_linear
// @param float amount = 1 in [0, 1] amount: Share of the toned picture.
// @param rgb shadow = 0.02, 0.05, 0.15 in [0, 4]: Colour of the shadows.
// @param rgb highlight = 1, 0.85, 0.6 in [0, 4]: Colour of the highlights.
// @param choice weight = luminance | maximum: Quantity that decides between the two colours.

// Rec. 709 luminance (ITU-R BT.709-6, item 3.2), or the largest channel.
float duotone_weight(vec3 color, uint weight) {
    if (weight == Duotone_weight_maximum) return max(color.r, max(color.g, color.b));
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

vec4 duotone(vec4 color, Pixel pixel, Duotone parameters) {
    float weight = clamp(duotone_weight(color.rgb, parameters.weight), 0.0, 1.0);
    vec3 toned = mix(parameters.shadow, parameters.highlight, weight);
    return vec4(mix(color.rgb, toned, parameters.amount), color.a);
}
