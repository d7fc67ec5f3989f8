// SPDX-License-Identifier: MIT
// The wider levels onto levels 1 and 0. A workgroup makes 64x32 texels of level 0, in their place, for which it makes those
// of level 1 with their neighbours. custom[0] = (gain onto level 0, not used, gain onto level
// 1).
shared uvec2 bloom_shared[36 * 21 + 22 * 14];

#include "bloom_tile.glsl"
#include "bloom_raise.glsl"

ivec2 bloom_size(int level) {
    return level == 0 ? size(bloom_level_0) : level == 1 ? size(bloom_level_1) : size(bloom_sum);
}

ivec2 bloom_raised(int level) {
    ivec2 first = ivec2(64, 32) * ivec2(gl_WorkGroupID.xy);
    if (level >= 1) first = bloom_first_below(first, bloom_size(1), bloom_size(0));
    if (level >= 2) first = bloom_first_below(first, bloom_size(2), bloom_size(1));
    return first;
}

BloomTile bloom_tile_of(int level) {
    return level == 1 ? BloomTile(0, 36, bloom_raised(1)) : BloomTile(36 * 21, 22, bloom_raised(2));
}

void bloom_put(int level, ivec2 texel, vec3 glow) {
    vec4 light = vec4(glow * (level == 0 ? custom[0].x : custom[0].z), 0.0);
    if (level == 0)
        store(bloom_level_0, texel, light);
    else
        bloom_keep(1, texel, as_stored(bloom_level_0, light + load(bloom_level_1, texel)).rgb);
}

void run() {
    int thread = int(gl_LocalInvocationIndex);
    for (int i = 0; i < 2; ++i) {
        int place = i * bloom_threads + thread;
        ivec2 texel = bloom_raised(2) + ivec2(place % 22, place / 22);
        if (place < 22 * 14 && bloom_is_inside(2, texel)) bloom_keep(2, texel, load(bloom_sum, texel).rgb);
    }
    barrier();
    if (thread < 36 * 7) bloom_raise(1, bloom_raised(1) + ivec2(thread % 36, thread / 36 * 3), 3);
    barrier();
    bloom_raise(0, bloom_raised(0) + ivec2(thread % 64, thread / 64 * 8), 8);
}
