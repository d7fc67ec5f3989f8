// SPDX-License-Identifier: MIT
// One direction of a 5 x 5 Gaussian, over pixels whose distance, in alpha, is like this one's.

vec4 volumetric_tap(Pixel pixel, ivec2 offset) {
    return load_clamped(volumetric_light, pixel.texel + offset);
}

// What the next pixel of the quad has, in the blur's direction.
vec4 volumetric_next(vec4 value, ivec2 axis) {
    return axis.x != 0 ? from_beside(value) : from_below(value);
}

vec4 volumetric_blur(Pixel pixel, ivec2 axis) {
    // Of the pixels on both sides, those away from the other one of the quad come first.
    vec4 own = volumetric_tap(pixel, ivec2(0)), taps[4];
    ivec2 away = axis * (has_quads ? 2 * (pixel.texel & 1) - 1 : ivec2(1));
    taps[0] = volumetric_tap(pixel, away);
    taps[1] = volumetric_tap(pixel, 2 * away);
    if (has_quads) {
        taps[2] = volumetric_next(own, axis);
        taps[3] = volumetric_next(taps[0], axis);
    } else {
        taps[2] = volumetric_tap(pixel, -away);
        taps[3] = volumetric_tap(pixel, -2 * away);
    }
    float falloff = 10.0 / max(own.a, 1e-3);
    vec4 sum = vec4(own.rgb, 1.0);
    for (int i = 0; i < 4; ++i) {
        float like = max(1.0 - falloff * abs(taps[i].a - own.a), 0.0);
        sum += vec4(taps[i].rgb, 1.0) * (like * (i % 2 == 0 ? exp(-0.2) : exp(-0.8)));
    }
    return vec4(sum.rgb / sum.a, own.a);
}
