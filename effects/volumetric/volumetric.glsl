// SPDX-License-Identifier: MIT
#part march
// Light that the haze before the surface scatters toward the camera, of one light; alpha, of the first light: planar
// distance. Everything that is linear in the texel and in the planar distance comes ready from the CPU. custom[0] = (samples,
// max distance, what a step leaves, density times intensity), custom[1] = (x per texel, x at texel 0, y per texel, y at
// texel 0) of the ray where its planar distance is 1, custom[2] = (cosine to the light times the ray's length: at texel 0, per
// texel x, y; is first), custom[3] = (color, is perspective), and of cascade c custom[4 + 4c] = (its u, v and depth at
// distance 0; far distance), custom[5 + 4c] = (the same per distance at texel 0; of the first cascade: how many there are),
// custom[6 + 4c] and custom[7 + 4c]: per texel x and y, and distance where the camera is perspective. custom[6].w: log2 of
// what a metre leaves.

// Henyey and Greenstein, "Diffuse radiation in the galaxy", 1941, g = 0.8: forward scattering.
float volumetric_phase(float cosine) {
    const float g = 0.8;
    float x = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * 3.14159265 * x * sqrt(x));
}

// The samples of one cascade, `first` to `end` - 1, before the light of those behind them: from the last one on, since each
// takes its share of what comes from behind. A round runs before the loop asks whether it was the last.
float volumetric_lit(float sum, float left, float first, float end, vec3 place, vec3 slope, float cascade) {
    float i = end - 1.0;
    if (i >= first) {
        [[dont_unroll]] do {
            vec3 at = place + slope * i;
            sum = sum * left + texture(volumetric_shadow, vec4(at.xy, cascade, min(at.z, 1.0)));
            i -= 1.0;
        } while (i >= first);
    }
    return sum;
}

// The cascade's four vectors, and `at`: texel, length of a step, jitter.
float volumetric_cascade(float sum, float left, float first, float end, vec4 start, vec4 ray, vec4 per_x, vec4 per_y, vec4 at,
                         float cascade) {
    float perspective = custom[3].w;
    vec3 turn = per_x.xyz * at.x + per_y.xyz * at.y, slope = (ray.xyz + turn * perspective) * at.z;
    return volumetric_lit(sum, left, first, end, start.xyz + turn * (1.0 - perspective) + slope * at.w, slope, cascade);
}

vec4 shade(Pixel pixel) {
    float planar = abs(load(volumetric_distance, pixel.texel).r);
    // NaN counts as sky, which lies where half precision ends.
    planar = planar < 60000.0 ? max(planar, 0.0) : 60000.0;
    float jitter = load(volumetric_noise, pixel.texel & 63).r;
    vec2 texel = vec2(pixel.texel);
    vec4 march = custom[0];
    float true_of_planar = length(vec3(texel * custom[1].xz + custom[1].yw, 1.0));
    float samples = march.x;
    float step_length = min(planar, march.y / true_of_planar) / max(samples, 1.0);

    // Cascades lie one behind the other; samples behind the last are lit. Depth is compared no farther than where the
    // light's volume ends: nothing is known to cast behind it.
    vec4 ends = vec4(custom[4].w, custom[8].w, custom[12].w, custom[16].w) / max(step_length, 1e-20) - jitter;
    ends = clamp(ceil(mix(vec4(0.0), ends, lessThan(vec4(0.0, 1.0, 2.0, 3.0), vec4(custom[5].w)))), 0.0, samples);
    ends.y = max(ends.x, ends.y);
    ends.z = max(ends.y, ends.z);
    ends.w = max(ends.z, ends.w);
    float sum = 0.0;
    // What a step leaves: a share of the march, or of a metre, whose first sample lies a part of a step away, too.
    float per_step = custom[6].w * step_length * true_of_planar, left = march.z * exp2(per_step);
    [[dont_unroll]] for (float i = ends.w; i < samples; ++i) sum = sum * left + 1.0;
    vec4 at = vec4(texel, step_length, jitter);
    sum = volumetric_cascade(sum, left, ends.z, ends.w, custom[16], custom[17], custom[18], custom[19], at, 3.0);
    sum = volumetric_cascade(sum, left, ends.y, ends.z, custom[12], custom[13], custom[14], custom[15], at, 2.0);
    sum = volumetric_cascade(sum, left, ends.x, ends.y, custom[8], custom[9], custom[10], custom[11], at, 1.0);
    sum = volumetric_cascade(sum, left, 0.0, ends.x, custom[4], custom[5], custom[6], custom[7], at, 0.0);
    float cosine = (custom[2].x + custom[2].y * texel.x + custom[2].z * texel.y) / true_of_planar;
    float scattered =
        sum * exp2(per_step * jitter) * step_length * true_of_planar * march.w * volumetric_phase(cosine);
    // Four lights must not add up to more than half precision holds.
    return vec4(min(custom[3].rgb * scattered, vec3(16000.0)), custom[2].w * planar);
}

