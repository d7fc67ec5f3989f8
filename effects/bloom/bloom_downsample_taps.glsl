// SPDX-License-Identifier: MIT
// The 13 taps of Jorge Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (2014). Inner taps 1,
// outer taps 2 source texels from the centre, which lies on a corner: each tap averages 2x2 texels.

vec3 bloom_tap(vec2 uv) {
    return sample_linear(bloom_above, uv).rgb;
}

// The taps of all outputs form a grid of one texel's step with every second place empty, like the black squares of a
// chessboard. That is harmless while taps lie between texels. Where both sides of the source are odd, taps drift onto
// texels toward the middle, and every second texel would be lost. There the outer rows are 1 and the inner ones 1.5 texels
// from the centre: with these the sum over w cos(pi x) cos(pi y) of the taps is 0, as it is over w cos(pi x) and over
// w cos(pi y), so no pattern of that kind is left at any phase, and the filter is nearly as wide (variance 1.375, not 1.5).
vec3 bloom_by_taps(Pixel pixel) {
    // Half a texel of the output is one of the source, and a little more on odd sizes.
    ivec2 extent = size(bloom_above);
    bool is_odd = (extent.x & extent.y & 1) == 1;
    vec2 outer = (is_odd ? vec2(1.0, 0.5) : vec2(1.0)) / vec2(pixel.size);
    vec2 inner = (is_odd ? vec2(0.5, 0.75) : vec2(0.5)) / vec2(pixel.size);
    vec2 uv = pixel.uv;
    vec3 corners = bloom_tap(uv - outer) + bloom_tap(uv + outer * vec2(1, -1)) + bloom_tap(uv + outer * vec2(-1, 1)) +
                   bloom_tap(uv + outer);
    vec3 edges = bloom_tap(uv + outer * vec2(0, -1)) + bloom_tap(uv + outer * vec2(-1, 0)) +
                 bloom_tap(uv + outer * vec2(1, 0)) + bloom_tap(uv + outer * vec2(0, 1));
    vec3 middle = bloom_tap(uv - inner) + bloom_tap(uv + inner * vec2(1, -1)) + bloom_tap(uv + inner * vec2(-1, 1)) +
                  bloom_tap(uv + inner) + bloom_tap(uv);
    return corners * 0.03125 + edges * 0.0625 + middle * 0.125;
}
