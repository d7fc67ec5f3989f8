// SPDX-License-Identifier: MIT
// A Gaussian along one axis. custom[0] = (a texel's step, weight of the middle, pairs of taps); then two pairs a vector: how
// many steps away a bilinear tap lies, and what it counts. It is the mean of what is inside the picture: a light on the edge
// is not one that goes on beyond it, and an even picture stays even.

// Of a tap across the edge the texel inside counts, and not the one that the sampler repeats.
vec4 light_tap(vec2 uv, float place, float last, float weight) {
    float inside = weight * max(1.0 - max(max(place - last, -place), 0.0), 0.0);
    return vec4(sample_linear(line_source, uv).rgb, 1.0) * inside;
}

vec4 shade(Pixel pixel) {
    vec4 sum = vec4(sample_linear(line_source, pixel.uv).rgb, 1.0) * custom[0].z;
    bool is_down = custom[0].y > 0.0;
    float place = float(is_down ? pixel.texel.y : pixel.texel.x);
    float last = float((is_down ? pixel.size.y : pixel.size.x) - 1);
    // No place lies below 0; see bloom_between_cells for why the end is asked of the pixel, too.
    int pairs = int(custom[0].w + min(place, 0.0));
    for (int i = 0; i < pairs; ++i) {
        vec2 tap = (i & 1) == 0 ? custom[1 + i / 2].xy : custom[1 + i / 2].zw;
        vec2 reach = custom[0].xy * tap.x;
        sum += light_tap(pixel.uv - reach, place - tap.x, last, tap.y) +
               light_tap(pixel.uv + reach, place + tap.x, last, tap.y);
    }
    return vec4(sum.rgb / sum.a, 1.0);
}
