// SPDX-License-Identifier: MIT
#part given camera half
#include "shared/sanitize.glsl"

// What the smear knows of a pixel: the inverse of its distance, and how far its colour reaches to either side while the
// shutter is open, as x, y and length. custom[0] = (texels of the smeared picture that a pixel of velocity reaches, the
// farthest, pixels a texel, depth of the sky), custom[1] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y).
// custom[0].z is negative where motion_blur_depth is the image of half_depth(): of the texels here, and with a sign.
float motion_blur_inverse(float depth) {
    depth = custom[0].z < 0.0 ? abs(depth) : depth;
    float inverse = (depth * custom[1].z + custom[1].w) / (depth * custom[1].x + custom[1].y);
    // What is no number compares as not nearer than the sky.
    return depth != custom[0].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
}

// The pixel whose motion the texel has, and where its depth is.
ivec2 motion_blur_first(Pixel pixel) { return pixel.texel * int(abs(custom[0].z)); }
ivec2 motion_blur_place(Pixel pixel) { return custom[0].z < 0.0 ? pixel.texel : motion_blur_first(pixel); }

vec4 motion_blur_reach(vec2 velocity, float inverse) {
    vec2 reach = sanitize(vec4(velocity, 0.0, 0.0)).xy * custom[0].x;
    float along = length(reach);
    float scale = min(1.0, custom[0].y / max(along, 1e-6));
    return vec4(inverse, reach * scale, along * scale);
}

#part given
// The motion of every pixel, or of the first of every two by two, by the frame's own velocity.

vec4 shade(Pixel pixel) {
    return motion_blur_reach(load(motion_blur_velocity, motion_blur_first(pixel)).rg,
                             motion_blur_inverse(load(motion_blur_depth, motion_blur_place(pixel)).r));
}

#part camera
// The same for a world that stands still: custom[2 ... 4] = x, y and w of a moment ago, of a point of view space;
// custom[5] = (size of the picture, motion of a still point by the jitter).
#include "shared/camera.glsl"

vec4 shade(Pixel pixel) {
    float inverse = motion_blur_inverse(load(motion_blur_depth, motion_blur_place(pixel)).r);
    vec2 uv = (vec2(motion_blur_first(pixel)) + 0.5) / custom[5].xy;
    // The sky turns with the camera and does not come nearer.
    vec4 point = vec4(view_position(uv, 1.0 / max(inverse, 1.0 / sky_distance)), 1.0);
    float w = dot(custom[4], point);
    vec2 before = vec2(dot(custom[2], point), dot(custom[3], point)) / w * 0.5 + 0.5;
    // What was behind the camera has no place in the last picture.
    vec2 velocity = w > 0.0 ? (before - uv) * custom[5].xy + custom[5].zw : vec2(0.0);
    return motion_blur_reach(velocity, inverse);
}

#part half
// Half size: the mean of those of every two by two pixels that are as far away as the first, whose motion the texel has.

vec4 shade(Pixel pixel) {
    ivec2 first = pixel.texel * 2, last = min(first + 1, size(motion_blur_picture) - 1);
    // In the order of a gather: (0,1), (1,1), (1,0), (0,0).
    vec4 depth = gather_red(motion_blur_depth, (vec2(first) + 1.0) / vec2(size(motion_blur_depth)));
    vec4 inverse = (depth * custom[1].z + custom[1].w) / (depth * custom[1].x + custom[1].y);
    // Sky is like sky, whose inverse may be 0. What is no number compares as unlike.
    inverse = mix(inverse, vec4(0.0), equal(depth, vec4(custom[0].w)));
    vec4 weight = vec4(lessThanEqual(abs(inverse - inverse.w), 0.1 * inverse));
    weight.w = 1.0;
    vec4 sum = load(motion_blur_picture, first);
    sum += load(motion_blur_picture, ivec2(first.x, last.y)) * weight.x;
    sum += load(motion_blur_picture, last) * weight.y + load(motion_blur_picture, ivec2(last.x, first.y)) * weight.z;
    return sanitize(sum / dot(weight, vec4(1.0)));
}

#part clean
// Full size: the picture, in numbers that may be spread.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) { return sanitize(load(motion_blur_picture, pixel.texel)); }

#part tiles
// The longest motion among the texels under one of a smaller picture.
vec4 shade(Pixel pixel) {
    ivec2 from = size(motion_blur_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    vec4 longest = vec4(0.0);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec4 motion = load(motion_blur_from, ivec2(x, y));
            longest = motion.w > longest.w ? motion : longest;
        }
    return longest;
}

