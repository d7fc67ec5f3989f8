// SPDX-License-Identifier: MIT
#part prefilter prefilter_pairs
#include "shared/sanitize.glsl"

#part prefilter prefilter_pairs downsample downsample_texels
#include "bloom_taps.glsl"

#part downsample_texels upsample
#include "bloom_texels.glsl"

#part prefilter prefilter_pairs
// From the cleaned taps of the scene to what glows of them. scene_linear.
// custom[0] = (threshold, knee, limit, scale), custom[1].x = 1 with the firefly filter.

// Brian Karis, "Tone mapping" (2013): average by 1 / (1 + luminance). As in Jorge Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare" (2014), a box is the unit; unlike there, the sum is divided by the sum of weights.
vec4 bloom_box(vec3 sum, float weight) {
    vec3 mean = 0.25 * sum;
    float luminance = dot(mean, vec3(0.2126, 0.7152, 0.0722));
    return vec4(mean, 1.0) * (weight / (1.0 + custom[1].x * luminance));
}

vec3 bloom_average(BloomTaps taps) {
    vec3 upper_left = taps.left.top + taps.left.middle, lower_left = taps.left.middle + taps.left.bottom;
    vec3 upper = taps.centre.top + taps.centre.middle, lower = taps.centre.middle + taps.centre.bottom;
    vec3 upper_right = taps.right.top + taps.right.middle, lower_right = taps.right.middle + taps.right.bottom;
    vec4 total = bloom_box(taps.inner, 0.5) + bloom_box(upper_left + upper, 0.125) + bloom_box(upper + upper_right, 0.125) +
                 bloom_box(lower_left + lower, 0.125) + bloom_box(lower + lower_right, 0.125);
    return total.rgb / total.a;
}

vec3 bloom_bright_part(vec3 color) {
    float threshold = custom[0].x;
    float knee = custom[0].y;
    float brightness = max(color.r, max(color.g, color.b));
    float soft = clamp(brightness - threshold + knee, 0.0, 2.0 * knee);
    soft = soft * soft / (4.0 * knee + 1e-5);
    float weight = max(soft, brightness - threshold) / max(brightness, 1e-5);
    return min(color * weight, custom[0].z) * custom[0].w;
}

// Filter and threshold weigh a lamp by how many boxes it lies in, so all taps lie on corners of texels, two texels apart:
// what is made there, a cell, does not depend on where the lamp lies. Along an odd side a pixel of level 0 lies between two
// cells: this far behind the first; along an even one on the first, and 0 is no cell behind it. That is asked of the pixel
// and not of the sides: lavapipe (Mesa 22.3) makes a kernel anew in each frame, and keeps it, where loops end by a block's
// values alone.
vec2 bloom_between_cells(ivec2 texel, ivec2 source, ivec2 extent) {
    return vec2(source & 1) * vec2(2 * texel + 1) / vec2(4 * extent);
}

float bloom_part(float between, int cell) { return cell == 0 ? 1.0 - between : between; }

vec3 bloom_tap(int from, vec2 place) {
    return sanitize_light(sample_linear(bloom_source, place / vec2(size(bloom_source))).rgb);
}

#part prefilter
// The scene to level 0, a kernel of a pixel: 13 taps, cleaned, averaged as five overlapping boxes, then the threshold.

vec4 shade(Pixel pixel) {
    vec2 between = bloom_between_cells(pixel.texel, size(bloom_source), pixel.size);
    ivec2 cells = 1 + ivec2(greaterThan(between, vec2(0.0)));
    vec3 light = vec3(0.0);
    for (int y = 0; y < cells.y; ++y)
        for (int x = 0; x < cells.x; ++x)
            light += bloom_bright_part(bloom_average(bloom_taps_of(0, pixel.texel + ivec2(x, y), bloom_rows_between))) *
                     (bloom_part(between.x, x) * bloom_part(between.y, y));
    return vec4(light, 1.0);
}

