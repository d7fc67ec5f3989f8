// SPDX-License-Identifier: MIT
#part mask sharpen gather
// From light to what is averaged, and back. `unit` is the light that is shown as half of white: the inverse of the exposure.
#include "shared/sanitize.glsl"

vec3 taa_toned(vec3 light, float unit) { return light / (unit + max(light.r, max(light.g, light.b))); }

// YCoCg.
vec3 taa_opponent(vec3 toned) {
    float green = 0.5 * toned.g, both = 0.25 * (toned.r + toned.b);
    return vec3(both + green, 0.5 * (toned.r - toned.b), green - both);
}

vec3 taa_colors(vec3 opponent) {
    float both = opponent.x - opponent.z;
    return max(vec3(both + opponent.y, opponent.x + opponent.z, both - opponent.y), vec3(0.0));
}

vec3 taa_light(vec3 toned, float unit) {
    // As bright as half floats can be.
    return min(toned * unit / max(1.0 - max(toned.r, max(toned.g, toned.b)), 1e-7), vec3(65504.0));
}

// Stops of the unit, in 32nds, which the history holds as codes of 16 bits.
float taa_stops_of(float exposure) { return floor(0.5 - 32.0 * log2(clamp(exposure, 1e-6, 1e6))) / 32.0; }
float taa_packed_stops(float stops) { return (stops * 32.0 + 1024.0) / 65535.0; }
float taa_unpacked_stops(float packed) { return floor(packed * 65535.0 - 1023.5) / 32.0; }

// The history is stored in 16 bits. Rounding to the nearest would swallow small steps, and truncation would darken the
// picture frame by frame. So a value is rounded up as often as the part that it loses is large. Noise by J. Jimenez,
// "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.
float taa_dither(ivec2 texel, float frame) {
    vec2 place = vec2(texel) + 5.588238 * frame;
    return fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
}
vec3 taa_rounded(vec3 value, float dither, bool is_of_codes) {
    vec3 part = fract(vec3(0.0, 1.0 / 3.0, 2.0 / 3.0) + dither);
    if (is_of_codes) return floor(value * 65535.0 + part) / 65535.0;
    // A half has 13 bits of mantissa less.
    return uintBitsToFloat((floatBitsToUint(value) + uvec3(part * 8192.0)) & 0xffffe000u);
}

// Frames up to 128 and a deviation, as roots of their share in 8 bits each.
vec2 taa_packed(vec2 kept, float dither) {
    return floor(sqrt(clamp(kept / vec2(128.0, 1.0), 0.0, 1.0)) * 255.0 + vec2(dither, fract(dither + 0.5))) / 255.0;
}
vec2 taa_unpacked(vec2 packed) { return packed * packed * vec2(128.0, 1.0); }

#part motion
// Motion of a world that stands still, in pixels, y down, without jitter. custom[0 ... 2] = x, y (down) and w of a moment
// ago, of a point of view space; custom[3], custom[4] = RayConstants; custom[5] = (size, motion by the jitter).
vec4 shade(Pixel pixel) {
    vec2 texel = vec2(pixel.texel);
    // The sky turns with the camera and does not come nearer.
    float planar = 1.0 / max(load(taa_distance, pixel.texel).r, 1e-9);
    vec2 place = (texel * custom[3].xy + custom[3].zw) * planar + texel * custom[4].xy + custom[4].zw;
    vec4 point = vec4(place, -planar, 1.0);
    float w = dot(custom[2], point);
    vec2 before = (vec2(dot(custom[0], point), dot(custom[1], point)) / w * 0.5 + 0.5) * custom[5].xy;
    // What was behind the camera has no place in the last picture.
    return vec4(w > 0.0 ? before - (texel + 0.5) + custom[5].zw : vec2(0.0), 0.0, 1.0);
}

#part mask
// How little the past tells of a pixel of the frame, and of those around it: what the host says, and how much what is shown
// changed as transparent things were drawn, which have neither depth nor motion. custom[0].x: for so much of a change; 0 where
// nobody knows the colour before.

