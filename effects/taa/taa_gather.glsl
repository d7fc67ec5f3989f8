// SPDX-License-Identifier: MIT
// Scene-linear. A pixel of the output: what the frame has near it, and what was gathered of the surface that it shows.
// result[0] = (colour, alpha of the frame), result[1].r = frames that are in it, by their weight.
// custom[0] = (pixels of the frame a pixel of the output, jitter), custom[1] = (the inverse, jitter a moment ago),
// custom[2], custom[3].xy: distance before = distance (x a + y b + c) + d + x e + y f of the frame's texel (x, y),
// custom[3].zw = (has the past, frame), custom[4].x = frames gathered at most where nothing moves.
// Colours are mixed as a display will show them, c / (1 + max c) of exposed light (B. Karis, "High Quality Temporal
// Supersampling", 2014), so that one bright sample does not outweigh all others, and in YCoCg.
#include "taa_tone.glsl"

const float taa_moving_frames = 16.0;  // beyond it, resampling again and again blurs more than it gathers
const float taa_nearer = 0.02;         // by so much of a distance something else was in front
const float taa_edge = 0.03;           // by so much of a distance a sample beside is another surface
const float taa_wide = 1.0;            // exponents of Gaussians: of a pixel of the frame, while there is little past
const float taa_narrow = 2.3;          // of a pixel of the output
const float taa_still_reach = 3.0;     // deviations that the past may lie off the frame's mean
const float taa_moving_reach = 1.0;
const float taa_most_reactive = 0.9;

// What of `inverse` distances around a place is nearest, and where.
void taa_nearest(ivec2 texel, ivec2 limit, inout float inverse, inout ivec2 at) {
    ivec2 inside = clamp(texel, ivec2(0), limit);
    float here = load(taa_distance, inside).r;
    if (here > inverse) {
        inverse = here;
        at = inside;
    }
}

// Of what the frame has around a place: a mean over a pixel of the frame, one over a pixel of the output, and what the
// past may be.
struct TaaNow {
    vec3 wide, narrow, mean, deviation;
    float weight;
};

TaaNow taa_now(ivec2 middle, ivec2 limit, vec2 away, float unit) {
    vec3 x = away.x + vec3(-1.0, 0.0, 1.0), y = away.y + vec3(-1.0, 0.0, 1.0);
    vec3 x_wide = exp2(-1.4427 * taa_wide * x * x), y_wide = exp2(-1.4427 * taa_wide * y * y);
    x *= custom[1].x;
    y *= custom[1].y;
    vec3 x_narrow = exp2(-1.4427 * taa_narrow * x * x), y_narrow = exp2(-1.4427 * taa_narrow * y * y);
    TaaNow now = TaaNow(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    vec3 squares = vec3(0.0);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            ivec2 texel = clamp(middle + ivec2(i, j) - 1, ivec2(0), limit);
            vec3 color = taa_toned(sanitize_light(load(taa_color, texel).rgb), unit);
            now.mean += color;
            squares += color * color;
            now.wide += color * (x_wide[i] * y_wide[j]);
            now.narrow += color * (x_narrow[i] * y_narrow[j]);
        }
    float narrow = (x_narrow.x + x_narrow.y + x_narrow.z) * (y_narrow.x + y_narrow.y + y_narrow.z);
    now.wide /= (x_wide.x + x_wide.y + x_wide.z) * (y_wide.x + y_wide.y + y_wide.z);
    now.narrow /= narrow;
    now.mean /= 9.0;
    now.deviation = sqrt(max(squares / 9.0 - now.mean * now.mean, vec3(0.0)));
    now.weight = min(narrow, 1.0);
    return now;
}