#part around
// The longest motion of a tile and its eight neighbours: nothing farther away reaches a pixel of the tile.
vec4 shade(Pixel pixel) {
    vec4 longest = vec4(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec4 motion = load_clamped(motion_blur_from, pixel.texel + ivec2(x, y));
            longest = motion.w > longest.w ? motion : longest;
        }
    return longest;
}

#part smear
// What smears over a pixel from in front, and what the pixel's own surface smears to: see the page. Premultiplied; alpha is
// how much of the sharp picture is covered. A motion is (1 / distance, x, y, length).

// Jorge Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (2014): interleaved gradient noise.
float motion_blur_noise(ivec2 texel) {
    return fract(52.9829189 * fract(dot(vec2(texel), vec2(0.06711056, 0.00583715))));
}

// 1 where what reaches this far (in texels) moves at all.
float motion_blur_moves(float reach) { return clamp(reach * 2.0 - 1.0, 0.0, 1.0); }

ivec2 motion_blur_texel(Pixel pixel, vec2 way) {
    return clamp(pixel.texel + ivec2(floor(way + 0.5)), ivec2(0), pixel.size - 1);
}

vec4 shade(Pixel pixel) {
    float noise = motion_blur_noise(pixel.texel);
    // Tiles have no visible edge where pixels near it look beyond it now and then.
    vec2 aside = vec2(noise, motion_blur_noise(pixel.texel.yx)) * 0.5 - 0.25;
    vec4 fastest =
        load_clamped(motion_blur_fastest, ivec2(floor(pixel.uv * vec2(size(motion_blur_fastest)) + aside)));
    vec4 own = load(motion_blur_motion, pixel.texel);
    int rounds = fastest.w < 0.5 ? 0 : motion_blur_parameters().samples / 2;
    float step = 2.0 / float(max(rounds, 1)), spread = fastest.w * 0.5 * step;
    // Ten times the pixel's distance: how far in front a sample lies is clamp(tenfold / distance - 10, 0, 1).
    float tenfold = 10.0 / max(own.x, 1.0 / 60000.0);
    vec2 direction = fastest.yz / max(fastest.w, 1e-6);
    float cosine = dot(own.yz, direction) / max(own.w, 1e-6);
    float alike = max(4.0 * cosine * cosine - 3.0, 0.0);
    vec4 front = vec4(0.0), behind = vec4(0.0);
    for (int i = 0; i < rounds; ++i) {
        // Along the fastest motion around: whatever crosses this pixel.
        float place = (float(i) + noise) * step - 1.0, away = abs(place) * fastest.w;
        ivec2 texel = motion_blur_texel(pixel, fastest.yz * place);
        vec4 motion = load(motion_blur_motion, texel);
        vec3 color = load(motion_blur_color, texel).rgb;
        float in_front = clamp(tenfold * motion.x - 10.0, 0.0, 1.0), inverse = 1.0 / max(motion.w, 0.5);
        float toward = dot(motion.yz, direction) * inverse;
        float covers = in_front * motion_blur_moves(motion.w) * toward * toward *
                       clamp(motion.w - away + 1.0, 0.0, 1.0) * min(spread * inverse, 1.0);
        front += vec4(color, 1.0) * covers;
        behind += vec4(color, 1.0) * ((1.0 - in_front) * alike * clamp(own.w - away + 1.0, 0.0, 1.0));
        // Along its own: what it is smeared with.
        texel = motion_blur_texel(pixel, own.yz * ((float(i) + fract(noise + 0.5)) * step - 1.0));
        in_front = clamp(tenfold * load(motion_blur_motion, texel).x - 10.0, 0.0, 1.0);
        behind += vec4(load(motion_blur_color, texel).rgb, 1.0) * (1.0 - in_front);
    }
    front /= max(front.a, 1.0);
    float smears = motion_blur_moves(own.w) * (1.0 - front.a) * min(behind.a, 1.0);
    return front + vec4(behind.rgb / max(behind.a, 1e-6), 1.0) * smears;
}

#part end
// scene_linear -> scene_linear. Lays what is smeared over the sharp picture.
vec4 motion_blur(vec4 color, Pixel pixel, MotionBlur parameters) {
    vec4 over = sample_linear(motion_blur_smeared, pixel.uv);
    return vec4(color.rgb * (1.0 - over.a) + over.rgb, color.a);
}