#part prefilter_pairs
// The scene to level 0, two pixels side by side at once, so that they take 18 taps and not 26.

void run() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) * ivec2(2, 1), extent = size(bloom_level_0);
    if (any(greaterThanEqual(texel, extent))) return;
    ivec2 source = size(bloom_source), behind = texel + ivec2(1, 0);
    vec2 between = bloom_between_cells(texel, source, extent);
    ivec2 cells = 1 + ivec2(greaterThan(between, vec2(0.0)));
    float between_behind = bloom_between_cells(behind, source, extent).x;
    vec3 light[2] = vec3[2](vec3(0.0), vec3(0.0));
    for (int y = 0; y < cells.y; ++y)
        for (int x = 0; x < cells.x; ++x) {
            BloomTaps taps[2] = bloom_taps_of_pair(0, texel + ivec2(x, y), bloom_rows_between);
            float part = bloom_part(between.y, y);
            light[0] += bloom_bright_part(bloom_average(taps[0])) * (bloom_part(between.x, x) * part);
            light[1] += bloom_bright_part(bloom_average(taps[1])) * (bloom_part(between_behind, x) * part);
        }
    store(bloom_level_0, texel, vec4(light[0], 1.0));
    if (behind.x < extent.x) store(bloom_level_0, behind, vec4(light[1], 1.0));
}

#part downsample
// Levels 1 and 3: taps by the sampler.
vec3 bloom_tap(int from, vec2 place) {
    return sample_linear(bloom_above, place * (0.5 / vec2(output_size()))).rgb;
}

#part downsample_texels
// Levels 2 and 4: taps of four texels each, as a workgroup makes them that has the level above in shared memory.
vec3 bloom_texel(int from, ivec2 texel) {
    return load(bloom_above, texel).rgb;
}

vec3 bloom_tap(int from, vec2 place) {
    return bloom_between(from, place, size(bloom_above), output_size());
}

#part downsample downsample_texels
// Level i-1 to level i, a kernel of a pixel: by the 13 taps.

vec4 shade(Pixel pixel) {
    return vec4(bloom_mean_of(bloom_taps_of(0, pixel.texel, bloom_rows(size(bloom_above)))), 1.0);
}

#part upsample
// Level i+1 onto level i, added, a kernel of a pixel: the tent of bloom_texels.glsl, by 16 texels.
// custom[0] = (gain, levels in use from here on, not used, tent of the last one).

vec3 bloom_texel(int from, ivec2 texel) {
    return load(bloom_below, texel).rgb;
}

vec3 bloom_row(ivec2 first, vec4 weights) {
    return bloom_weighed(load_clamped(bloom_below, first).rgb, load_clamped(bloom_below, first + ivec2(1, 0)).rgb,
                         load_clamped(bloom_below, first + ivec2(2, 0)).rgb,
                         load_clamped(bloom_below, first + ivec2(3, 0)).rgb, weights);
}

vec4 shade(Pixel pixel) {
    vec2 place = bloom_below_at(pixel.texel, size(bloom_below), pixel.size), low = floor(place), f = place - low;
    ivec2 first = ivec2(low) - 1;
    float tent = mix(1.0, custom[0].w, float(custom[0].y == 2.0));
    vec4 x = bloom_weights(f.x, tent);
    vec3 glow = bloom_weighed(bloom_row(first, x), bloom_row(first + ivec2(0, 1), x), bloom_row(first + ivec2(0, 2), x),
                              bloom_row(first + ivec2(0, 3), x), bloom_weights(f.y, tent));
    return vec4(glow * custom[0].x, 0.0);
}

#part end
// scene_linear -> scene_linear. bloom_custom(0).xy: the weights of the glow, 0 where there is none, and of the picture.

vec4 bloom(vec4 color, Pixel pixel, Bloom parameters) {
    vec3 glow = sample_linear(bloom_pyramid, pixel.uv).rgb;
    return vec4(color.rgb * bloom_custom(0).y + glow * bloom_custom(0).x, color.a);
}
