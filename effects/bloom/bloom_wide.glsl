// SPDX-License-Identifier: MIT
// Level 2 with all wider levels on it. A workgroup makes 32x32 texels, for which it makes level 3 from level 2, and level 4
// from level 3, with their neighbours; neither becomes an image. custom[0] = (gain onto level 2, levels in
// use, gain onto level 3).
shared uvec2 bloom_shared[34 * 34 + 14 * 14];

#include "bloom_taps.glsl"
#include "bloom_tile.glsl"
#include "bloom_raise.glsl"

ivec2 bloom_size(int level) {
    return max(size(bloom_level_2) >> (level - 2), ivec2(1));
}

// Where begins what of this level is brought onto the level above?
ivec2 bloom_raised(int level) {
    ivec2 first = 32 * ivec2(gl_WorkGroupID.xy);
    if (level >= 3) first = bloom_first_below(first, bloom_size(3), bloom_size(2));
    if (level >= 4) first = bloom_first_below(first, bloom_size(4), bloom_size(3));
    return first;
}

BloomTile bloom_tile_of(int level) {
    if (level == 4) return BloomTile(34 * 34, 14, bloom_raised(4));
    return BloomTile(0, 34, bloom_first_above(bloom_raised(4), bloom_size(3), bloom_size(4)));
}

vec3 bloom_tap(int from, vec2 place) {
    if (from == 3) return bloom_between(3, place, bloom_size(3), bloom_size(4));
    return sample_linear(bloom_level_2, place * (0.5 / vec2(bloom_size(3)))).rgb;
}

void bloom_put(int level, ivec2 texel, vec3 glow) {
    vec4 light = vec4(glow * (level == 2 ? custom[0].x : custom[0].z), 0.0);
    if (level == 2)
        store(bloom_sum, texel, light + load(bloom_level_2, texel));
    else
        bloom_keep(3, texel, as_stored(bloom_sum, light + vec4(bloom_texel(3, texel), 1.0)).rgb);
}

void bloom_halve(int level, int width, int height) {
    int rounds = (width / 2 * height + bloom_threads - 1) / bloom_threads;
    ivec2 extent = bloom_size(level);
    for (int i = 0; i < rounds; ++i) {
        int pair = i * bloom_threads + int(gl_LocalInvocationIndex);
        ivec2 texel = bloom_tile_of(level).first + ivec2(pair % (width / 2) * 2, pair / (width / 2));
        if (pair >= width / 2 * height || texel.x >= extent.x || texel.y >= extent.y) continue;
        BloomTaps taps[2] = bloom_taps_of_pair(level - 1, texel, bloom_size(level - 1));
        for (int k = 0; k < 2; ++k)
            if (bloom_is_inside(level, texel + ivec2(k, 0)))
                bloom_keep(level, texel + ivec2(k, 0), as_stored(bloom_sum, vec4(bloom_mean_of(taps[k]), 1.0)).rgb);
    }
}

void run() {
    int thread = int(gl_LocalInvocationIndex);
    ivec2 own = bloom_raised(2) + ivec2(thread % 32, thread / 32 * 8);
    if (custom[0].y < 4.0) {
        for (int i = 0; i < 8; ++i) {
            ivec2 texel = own + ivec2(0, i);
            if (bloom_is_inside(2, texel)) store(bloom_sum, texel, load(bloom_level_2, texel));
        }
        return;
    }
    bloom_halve(3, 34, 34);
    barrier();
    if (custom[0].y >= 5.0) {
        bloom_halve(4, 14, 14);
        barrier();
        if (thread < 20 * 5) bloom_raise(3, bloom_raised(3) + ivec2(thread % 20, thread / 20 * 4), 4);
        barrier();
    }
    bloom_raise(2, own, 8);
}
