// SPDX-License-Identifier: MIT
// Levels in the shared memory of a workgroup, as halves, which hold all that packed floats do. Of each there are the
// texels that the workgroup needs, a tile; what of it lies beyond the level's edge is neither written nor read. Who includes
// this declares `shared uvec2 bloom_shared[]` before, and bloom_tile_of() and bloom_size() behind.
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
