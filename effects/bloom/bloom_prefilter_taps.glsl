// SPDX-License-Identifier: MIT
// The 13 taps of the prefilter.

// The taps, cleaned; of the four inner ones only the sum is used.
struct BloomTaps {
    vec3 top_left, top, top_right;
    vec3 left, centre, right;
    vec3 bottom_left, bottom, bottom_right;
    vec3 middle;
};

vec3 bloom_tap(vec2 uv) {
    return sanitize_light(sample_linear(bloom_source, uv).rgb);
}

BloomTaps bloom_by_taps(Pixel pixel) {
    // Half a texel of the output is one of the source, and a little more on odd sizes; there, see bloom_downsample.glsl.
    ivec2 extent = size(bloom_source);
    bool is_odd = (extent.x & extent.y & 1) == 1;
    vec2 outer = (is_odd ? vec2(1.0, 0.5) : vec2(1.0)) / vec2(pixel.size);
    vec2 inner = (is_odd ? vec2(0.5, 0.75) : vec2(0.5)) / vec2(pixel.size);
    vec2 uv = pixel.uv;
    BloomTaps taps;
    taps.top_left = bloom_tap(uv - outer);
    taps.top = bloom_tap(uv + outer * vec2(0, -1));
    taps.top_right = bloom_tap(uv + outer * vec2(1, -1));
    taps.left = bloom_tap(uv + outer * vec2(-1, 0));
    taps.centre = bloom_tap(uv);
    taps.right = bloom_tap(uv + outer * vec2(1, 0));
    taps.bottom_left = bloom_tap(uv + outer * vec2(-1, 1));
    taps.bottom = bloom_tap(uv + outer * vec2(0, 1));
    taps.bottom_right = bloom_tap(uv + outer);
    taps.middle = bloom_tap(uv - inner) + bloom_tap(uv + inner * vec2(1, -1)) + bloom_tap(uv + inner * vec2(-1, 1)) +
                  bloom_tap(uv + inner);
    return taps;
}
