// SPDX-License-Identifier: MIT
// Motion of a world that stands still, in pixels, y down, without jitter. custom[0 ... 2] = x, y (down) and w of a moment
// ago, of a point of view space; custom[3], custom[4] = RayConstants; custom[5] = (size, motion by the jitter).
vec4 shade(Pixel pixel) {
    vec2 texel = vec2(pixel.texel);
    // The sky turns with the camera and does not come nearer.
    float planar = 1.0 / max(load(taa_distance, pixel.texel).r, 1e-9);
    vec2 place = (texel * custom[3].xy + custom[3].zw) * planar + texel * custom[4].xy + custom[4].zw;
    vec4 point = vec4(place, -planar, 1.0);
    float w = dot(custom[2], point);
    vec2 before = (vec2(dot(custom[0], point), dot(custom[1], point)) / w * 0.5 + 0.5) * custom[5].xy;
    // What was behind the camera has no place in the last picture.
    return vec4(w > 0.0 ? before - (texel + 0.5) + custom[5].zw : vec2(0.0), 0.0, 1.0);
}
