// SPDX-License-Identifier: MIT
// Scene-linear. A pixel of the output: what the frame has near it, and what was gathered of the surface that it shows.
// result[0] = (what is shown, stops of the unit), result[1] = (frames that are in it, by their weight; how far samples are off
// its luma), packed, result[2] = (light, alpha of the frame).
// custom[0] = (pixels of the frame a pixel of the output, jitter), custom[1] = (the inverse, jitter a moment ago),
// custom[2], custom[3].xy: distance before = distance (x a + y b + c) + d + x e + y f of the frame's texel (x, y),
// custom[3].zw = (has the past, frame), custom[4] = (inverse of the most frames, exponents of the Gaussian by which samples
// count: where there is a past, and where there is none; is what is shown kept in codes and not in halves).
// Colours are mixed as a display will show them, c / (1 + max c) of exposed light (B. Karis, "High Quality Temporal
// Supersampling", 2014), so that one bright sample does not outweigh all others, and in YCoCg.
#include "taa_tone.glsl"

const float taa_edge = 0.03;    // by so much of a distance a sample beside is another surface
const float taa_nearer = 0.02;  // by so much of a distance something else was in front
// What the filter loses of the past goes with f (1 - f) of the place between pixels: half way between four, nine tenths of a
// frame are worth keeping.
const float taa_loss = 2.2;
const float taa_reach = 1.25;  // how far the past may lie off the frame's mean: deviations of the frame's colours,
const float taa_still_noise = 3.0, taa_moving_noise = 0.5;  // and of samples off the past
// As far as the frame's own colours are apart: where light changes, samples are off the past, too, and the past must not
// stay for it.
const float taa_most_noise = 0.5;

// Of the samples beside, the nearest and the farthest, and where.
struct TaaEdge {
    float nearest, farthest;
    ivec2 near_at, far_at;
};
void taa_look(ivec2 texel, ivec2 limit, inout TaaEdge edge) {
    ivec2 inside = clamp(texel, ivec2(0), limit);
    float here = load(taa_distance, inside).r;
    if (here > edge.nearest) {
        edge.nearest = here;
        edge.near_at = inside;
    }
    if (here < edge.farthest) {
        edge.farthest = here;
        edge.far_at = inside;
    }
}

// What the frame has around a place: a mean by a Gaussian with its weight, and all colours there are.
struct TaaNow {
    vec3 color, mean, deviation;
    float luma, weight;
};

TaaNow taa_now(ivec2 middle, ivec2 limit, vec2 away, float unit, float exponent) {
    vec3 x = (away.x + vec3(-1.0, 0.0, 1.0)) * custom[1].x, y = (away.y + vec3(-1.0, 0.0, 1.0)) * custom[1].y;
    x = exp2(exponent * x * x);
    y = exp2(exponent * y * y);
    TaaNow now = TaaNow(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
    vec3 squares = vec3(0.0);
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            ivec2 texel = clamp(middle + ivec2(i, j) - 1, ivec2(0), limit);
            vec3 color = taa_opponent(taa_toned(sanitize_light(load(taa_color, texel).rgb), unit));
            if (i == 1 && j == 1) now.luma = color.x;
            now.color += color * (x[i] * y[j]);
            now.mean += color;
            squares += color * color;
        }
    float weight = (x.x + x.y + x.z) * (y.x + y.y + y.z);
    now.color /= weight;
    now.mean /= 9.0;
    now.deviation = sqrt(max(squares / 9.0 - now.mean * now.mean, vec3(0.0)));
    // A mean over a wider place tells less of it.
    now.weight = min(weight, 1.0) * (exponent / custom[4].y);
    return now;
}

// Of the six texels along an axis in a Lanczos filter of three lobes (C. Duchon, 1979), fitted by polynomials and with a sum of
// 1, the weights of the first, second, fifth and last.
vec4 taa_outer(float f) {
    float g = 1.0 - f, both = f * g;
    return both * vec4(0.2182 - 0.2385 * f, (0.1072 * f + 0.5805) * f - 0.8605, (0.1072 * g + 0.5805) * g - 0.8605,
                        0.2182 - 0.2385 * g);
}