#part blur_x blur_y
// One direction of a 5 x 5 Gaussian, over pixels whose distance, in alpha, is like this one's.

vec4 volumetric_tap(Pixel pixel, ivec2 offset) {
    return load_clamped(volumetric_light, pixel.texel + offset);
}

vec4 volumetric_blur(Pixel pixel, ivec2 axis) {
    vec4 own = volumetric_tap(pixel, ivec2(0));
    vec4 taps[4] = vec4[4](volumetric_tap(pixel, axis), volumetric_tap(pixel, 2 * axis), volumetric_tap(pixel, -axis),
                           volumetric_tap(pixel, -2 * axis));
    float falloff = 10.0 / max(own.a, 1e-3);
    vec4 sum = vec4(own.rgb, 1.0);
    for (int i = 0; i < 4; ++i) {
        float like = max(1.0 - falloff * abs(taps[i].a - own.a), 0.0);
        sum += vec4(taps[i].rgb, 1.0) * (like * (i % 2 == 0 ? exp(-0.2) : exp(-0.8)));
    }
    return vec4(sum.rgb / sum.a, own.a);
}

#part blur_x
vec4 shade(Pixel pixel) { return volumetric_blur(pixel, ivec2(1, 0)); }

#part blur_y
vec4 shade(Pixel pixel) { return volumetric_blur(pixel, ivec2(0, 1)); }

#part end
// scene_linear -> scene_linear. Adds the shafts: of the four nearest half-size pixels those count whose distance, in alpha,
// is like this pixel's. volumetric_depth: the host's; volumetric_custom(0) and (1).x: the constants of planar_distance().
#include "shared/planar_distance.glsl"

vec4 volumetric(vec4 color, Pixel pixel, Volumetric parameters) {
    float depth = load(volumetric_depth, pixel.texel).r;
    // The sky lies where half precision ends.
    float planar = clamp(planar_distance(depth, volumetric_custom(0), volumetric_custom(1).x), 1e-3, 60000.0);
    float inverse = 1.0 / planar;
    // Neutral images are of one texel, so nothing is read beyond what size() says.
    ivec2 second = pixel.texel & 1, last = size(volumetric_shafts) - 1;
    ivec2 here = min((pixel.texel >> 1) + second, last), there = min((pixel.texel >> 1) + 1 - second, last);
    vec4 taps[4] = vec4[4](load(volumetric_shafts, here), load(volumetric_shafts, ivec2(there.x, here.y)),
                           load(volumetric_shafts, ivec2(here.x, there.y)), load(volumetric_shafts, there));
    vec2 other = 0.5 * vec2(second);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 bilinear = mix(1.0 - other, other, vec2(i & 1, i >> 1));
        vec4 tap = taps[i];
        float unlike = 0.01 + abs(tap.a * inverse - 1.0), reach = max(min(tap.a, parameters.max_distance), 1e-3);
        float weight = (bilinear.x * bilinear.y + 1e-3) / (unlike * reach);
        // What is thinner than a half-size pixel has nobody like it; the light before it is then estimated by length.
        sum += tap.rgb * (weight * min(planar, reach));
        weights += weight * reach;
    }
    return vec4(color.rgb + sum / weights, color.a);
}
