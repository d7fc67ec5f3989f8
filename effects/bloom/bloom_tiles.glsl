// SPDX-License-Identifier: MIT
#part narrow
shared uvec2 bloom_shared[38 * 38];

#part wide
shared uvec2 bloom_shared[34 * 34 + 14 * 14];

#part join
shared uvec2 bloom_shared[36 * 21 + 22 * 14];

#part narrow wide
#include "bloom_taps.glsl"

#part narrow wide join
// Levels in the shared memory of a workgroup, as halves, which hold all that packed floats do. Of each there are the
// texels that the workgroup needs, a tile; what of it lies beyond the level's edge is neither written nor read.
#include "bloom_texels.glsl"

struct BloomTile {
    int base, width;  // where it begins in bloom_shared, and texels in a row
    ivec2 first;
};
BloomTile bloom_tile_of(int level);
ivec2 bloom_size(int level);

const int bloom_threads = int(gl_WorkGroupSize.x);

int bloom_index(int level, ivec2 texel) {
    BloomTile tile = bloom_tile_of(level);
    ivec2 place = texel - tile.first;
    return tile.base + place.y * tile.width + place.x;
}

vec3 bloom_at(int place) {
    uvec2 halves = bloom_shared[place];
    return vec3(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y).x);
}

vec3 bloom_texel(int level, ivec2 texel) {
    return bloom_at(bloom_index(level, texel));
}

void bloom_keep(int level, ivec2 texel, vec3 color) {
    bloom_shared[bloom_index(level, texel)] = uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, 0.0)));
}

bool bloom_is_inside(int level, ivec2 texel) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, bloom_size(level)));
}

// The first texel that a tile which begins at `first` needs of the level above, and of the one below.
ivec2 bloom_first_above(ivec2 first, ivec2 above, ivec2 own) {
    return ivec2(floor(vec2(2 * first - 1) * (0.5 * vec2(above) / vec2(own)) - 0.5));
}
ivec2 bloom_first_below(ivec2 first, ivec2 below, ivec2 own) {
    return ivec2(floor(bloom_below_at(first, below, own))) - 1;
}

#part wide join
// The level below, in a tile, onto up to 8 texels of a column: each row of the level below is weighed once. bloom_put()
// takes the glow that a texel gets.
void bloom_put(int level, ivec2 texel, vec3 glow);

void bloom_raise(int level, ivec2 first, const int count) {
    ivec2 own = bloom_size(level), below = bloom_size(level + 1);
    if (first.x < 0 || first.x >= own.x) return;
    vec2 place = bloom_below_at(first, below, own), low = floor(place);
    ivec2 from = ivec2(low) - 1;
    int width = bloom_tile_of(level + 1).width, origin = bloom_index(level + 1, ivec2(0));
    ivec4 columns = origin + clamp(from.x + ivec4(0, 1, 2, 3), 0, below.x - 1);
    // The last level may have less than the whole tent.
    float tent = level + 2 == int(custom[0].y) ? custom[0].w : 1.0;
    vec4 x = bloom_weights(place.x - low.x, tent);
    vec3 rows[8];
    for (int i = 0; i < count / 2 + 4; ++i) {
        ivec4 at = columns + clamp(from.y + i, 0, below.y - 1) * width;
        rows[i] = bloom_weighed(bloom_at(at.x), bloom_at(at.y), bloom_at(at.z), bloom_at(at.w), x);
    }
    for (int i = 0; i < count; ++i) {
        ivec2 texel = first + ivec2(0, i);
        float y = bloom_below_at(texel, below, own).y, low_y = floor(y);
        // Two texels are one row of the level below or, where its size was floored, a little less. So the four rows of
        // this texel begin at this one or at the next.
        int next = max((i + 1) / 2 - 1, 0);
        vec4 w = bloom_weights(y - low_y, tent);
        bool is_next = int(low_y) - 1 > from.y + next;
        vec4 early = is_next ? vec4(0.0, w.xyz) : w;
        vec3 glow = bloom_weighed(rows[next], rows[next + 1], rows[next + 2], rows[next + 3], early) +
                    rows[next + 4] * (is_next ? w.w : 0.0);
        if (texel.y >= 0 && texel.y < own.y) bloom_put(level, texel, glow);
    }
}

#part narrow
// Level 0 to levels 1 and 2. A workgroup makes 32x32 texels of level 1 and the 16x16 of level 2 under them, for which it
// makes the neighbours of the former, too: 38x38 where the levels' sides are odd. custom[0].y = levels in use, 2 or more.

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
        BloomTaps taps[2] = bloom_taps_of_pair(0, texel, bloom_rows(size(bloom_level_0)));
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
    BloomTaps taps[2] = bloom_taps_of_pair(1, texel, bloom_rows(bloom_size(1)));
    bloom_put_second(texel, bloom_mean_of(taps[0]));
    bloom_put_second(texel + ivec2(1, 0), bloom_mean_of(taps[1]));
}

#part wide
// Level 2 with all wider levels on it. A workgroup makes 32x32 texels, for which it makes level 3 from level 2, and level 4
// from level 3, with their neighbours; neither becomes an image. custom[0] = (gain onto level 2, levels in
// use, gain onto level 3, tent of the last one).

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
        BloomTaps taps[2] = bloom_taps_of_pair(level - 1, texel, bloom_rows(bloom_size(level - 1)));
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

#part join
// The wider levels onto levels 1 and 0. A workgroup makes 64x32 texels of level 0, in their place, for which it makes those
// of level 1 with their neighbours. custom[0] = (gain onto level 0, levels in use, gain onto
// level 1, tent of the last one).

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