// Catmull-Rom, by nine taps that are each filtered.
vec3 taa_past(vec2 place, vec2 extent, float unit) {
    vec2 middle = floor(place - 0.5) + 0.5, f = place - middle;
    vec2 before = f * (-0.5 + f * (1.0 - 0.5 * f)), behind = f * f * (-0.5 + 0.5 * f);
    vec2 second = f * (0.5 + f * (2.0 - 1.5 * f)), inner = 1.0 - before - behind;
    vec3 x_at = vec3(middle.x - 1.0, middle.x + second.x / inner.x, middle.x + 2.0) / extent.x;
    vec3 y_at = vec3(middle.y - 1.0, middle.y + second.y / inner.y, middle.y + 2.0) / extent.y;
    vec3 x = vec3(before.x, inner.x, behind.x), y = vec3(before.y, inner.y, behind.y), past = vec3(0.0);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            past += taa_toned(sample_linear(taa_light_before, vec2(x_at[i], y_at[j])).rgb, unit) * (x[i] * y[j]);
    return past;
}

// Was something else in front of the surface, wherever the past would be read?
bool taa_was_hidden(ivec2 at, float inverse, vec2 before) {
    vec2 texel = vec2(at);
    float slope = dot(texel, custom[2].xy) + custom[2].z, offset = dot(texel, custom[3].xy) + custom[2].w;
    float expected = inverse / max(slope + inverse * offset, 1e-9);
    ivec2 first = ivec2(floor(before - 0.5)), limit = size(taa_distance_before) - 1;
    float farthest = 65504.0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            ivec2 seen = clamp(first + ivec2(i, j), ivec2(0), limit);
            farthest = min(farthest, load(taa_distance_before, seen).r);
        }
    return farthest > expected * (1.0 + taa_nearer) + 1e-6;
}

void shade(Pixel pixel, out vec4 result[2]) {
    float unit = 1.0 / clamp(load(taa_exposure, ivec2(0)).r, 1e-6, 1e6);
    vec2 output_place = vec2(pixel.texel) + 0.5, place = output_place * custom[0].xy + custom[0].zw;
    ivec2 limit = size(taa_color) - 1, middle = clamp(ivec2(floor(place)), ivec2(0), limit);
    TaaNow now = taa_now(middle, limit, vec2(middle) + 0.5 - place, unit);

    // The edge of what is in front moves with it: the motion of the nearest of the four samples around the place.
    float own = load(taa_distance, middle).r, inverse = own;
    ivec2 at = middle, first = ivec2(floor(place - 0.5));
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) taa_nearest(first + ivec2(i, j), limit, inverse, at);
    if (inverse <= own * (1.0 + taa_edge)) {
        inverse = own;
        at = middle;
    }
    vec2 motion = sanitize(load(taa_velocity, at)).xy * custom[1].xy, place_before = output_place + motion;
    vec2 extent = vec2(pixel.size);

    vec3 color = now.wide;
    float count = now.weight;
    bool is_inside = all(greaterThan(place_before, vec2(0.0))) && all(lessThan(place_before, extent));
    if (custom[3].z > 0.5 && is_inside && !taa_was_hidden(at, inverse, place_before * custom[0].xy + custom[1].zw)) {
        float moves = min(length(motion) * 4.0, 1.0);
        float frames = sample_linear(taa_count_before, place_before / extent).r;
        frames = min(frames, mix(custom[4].x, taa_moving_frames, moves));
        vec3 past = taa_past(place_before, extent, unit), away = past - now.mean;
        // What lies outside the frame's own colours is drawn to their mean (M. Salvi, "An Excursion in Temporal
        // Supersampling", 2016).
        vec3 reach = max(now.deviation * mix(taa_still_reach, taa_moving_reach, moves), vec3(1e-3));
        vec3 beyond = abs(away) / reach;
        past = now.mean + away / max(max(beyond.x, beyond.y), max(beyond.z, 1.0));
        frames *= 1.0 - taa_most_reactive * clamp(load(taa_reactive, middle).r, 0.0, 1.0);
        vec3 present = mix(now.wide, now.narrow, min(frames / 4.0, 1.0));
        color = mix(past, present, now.weight / (frames + now.weight));
        count = frames + now.weight;
    }
    float noise = taa_noise(pixel.texel, custom[3].w);
    result[0] = vec4(taa_rounded(taa_light(color, unit), noise), sample_linear(taa_color, place / vec2(limit + 1)).a);
    result[1] = vec4(count, 0.0, 0.0, 1.0);
}
