// SPDX-License-Identifier: MIT
// Light to the table's space, one or two lookups, and back. A cube's entries are a list in rows of 4096 texels, red
// fastest, and then zeros. The shaper's image has four texels of scales and offsets, and then the shaper's entries; it is a
// sampler3D, and a sampler2D where there is nothing to shape, or no second table: the overload then says at compile time
// what a branch would say in every pixel. That sampler2D is as wide as the cube's edge.
#include "lut_log_curves.glsl"
#include "shared/sanitize.glsl"
#include "shared/srgb.glsl"

vec4 lut_listed(sampler3D list, int number) {
    return texelFetch(list, ivec3(number >> 1 & 255, number >> 9, number & 1), 0);
}

/// Coordinates in a cube whose inputs are 0 to 1, as a display's code values are, and that has no shaper.
vec3 lut_place(sampler2D none, vec3 color, uint space, out int edge) {
    edge = textureSize(none, 0).x;
    return (space == Lut_space_display ? color : clamp(color, 0.0, 1.0)) * float(edge - 1);
}

/// The same of one that has a shaper, or inputs of its own.
vec3 lut_place(sampler3D shaper, vec3 color, uint space, out int edge) {
    vec4 inputs = lut_listed(shaper, 0), cube = lut_listed(shaper, 2);
    if (inputs.a > 0.0) {
        vec3 place = clamp(color * inputs.rgb + lut_listed(shaper, 1).rgb, 0.0, inputs.a - 1.0);
        ivec3 low = min(ivec3(place), int(inputs.a) - 2);
        vec3 before = vec3(lut_listed(shaper, 4 + low.r).r, lut_listed(shaper, 4 + low.g).g,
                           lut_listed(shaper, 4 + low.b).b);
        vec3 behind = vec3(lut_listed(shaper, 5 + low.r).r, lut_listed(shaper, 5 + low.g).g,
                           lut_listed(shaper, 5 + low.b).b);
        color = mix(before, behind, place - vec3(low));
    }
    edge = int(cube.a);
    return clamp(color * cube.rgb + lut_listed(shaper, 3).rgb, 0.0, cube.a - 1.0);
}

vec3 lut_entry(bool is_next, int number) {
    ivec2 texel = ivec2(number & 4095, number >> 12);
    if (is_next) return load(lut_next, texel).rgb;
    return load(lut_table, texel).rgb;
}

// At the upper faces of the cube a fraction is 0, and what is loaded beyond them counts for nothing.
vec3 lut_between(bool is_next, int edge, vec3 place, uint interpolation) {
    ivec3 low = ivec3(place);
    vec3 f = place - vec3(low);
    int slice = edge * edge, start = low.b * slice + low.g * edge + low.r;
    if (interpolation == Lut_interpolation_trilinear) {
        vec3 rows[4];
        for (int i = 0; i < 4; ++i) {
            int at = start + (i & 1) * edge + (i >> 1) * slice;
            rows[i] = mix(lut_entry(is_next, at), lut_entry(is_next, at + 1), f.r);
        }
        return mix(mix(rows[0], rows[1], f.g), mix(rows[2], rows[3], f.g), f.b);
    }
    // Kasson et al., "Performing color space conversions with three-dimensional linear interpolation", 1995: from the
    // cell's black corner along the axis of the largest fraction, then along the middle one's, then to the white corner.
    bool rg = f.r >= f.g, gb = f.g >= f.b, rb = f.r >= f.b;
    int first = rg && rb ? 1 : gb ? edge : slice;
    int last = gb && rb ? slice : rg ? edge : 1;
    int all = 1 + edge + slice;
    float high = max(max(f.r, f.g), f.b), lowest = min(min(f.r, f.g), f.b);
    float middle = max(min(f.r, f.g), min(max(f.r, f.g), f.b));
    return (1.0 - high) * lut_entry(is_next, start) + (high - middle) * lut_entry(is_next, start + first) +
           (middle - lowest) * lut_entry(is_next, start + all - last) + lowest * lut_entry(is_next, start + all);
}

vec3 lut_faded(sampler2D none, vec3 found, vec3 given, Lut parameters) { return found; }

vec3 lut_faded(sampler3D shaper, vec3 found, vec3 given, Lut parameters) {
    int edge;
    vec3 place = lut_place(shaper, given, parameters.space, edge);
    return mix(found, lut_between(true, edge, place, parameters.interpolation), parameters.fade);
}

// srgb_encode() within 2e-5, with one square root in place of two. The fraction in t = 1 - sqrt(x) is fitted for the
// smallest absolute error, with 1 kept exact.
vec3 lut_display_code(vec3 light) {
    light = srgb_range(light);
    vec3 t = 1.0 - sqrt(light);
    vec3 power = 1.0 - t * (0.879580014 + t * (0.262059838 * t - 1.07524384)) / (1.0 + t * (0.366263865 * t - 1.30285064));
    return mix(power, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}

// srgb_decode() of a number, with a polynomial of one degree less: encoded again it is within 5.3e-5.
vec3 lut_display_light(vec3 code) {
    code = clamp(code, 0.0, 1.0);
    vec3 t = 1.0 - code;
    vec3 power = 1.0 - t * (2.27819837 - t * (1.54170827 - t * (0.295465332 - t * (0.115809177 - t * 0.0829329001))));
    return mix(power, code * (1.0 / 12.92), lessThanEqual(code, vec3(0.04045)));
}

vec3 lut_encode(vec3 light, uint space) {
    if (space == Lut_space_display) return lut_display_code(light);
    light = sanitize(vec4(light, 0.0)).rgb;
    if (space == Lut_space_linear) return light;
    if (space == Lut_space_acescct) return acescct_encode(light);
    if (space == Lut_space_logc3) return logc3_encode(light);
    if (space == Lut_space_slog3) return slog3_encode(light);
    if (space == Lut_space_logc4) return logc4_encode(light);
    if (space == Lut_space_vlog) return vlog_encode(light);
    if (space == Lut_space_davinci_intermediate) return davinci_encode(light);
    return log_shaper_encode(light);
}

vec3 lut_decode(vec3 value, uint space) {
    if (space == Lut_space_display) return lut_display_light(value);
    if (space == Lut_space_linear) return sanitize(vec4(value, 0.0)).rgb;
    if (space == Lut_space_acescct) return acescct_decode(value);
    if (space == Lut_space_logc3) return logc3_decode(value);
    if (space == Lut_space_slog3) return slog3_decode(value);
    if (space == Lut_space_logc4) return logc4_decode(value);
    if (space == Lut_space_vlog) return vlog_decode(value);
    if (space == Lut_space_davinci_intermediate) return davinci_decode(value);
    return log_shaper_decode(value);
}

vec4 lut(vec4 color, Pixel pixel, Lut parameters) {
    vec3 given = lut_encode(color.rgb, parameters.space);
    int edge;
    vec3 place = lut_place(lut_shaper, given, parameters.space, edge);
    vec3 found = lut_between(false, edge, place, parameters.interpolation);
    found = lut_faded(lut_next_shaper, found, given, parameters);
    vec3 light = parameters.result == Lut_result_display ? lut_display_light(found) : lut_decode(found, parameters.space);
    return vec4(parameters.strength == 1.0 ? light : mix(color.rgb, light, parameters.strength), color.a);
}
