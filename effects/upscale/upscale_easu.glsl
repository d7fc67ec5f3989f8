// SPDX-License-Identifier: MIT
// Encoded or display_linear, as an eye sees it. AMD, "FidelityFX Super Resolution 1.0", 2021, edge-adaptive spatial
// upsampling (EASU): twelve pixels around the place, by a kernel near Lanczos' that is turned and stretched along the edge,
// within the span of the nearest four.
#include "shared/sanitize.glsl"

float upscale_luma(vec4 color) { return 0.5 * color.b + (0.5 * color.r + color.g); }

// Adds what one of the nearest four has around it: how luma changes, and how straight (1: an edge, 0: a line or a point).
void upscale_look(inout vec2 change, inout float straight, float weight, float up, float left, float own, float right,
                  float down) {
    vec2 whole = vec2(right - left, down - up);
    vec2 most = max(abs(vec2(right, down) - own), abs(own - vec2(left, up)));
    vec2 part = min(abs(whole) / max(most, 1e-30), 1.0);
    change += whole * weight;
    straight += dot(part, part) * weight;
}

// How the kernel lies: the direction across the edge, its scale along it and across, and how far it reaches.
struct UpscaleShape {
    vec2 direction, scale;
    float lobe;
};

void upscale_tap(inout vec4 sum, UpscaleShape shape, vec2 away, vec4 color) {
    vec2 turned = vec2(dot(away, shape.direction), away.y * shape.direction.x - away.x * shape.direction.y) * shape.scale;
    float far = min(dot(turned, turned), 1.0 / shape.lobe), base = 0.4 * far - 1.0, window = shape.lobe * far - 1.0;
    float weight = (25.0 / 16.0 * base * base - (25.0 / 16.0 - 1.0)) * window * window;
    sum += vec4(color.rgb, 1.0) * weight;
}

vec4 upscale_at(ivec2 texel, ivec2 limit) { return sanitize(load(upscale_picture, clamp(texel, ivec2(0), limit))); }

vec4 shade(Pixel pixel) {
    ivec2 small = size(upscale_picture), large = output_size(), limit = small - 1;
    // Asked of the pixel, as in bloom_between_cells.
    ivec2 middle = 2 * pixel.texel + 1;
    if (middle * small == middle * large) return load(upscale_picture, pixel.texel);
    // The place among the pixels in whole numbers, since parts of a pixel far from 0 would be rounded.
    ivec2 above = middle * small - large, below = 2 * large;
    ivec2 base = ivec2(floor(vec2(above) / vec2(below)));
    ivec2 rest = above - base * below;
    ivec2 off = ivec2(greaterThanEqual(rest, below)) - ivec2(lessThan(rest, ivec2(0)));
    base += off;
    vec2 part = vec2(rest - off * below) / vec2(below);

    //     b c
    //   e f g h
    //   i j k l
    //     n o
    vec4 b = upscale_at(base + ivec2(0, -1), limit), c = upscale_at(base + ivec2(1, -1), limit);
    vec4 e = upscale_at(base + ivec2(-1, 0), limit), f = upscale_at(base, limit);
    vec4 g = upscale_at(base + ivec2(1, 0), limit), h = upscale_at(base + ivec2(2, 0), limit);
    vec4 i = upscale_at(base + ivec2(-1, 1), limit), j = upscale_at(base + ivec2(0, 1), limit);
    vec4 k = upscale_at(base + ivec2(1, 1), limit), l = upscale_at(base + ivec2(2, 1), limit);
    vec4 n = upscale_at(base + ivec2(0, 2), limit), o = upscale_at(base + ivec2(1, 2), limit);
    float f_luma = upscale_luma(f), g_luma = upscale_luma(g), j_luma = upscale_luma(j), k_luma = upscale_luma(k);
    vec2 change = vec2(0.0), rest_of = 1.0 - part;
    float straight = 0.0;
    upscale_look(change, straight, rest_of.x * rest_of.y, upscale_luma(b), upscale_luma(e), f_luma, g_luma, j_luma);
    upscale_look(change, straight, part.x * rest_of.y, upscale_luma(c), f_luma, g_luma, upscale_luma(h), k_luma);
    upscale_look(change, straight, rest_of.x * part.y, f_luma, upscale_luma(i), j_luma, k_luma, upscale_luma(n));
    upscale_look(change, straight, part.x * part.y, g_luma, j_luma, k_luma, upscale_luma(l), upscale_luma(o));

    UpscaleShape shape;
    float steep = dot(change, change);
    shape.direction = steep < 1.0 / 32768.0 ? vec2(1.0, change.y) : change * inversesqrt(steep);
    float follow = 0.25 * straight * straight * upscale_parameters().adaption;
    float stretch = dot(shape.direction, shape.direction) / max(abs(shape.direction.x), abs(shape.direction.y));
    shape.scale = vec2(1.0 + (stretch - 1.0) * follow, 1.0 - 0.5 * follow);
    shape.lobe = 0.5 + (0.25 - 0.04 - 0.5) * follow;

    vec4 sum = vec4(0.0);
    upscale_tap(sum, shape, vec2(0.0, -1.0) - part, b);
    upscale_tap(sum, shape, vec2(1.0, -1.0) - part, c);
    upscale_tap(sum, shape, vec2(-1.0, 0.0) - part, e);
    upscale_tap(sum, shape, -part, f);
    upscale_tap(sum, shape, vec2(1.0, 0.0) - part, g);
    upscale_tap(sum, shape, vec2(2.0, 0.0) - part, h);
    upscale_tap(sum, shape, vec2(-1.0, 1.0) - part, i);
    upscale_tap(sum, shape, vec2(0.0, 1.0) - part, j);
    upscale_tap(sum, shape, vec2(1.0, 1.0) - part, k);
    upscale_tap(sum, shape, vec2(2.0, 1.0) - part, l);
    upscale_tap(sum, shape, vec2(0.0, 2.0) - part, n);
    upscale_tap(sum, shape, vec2(1.0, 2.0) - part, o);
    vec3 least = min(min(f.rgb, g.rgb), min(j.rgb, k.rgb)), most = max(max(f.rgb, g.rgb), max(j.rgb, k.rgb));
    return vec4(clamp(sum.rgb / sum.a, least, most), mix(mix(f.a, g.a, part.x), mix(j.a, k.a, part.x), part.y));
}