float taa_mask_at(ivec2 texel, float unit) {
    vec3 behind = taa_toned(sanitize_light(load(taa_transparency, texel).rgb), unit);
    vec3 change = abs(taa_toned(sanitize_light(load(taa_color, texel).rgb), unit) - behind);
    float seen = custom[0].x * max(change.r, max(change.g, change.b));
    return clamp(max(seen, load(taa_reactive, texel).r), 0.0, 1.0);
}

vec4 shade(Pixel pixel) {
    float unit = exp2(taa_stops_of(load(taa_exposure, ivec2(0)).r));
    ivec2 limit = size(taa_color) - 1;
    float own = 0.0, around = 0.0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            float here = taa_mask_at(clamp(pixel.texel + ivec2(i, j), ivec2(0), limit), unit);
            if (i == 0 && j == 0) own = here;
            around = max(around, here);
        }
    return vec4(own, around, 0.0, 1.0);
}

#part distance
// Inverse planar distance, 0 of the sky: what the next frame asks for what was in front. custom[0] = (x, y, z, w) with
// distance = (d x + y) / (d z + w), custom[1].x the sky's depth.
vec4 shade(Pixel pixel) {
    float depth = load(taa_depth, pixel.texel).r;
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    return vec4(depth != custom[1].x && inverse > 0.0 ? min(inverse, 65504.0) : 0.0, 0.0, 0.0, 1.0);
}

#part gather
// Scene-linear. A pixel of the output: what the frame has near it, and what was gathered of the surface that it shows.
// result[0] = (what is shown, stops of the unit), result[1] = (frames that are in it, by their weight; how far samples are off
// its luma), packed, result[2] = (light, alpha of the frame).
// custom[0] = (pixels of the frame a pixel of the output, jitter), custom[1] = (the inverse, jitter a moment ago),
// custom[2], custom[3].xy: distance before = distance (x a + y b + c) + d + x e + y f of the frame's texel (x, y),
// custom[3].zw = (has the past, frame), custom[4] = (inverse of the most frames, exponents of the Gaussian by which samples
// count: where there is a past, and where there is none; is what is shown kept in codes and not in halves).
// Colours are mixed as a display will show them, c / (1 + max c) of exposed light (B. Karis, "High Quality Temporal
// Supersampling", 2014), so that one bright sample does not outweigh all others, and in YCoCg.

const float taa_edge = 0.03;    // by so much of a distance a sample beside is another surface
const float taa_nearer = 0.02;  // by so much of a distance something else was in front
// What the filter loses of the past goes with f (1 - f) of the place between pixels: half way between four, nine tenths of a
// frame are worth keeping.
const float taa_loss = 2.2;
const float taa_reach = 1.25;  // how far the past may lie off the frame's mean: deviations of the frame's colours,
const float taa_still_noise = 3.0, taa_moving_noise = 0.5;  // and of samples off the past
// As far as the frame's own colours are apart: where light changes, samples are off the past, too, and the past must not
// stay for it.
const float taa_max_noise = 0.5;

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
        float off = min(abs(now.luma - past.x), taa_max_noise * now.deviation.x);
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

#part sharpen
// Scene-linear. RCAS of what will be shown, c / (1 + max c) of exposed light, which ends at 1. custom[0].x = strength.
#include "shared/rcas.glsl"

vec3 taa_shown_at(int x, int y, float unit) { return taa_toned(load(taa_gathered, ivec2(x, y)).rgb, unit); }

vec4 shade(Pixel pixel) {
    float unit = exp2(taa_stops_of(load(taa_exposure, ivec2(0)).r));
    ivec2 texel = pixel.texel, before = max(texel - 1, 0), behind = min(texel + 1, size(taa_gathered) - 1);
    vec4 own = load(taa_gathered, texel);
    vec3 n = taa_shown_at(texel.x, before.y, unit), s = taa_shown_at(texel.x, behind.y, unit);
    vec3 w = taa_shown_at(before.x, texel.y, unit), e = taa_shown_at(behind.x, texel.y, unit);
    vec3 sharp = rcas(taa_toned(own.rgb, unit), n, s, w, e, 1.0, custom[0].x);
    return vec4(taa_light(sharp, unit), own.a);
}
