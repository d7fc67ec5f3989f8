// SPDX-License-Identifier: MIT
// Level 0 to levels 1 and 2. A workgroup makes 32x32 texels of level 1 and the 16x16 of level 2 under them, for which it
// makes the neighbours of the former, too: 38x38 where the levels' sides are odd. custom[0].y = levels in use, 2 or more.
shared uvec2 bloom_shared[38 * 38];

#include "bloom_taps.glsl"
#include "bloom_tile.glsl"

ivec2 bloom_size(int level) {
    return level == 1 ? size(bloom_level_1) : size(bloom_level_2);
}

ivec2 bloom_own(int level) {
    return ivec2(gl_WorkGroupID.xy) * (level == 1 ? 32 : 16);
}

BloomTile bloom_tile_of(int level) {
    return BloomTile(0, 38, bloom_first_above(bloom_own(2), bloom_size(1), bloom_size(2)));
}

vec3 bloom_tap(int from, vec2 place) {
    if (from == 1) return bloom_between(1, place, bloom_size(1), bloom_size(2));
    return sample_linear(bloom_level_0, place * (0.5 / vec2(bloom_size(1)))).rgb;
}

void bloom_put_first(ivec2 texel, vec3 color) {
    if (!bloom_is_inside(1, texel)) return;
    bloom_keep(1, texel, as_stored(bloom_level_1, vec4(color, 1.0)).rgb);
    ivec2 place = texel - bloom_own(1);
    if (all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, ivec2(32))))
        store(bloom_level_1, texel, vec4(color, 1.0));
}

void bloom_put_second(ivec2 texel, vec3 color) {
    if (bloom_is_inside(2, texel)) store(bloom_level_2, texel, vec4(color, 1.0));
}

void run() {
    int thread = int(gl_LocalInvocationIndex);
    for (int i = 0; i < 6; ++i) {
        int pair = i * bloom_threads + thread;
        ivec2 texel = bloom_tile_of(1).first + ivec2(pair % 19 * 2, pair / 19);
        if (pair >= 19 * 38 || texel.x >= bloom_size(1).x || texel.y >= bloom_size(1).y) continue;
        BloomTaps taps[2] = bloom_taps_of_pair(0, texel, size(bloom_level_0));
        bloom_put_first(texel, bloom_mean_of(taps[0]));
        bloom_put_first(texel + ivec2(1, 0), bloom_mean_of(taps[1]));
    }
    barrier();
    ivec2 texel = bloom_own(2) + ivec2(thread % 8 * 2, thread / 8);
    if (texel.x >= bloom_size(2).x || texel.y >= bloom_size(2).y) return;
    if (custom[0].y < 3.0) {
        bloom_put_second(texel, vec3(0.0));
        bloom_put_second(texel + ivec2(1, 0), vec3(0.0));
        return;
    }
    BloomTaps taps[2] = bloom_taps_of_pair(1, texel, bloom_size(1));
    bloom_put_second(texel, bloom_mean_of(taps[0]));
    bloom_put_second(texel + ivec2(1, 0), bloom_mean_of(taps[1]));
}
