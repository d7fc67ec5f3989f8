// SPDX-License-Identifier: MIT
// Any domain. custom(0) = (the picture's half size where its half diagonal is 1, scale, taps),
// custom(1) = (coefficients of the squared distance for red, green and blue; of its square).

// 1 in the picture; beyond, it falls to 0 within a pixel.
float lens_distortion_inside(vec2 uv, ivec2 size) {
    vec2 inside = clamp((0.5 - abs(uv - 0.5)) * vec2(size) + 1.0, 0.0, 1.0);
    return inside.x * inside.y;
}

vec4 lens_distortion(Pixel pixel, LensDistortion parameters) {
    vec4 frame = lens_distortion_custom(0), k = lens_distortion_custom(1);
    vec2 from_centre = pixel.uv - 0.5;
    vec2 place = 2.0 * from_centre * frame.xy;
    float squared = dot(place, place);
    vec3 factor = frame.z * (1.0 + squared * (k.rgb + squared * k.a));
    // Green and alpha, then red, then blue: in a loop, which every driver ends early; some do not skip a branch.
    vec4 color = vec4(0.0);
    int taps = int(frame.w), i = 0;
    do {
        vec2 uv = 0.5 + from_centre * (i == 0 ? factor.g : i == 1 ? factor.r : factor.b);
        vec4 tap = sample_linear(picture, uv) * lens_distortion_inside(uv, pixel.size);
        color = i == 0 ? tap : i == 1 ? vec4(tap.r, color.gba) : vec4(color.rg, tap.b, color.a);
    } while (++i < taps);
    return color;
}
