// SPDX-License-Identifier: MIT
// Code values. The side image film_grain_tile holds grain on three tones, with its last texel before its first and its
// first behind its last. film_grain_custom(0): texels a pixel, the frame's number, and twice what a texel's correlation
// with the next one lacks, across and down; (1): gains of the tones; (2): their means.

const float film_grain_tile_size = 256.0;

// PCG in two dimensions: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
uvec2 film_grain_hash(uvec2 value) {
    value = value * 1664525u + 1013904223u;
    for (int i = 0; i < 2; ++i) {
        value.x += value.y * 1664525u;
        value.y += value.x * 1664525u;
        value ^= value >> 16u;
    }
    return value;
}

// The grain of the tones at a place of the tile. What is read between texels is less uneven than they are: by the variance of
// a mix of two whose correlation is known.
vec3 film_grain_at(vec2 place) {
    place -= film_grain_tile_size * floor(place / film_grain_tile_size);
    vec2 between = fract(place - 0.5);
    vec2 kept = 1.0 - film_grain_custom(0).zw * between * (1.0 - between);
    vec3 tones = sample_linear(film_grain_tile, (place + 1.0) / (film_grain_tile_size + 2.0)).rgb;
    return (tones - film_grain_custom(2).rgb) * inversesqrt(kept.x * kept.y);
}

// Of a code value: linear between the tones, and to black and white, which have none.
float film_grain_on(float value, vec3 grain) {
    return dot(max(1.0 - abs(4.0 * value - vec3(1.0, 2.0, 3.0)), 0.0) * film_grain_custom(1).rgb, grain);
}

vec4 film_grain(vec4 color, Pixel pixel, FilmGrain parameters) {
    vec2 place = (vec2(pixel.texel) + 0.5) * film_grain_custom(0).x;
    // Each repetition of the tile begins elsewhere in it, so that the eye finds no period.
    vec2 cell = floor(place / film_grain_tile_size);
    uvec2 shift = film_grain_hash(uvec2(cell) + uvec2(film_grain_custom(0).y, 0.0));
    place += vec2(shift & (uint(film_grain_tile_size) - 1u)) - film_grain_tile_size * cell;

    vec3 shared_grain = film_grain_at(place);
    vec3 noise = vec3(film_grain_on(color.r, shared_grain), film_grain_on(color.g, shared_grain),
                      film_grain_on(color.b, shared_grain));
    if (parameters.color > 0.0) {
        vec2 own = vec2(film_grain_on(color.r, film_grain_at(place + vec2(89.0, 151.0))),
                        film_grain_on(color.b, film_grain_at(place + vec2(167.0, 61.0))));
        float together = 1.0 - parameters.color;
        // Of two that know nothing of each other, as uneven as one of them.
        noise.rb = (together * noise.rb + parameters.color * own) *
                   inversesqrt(together * together + parameters.color * parameters.color);
    }
    vec3 room = max(min(color.rgb, 1.0 - color.rgb), 0.0);
    return vec4(color.rgb + clamp(noise, -room, room), color.a);
}
