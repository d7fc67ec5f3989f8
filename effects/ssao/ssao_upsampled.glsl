// SPDX-License-Identifier: MIT
// Visibility of the four full-size pixels of every half-size one. Of the four half-size pixels around, those count whose
// surface goes on to the full-size pixel (after Kopf et al., "Joint Bilateral Upsampling", 2007). ssao_depth: the host's;
// custom[0] and [1].x: the constants of planar_distance(); [1].yz: how wide a pixel is, by the distance and beside it.
// Needs shared/planar_distance.glsl and ssao_packed.glsl before it.

// Half-size pixel i holds full-size pixel 2i, and the blur moved its middle by half a half-size pixel back: an even
// full-size pixel is half way between two, an odd one on the second. The rest is for edges, where that one is unlike.
const float ssao_rest = 0.05;
// Of a pixel whose normal is unlike: where none is alike, the depth decides.
const float ssao_least_turned = 0.001;

float ssao_mean(vec4 visibility, vec4 expected, float planar, vec4 share, vec4 turned) {
    float scale = 0.7 / max(custom[1].y + custom[1].z / planar, 4e-4);
    vec4 unlike = expected * (planar * scale) - scale;
    // Where all are unlike, the nearest counts.
    vec4 like = 1.0 / (1.0 + unlike * unlike), weight = (turned * share + ssao_least_turned * share) * like * like;
    // The mean of ones shall be one, not what rounding leaves of it.
    float mean = min(dot(visibility, weight) / dot(weight, vec4(1022.998)), 1.0);
    return planar > 1e-6 && planar < 1e9 ? mean : 1.0;
}

// Order of a gather, of nearness here and of visibilities in the result: (0,1), (1,1), (1,0), (0,0). `turned`: for each of
// the four full-size pixels, how far the normals of the half-size ones count.
vec4 ssao_upsampled(Pixel pixel, mat4 turned) {
    vec2 corner = (vec2(pixel.texel) + 1.0) / vec2(pixel.size);
    vec4 packed = gather_red(ssao_blurred, corner);
    vec4 slopes = gather_green(ssao_blurred, corner);
    vec4 depth = gather_red(ssao_depth, (vec2(pixel.texel) * 2.0 + 1.0) / vec2(size(ssao_depth)));
    vec4 planar = planar_distance(depth, custom[0], custom[1].x);
    vec4 visibility = ssao_visibility(packed);
    // By half a half-size pixel.
    vec2 low = ssao_slope_of(slopes.w), right = ssao_slope_of(slopes.z);
    vec2 below = ssao_slope_of(slopes.x), high = ssao_slope_of(slopes.y);
    vec4 x = 0.5 * packed * vec4(below.x, high.x, right.x, low.x), y = 0.5 * packed * vec4(below.y, high.y, right.y, low.y);
    vec4 first = packed - 2.0 * (x * vec4(0.0, 1.0, 1.0, 0.0) + y * vec4(1.0, 1.0, 0.0, 0.0));
    return vec4(ssao_mean(visibility, first + y, planar.x, vec4(0.5, 0.5, 0.0, 0.0) + ssao_rest, turned[0]),
                ssao_mean(visibility, first + x + y, planar.y, vec4(0.0, 1.0, 0.0, 0.0) + ssao_rest, turned[1]),
                ssao_mean(visibility, first + x, planar.z, vec4(0.0, 0.5, 0.5, 0.0) + ssao_rest, turned[2]),
                ssao_mean(visibility, first, planar.w, vec4(0.25) + ssao_rest, turned[3]));
}
