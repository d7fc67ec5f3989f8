// SPDX-License-Identifier: MIT
// Code values. The side image film_grain_tile holds grain on three tones, with its last texel before its first and its
// first behind its last. film_grain_custom(0): texels a pixel, the frame's number, and twice what a texel's correlation
// with the next one lacks, across and down; (1): gains of the tones; (2): their means.

const float film_grain_tile_size = 256.0;
const float film_grain_lattice = 64.0;

// PCG in three dimensions: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
uvec3 film_grain_hash(uvec3 value) {
    value = value * 1664525u + 1013904223u;
    for (int i = 0; i < 2; ++i) {
        value.x += value.y * value.z;
        value.y += value.z * value.x;
        value.z += value.x * value.y;
        if (i == 0) value ^= value >> 16u;
    }
    return value;
}

// The three corners of a lattice of triangles around a place, how much each counts there, and where each has the tile, which
// the frame decides, too. Heitz and Neyret, "High-Performance By-Example Noise using a Histogram-Preserving Blending
// Operator", 2018, section 4: the eye finds neither a period nor a seam.
struct film_grain_corners {
    vec2 shift[3];
    vec3 weights;
};
film_grain_corners film_grain_corners_around(vec2 place) {
    vec2 skewed = mat2(1.0, 0.0, -0.57735027, 1.15470054) * place / film_grain_lattice;
    vec2 within = fract(skewed);
    float rest = 1.0 - within.x - within.y;
    bool is_upper = rest < 0.0;
    ivec2 first = ivec2(floor(skewed)) + (is_upper ? 1 : 0);
    int step = is_upper ? -1 : 1;
    ivec2 corners[3] = ivec2[3](first, first + ivec2(step, 0), first + ivec2(0, step));
    film_grain_corners result;
    result.weights = is_upper ? vec3(-rest, 1.0 - within) : vec3(rest, within);
    // Grains that know nothing of each other are as uneven together as one of them.
    result.weights *= inversesqrt(dot(result.weights, result.weights));
    for (int i = 0; i < 3; ++i) {
        uvec2 shift = film_grain_hash(uvec3(uvec2(corners[i]), uint(film_grain_custom(0).y))).xy;
        result.shift[i] = vec2(shift & (uint(film_grain_tile_size) - 1u));
    }
    return result;
}

// The grain of the tones at a place. What is read between texels is less uneven than they are: by the variance of a mix of
// two whose correlation is known.
vec3 film_grain_at(vec2 place, film_grain_corners corners) {
    vec2 between = fract(place - 0.5);
    vec2 kept = 1.0 - film_grain_custom(0).zw * between * (1.0 - between);
    vec3 tones = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        vec2 texel = place + corners.shift[i];
        texel -= film_grain_tile_size * floor(texel / film_grain_tile_size);
        tones += corners.weights[i] * (sample_linear(film_grain_tile, (texel + 1.0) / (film_grain_tile_size + 2.0)).rgb -
                                       film_grain_custom(2).rgb);
    }
    return tones * inversesqrt(kept.x * kept.y);
}

// Of a code value: linear between the tones, and to black and white, which have none.
float film_grain_on(float value, vec3 grain) {
    return dot(max(1.0 - abs(4.0 * value - vec3(1.0, 2.0, 3.0)), 0.0) * film_grain_custom(1).rgb, grain);
}

vec4 film_grain(vec4 color, Pixel pixel, FilmGrain parameters) {
    vec2 place = (vec2(pixel.texel) + 0.5) * film_grain_custom(0).x;
    film_grain_corners corners = film_grain_corners_around(place);
    vec3 shared_grain = film_grain_at(place, corners);
    vec3 noise = vec3(film_grain_on(color.r, shared_grain), film_grain_on(color.g, shared_grain),
                      film_grain_on(color.b, shared_grain));
    if (parameters.color > 0.0) {
        vec2 own = vec2(film_grain_on(color.r, film_grain_at(place + vec2(89.0, 151.0), corners)),
                        film_grain_on(color.b, film_grain_at(place + vec2(167.0, 61.0), corners)));
        float together = 1.0 - parameters.color;
        // Of two that know nothing of each other, as uneven as one of them.
        noise.rb = (together * noise.rb + parameters.color * own) *
                   inversesqrt(together * together + parameters.color * parameters.color);
    }
    vec3 room = max(min(color.rgb, 1.0 - color.rgb), 0.0);
    return vec4(color.rgb + clamp(noise, -room, room), color.a);
}
