// SPDX-License-Identifier: MIT
// The level below, in a tile, onto up to 8 texels of a column: each row of the level below is weighed once. Who includes this
// defines bloom_put(), which takes the glow that a texel gets.
void bloom_put(int level, ivec2 texel, vec3 glow);

void bloom_raise(int level, ivec2 first, const int count) {
    ivec2 own = bloom_size(level), below = bloom_size(level + 1);
    if (first.x < 0 || first.x >= own.x) return;
    vec2 place = bloom_below_at(first, below, own), low = floor(place);
    ivec2 from = ivec2(low) - 1;
    int width = bloom_tile_of(level + 1).width, origin = bloom_index(level + 1, ivec2(0));
    ivec4 columns = origin + clamp(from.x + ivec4(0, 1, 2, 3), 0, below.x - 1);
    vec4 x = bloom_weights(place.x - low.x);
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
        vec4 w = bloom_weights(y - low_y);
        bool is_next = int(low_y) - 1 > from.y + next;
        vec4 early = is_next ? vec4(0.0, w.xyz) : w;
        vec3 glow = bloom_weighed(rows[next], rows[next + 1], rows[next + 2], rows[next + 3], early) +
                    rows[next + 4] * (is_next ? w.w : 0.0);
        if (texel.y >= 0 && texel.y < own.y) bloom_put(level, texel, glow);
    }
}