// A cross of nine taps: what lies off the middle of both axes weighs little. The two texels in the middle are one tap. Texels
// hold what is shown: filtered as light, an edge would move into its dark side with every frame.
vec3 taa_past(vec2 middle, vec2 f, vec2 extent, float stops) {
    vec4 x = taa_outer(f.x), y = taa_outer(f.y);
    vec2 inner = 1.0 - vec2(dot(x, vec4(1.0)), dot(y, vec4(1.0)));
    vec2 at = (middle + f + 0.1816 * f * (1.0 - f) * (2.0 * f - 1.0)) / extent;
    vec4 first = sample_linear(taa_shown_before, at);
    vec3 past = first.rgb * (inner.x * inner.y);
    for (int i = 0; i < 4; ++i) {
        vec2 beside = (middle + float(i < 2 ? i - 2 : i)) / extent;
        past += sample_linear(taa_shown_before, vec2(beside.x, at.y)).rgb * (x[i] * inner.y);
        past += sample_linear(taa_shown_before, vec2(at.x, beside.y)).rgb * (y[i] * inner.x);
    }
    past = clamp(past / (inner.x + inner.y - inner.x * inner.y), 0.0, 1.0);
    // Under another exposure it was shown as another colour.
    float most = max(past.r, max(past.g, past.b));
    return taa_opponent(past / mix(exp2(stops - taa_unpacked_stops(first.a)), 1.0, most));
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

void shade(Pixel pixel, out vec4 result[3]) {
    float stops = taa_stops_of(load(taa_exposure, ivec2(0)).r), unit = exp2(stops);
    vec2 output_place = vec2(pixel.texel) + 0.5, place = output_place * custom[0].xy + custom[0].zw;
    ivec2 limit = size(taa_color) - 1, middle = clamp(ivec2(floor(place)), ivec2(0), limit);

    // The edge of what is in front moves with it: the motion of the nearest of the sample and the four beside it.
    float own = load(taa_distance, middle).r;
    TaaEdge edge = TaaEdge(own, own, middle, middle);
    taa_look(middle - ivec2(1, 0), limit, edge);
    taa_look(middle + ivec2(1, 0), limit, edge);
    taa_look(middle - ivec2(0, 1), limit, edge);
    taa_look(middle + ivec2(0, 1), limit, edge);
    bool is_edge = edge.nearest > own * (1.0 + taa_edge);
    float inverse = is_edge ? edge.nearest : own;
    ivec2 at = is_edge ? edge.near_at : middle;
    vec2 motion = sanitize(load(taa_velocity, at)).xy * custom[1].xy, before = output_place + motion;
    vec2 extent = vec2(pixel.size), middle_before = floor(before - 0.5) + 0.5, f = before - middle_before;

    float frames = 0.0, noise = 0.0;
    vec2 mask = load(taa_mask, middle).rg;
    bool is_inside = all(greaterThan(before, vec2(0.0))) && all(lessThan(before, extent));
    if (custom[3].z > 0.5 && is_inside && !taa_was_hidden(at, inverse, before * custom[0].xy + custom[1].zw)) {
        vec2 kept = taa_unpacked(sample_linear(taa_kept_before, before / extent).rg);
        frames = min(kept.x, 1.0 / (custom[4].x + taa_loss * dot(f, 1.0 - f)));
        frames *= 1.0 - mask.x;
        noise = kept.y;
    }
    TaaNow now = taa_now(middle, limit, vec2(middle) + 0.5 - place, unit,
                         mix(custom[4].z, custom[4].y, min(frames, 1.0)));
    vec3 color = now.color;
    if (frames > 0.0) {
        vec3 past = taa_past(middle_before, f, extent, stops), away = past - now.mean;
        // What lies outside the frame's own colours is drawn to their mean (M. Salvi, "An Excursion in Temporal
        // Supersampling", 2016), but for what samples are off the past all the time: parts thinner than a pixel are in one
        // frame and not in the next.
        float of_samples = noise * mix(taa_still_noise, taa_moving_noise, min(length(motion) * 4.0, 1.0));
        vec3 beyond = abs(away) / max(now.deviation * taa_reach + of_samples, vec3(1e-3));
        float most = max(max(beyond.x, beyond.y), max(beyond.z, 1.0));
        past = now.mean + away / most;
        frames /= most;  // it counts as much less as it had to be drawn
        color = mix(past, color, now.weight / (frames + now.weight));
        float off = min(abs(now.luma - past.x), taa_most_noise * now.deviation.x);
        noise += (off - noise) * max(0.1, 1.0 / (frames + 1.0));
    }
    // Where an edge moves before what is behind it, samples will be off for another reason; and the thing beside its edge
    // leaves them behind, if that stands still.
    vec2 behind = sanitize(load(taa_velocity, edge.far_at)).xy * custom[1].xy;
    float parts = clamp(4.0 * length(motion - behind) - 0.4, 0.0, 1.0);
    noise *= 1.0 - parts * (is_edge ? 1.0 : 1.0 - min(4.0 * length(behind), 1.0));
    noise *= 1.0 - mask.y;  // nor are particles a reason to keep what is off
    float dither = taa_dither(pixel.texel, custom[3].w);
    vec3 shown = taa_colors(color);
    result[0] = vec4(taa_rounded(shown, dither, custom[4].w > 0.5), taa_packed_stops(stops));
    result[1] = vec4(taa_packed(vec2(frames + now.weight, noise), dither), 0.0, 1.0);
    result[2] = vec4(taa_light(shown, unit), sample_linear(taa_color, place / vec2(limit + 1)).a);
}
