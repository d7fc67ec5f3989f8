// SPDX-License-Identifier: MIT
#part blur widen upsample upsample_by_normals occlusion
// Nearness, one over the planar distance, with the visibility in its last ten bits; beside it the surface's slope from one
// texel to the next, as a share of the nearness: two halves of less than 1, whose unused bit makes an ordinary number of
// them, which no device flushes to zero. The last three bits of both say how much of the noise's tile the surface covers, in
// quarters of a texel less one.

const uint ssao_ordinary = 0x40000000u, ssao_cover = 0x70007u;

vec4 ssao_visibility(vec4 packed) { return vec4(floatBitsToInt(packed) & 1023); }

// The middle of what it may have been.
float ssao_near(float packed) { return intBitsToFloat((floatBitsToInt(packed) & ~1023) | 512); }

float ssao_with(float near, float visibility) {
    return intBitsToFloat((floatBitsToInt(near) & ~1023) | int(visibility + 0.5));
}

// `covered`: of the tile's 16 texels, at least the one here.
float ssao_pack_slope(vec2 slope, float covered) {
    uint halves = packHalf2x16(clamp(slope, vec2(-0.999), vec2(0.999))) & ~ssao_cover;
    uint quarters = uint(max(covered * 4.0 - 0.5, 0.0));
    return uintBitsToFloat(halves | ssao_ordinary | (quarters & 7u) | (quarters & 56u) << 13);
}

vec2 ssao_slope_of(float packed) { return unpackHalf2x16(floatBitsToUint(packed) & ~(ssao_ordinary | ssao_cover)); }

// In quarters of a texel.
vec4 ssao_covered(vec4 packed) {
    uvec4 bits = floatBitsToUint(packed);
    return vec4((bits & 7u) | (bits >> 13 & 56u)) + 1.0;
}

#part blur widen upsample_by_normals
// How far normals count of one surface, by their cosine: in full up to some 18 degrees, not from 37 on. `per_turn`: the
// normal here times ssao_per_turn, so that a normal takes three multiply-adds.
const float ssao_per_turn = 1.0 / 0.15, ssao_last_turn = 0.8 / 0.15;

float ssao_turned(vec3 normal, vec3 per_turn) {
    return clamp(normal.x * per_turn.x + (normal.y * per_turn.y + (normal.z * per_turn.z - ssao_last_turn)), 0.0, 1.0);
}

vec4 ssao_turned(vec3 a, vec3 b, vec3 c, vec3 d, vec3 per_turn) {
    return vec4(ssao_turned(a, per_turn), ssao_turned(b, per_turn), ssao_turned(c, per_turn), ssao_turned(d, per_turn));
}

#part blur widen
// Whether pixels lie in one surface, by their nearness: one over the planar distance, which is linear across the picture
// of a plane; and by their normals, which tell the sides of an edge apart that meet in it. Slopes are shares of the
// nearness here. custom[0] and [1]: the ray through a texel, xy * texel + zw, by the distance and beside it.

// Of the nearness: a texel's width, or what is left of it beside the bits that the visibility takes.
float ssao_width(float near) { return max(custom[0].x + custom[1].x * near, 3e-4); }

// One over what a surface may bend: a texel's width and four tenths of its slope, as round parts do toward their
// outlines; at twice that it is another one.
float ssao_tolerance(float near, vec2 slope) {
    return 1.0 / (ssao_width(near) + 0.4 * (abs(slope.x) + abs(slope.y)));
}

vec4 ssao_weight(vec4 unlike, float tolerance) { return clamp(2.0 - abs(unlike) * tolerance, 0.0, 1.0); }

#part blur
// The mean over the tile of the noise, of those pixels that lie in the surface here. The tile reaches from two pixels before
// this one to one after; the upsampling makes up for the half pixel. Beside it the surface's slope, and how much of the tile
// the mean is of.

// Of the plane through a pixel with this normal.
vec2 ssao_plane_slope(ivec2 texel, float near, vec3 normal) {
    float toward = dot(normal.xy, vec2(texel) * custom[0].xy + custom[0].zw) - normal.z;
    return clamp(normal.xy * (custom[0].xy + custom[1].xy * near) / min(toward, -0.02), vec2(-0.999), vec2(0.999));
}

// That of the normal's plane, as far as the pixels before and after agree: between the two it is the plane's, so on thin
// parts, too; else that of the nearer one, as on flat parts whose normals are smoothed. Continuous in all three.
vec2 ssao_slope(vec2 before, vec2 after, vec2 plane) {
    vec2 a = 1.0 - before, b = after - 1.0;
    return min(max(plane, min(a, b)), max(a, b));
}

// How far normals count of pixels whose nearness is so much above that of the surface here, in the order of a gather. What
// lies before it, across a corner of a room, is as dark as the surface is there, and counts in full: without it the corner
// would lose its shade.
vec4 ssao_beside(vec4 above, ivec2 low, vec3 per_turn, float per_width) {
    vec4 turned = ssao_turned(load_clamped(ssao_normals, low + ivec2(0, 1)).xyz, load_clamped(ssao_normals, low + ivec2(1, 1)).xyz,
                              load_clamped(ssao_normals, low + ivec2(1, 0)).xyz, load_clamped(ssao_normals, low).xyz, per_turn);
    return max(turned, clamp(above * per_width, 0.0, 1.0));
}

// Order of a gather: (0,1), (1,1), (1,0), (0,0).
vec4 shade(Pixel pixel) {
    ivec2 at = pixel.texel;
    vec2 texel = 1.0 / vec2(pixel.size);
    vec2 low = (vec2(at) - 1.0) * texel, high = (vec2(at) + 1.0) * texel;
    vec4 packed_00 = gather_red(ssao_raw, low), packed_10 = gather_red(ssao_raw, vec2(high.x, low.y));
    vec4 packed_01 = gather_red(ssao_raw, vec2(low.x, high.y)), packed_11 = gather_red(ssao_raw, high);
    float own = ssao_near(packed_11.w), per_own = 1.0 / own;
    vec3 normal = load(ssao_normals, at).xyz, per_turn = normal * ssao_per_turn;
    vec2 before = vec2(ssao_near(packed_01.z), ssao_near(packed_10.x)), after = vec2(ssao_near(packed_11.z), ssao_near(packed_11.x));
    vec2 slope = ssao_slope(per_own * before, per_own * after, ssao_plane_slope(at, own, normal));
    float tolerance = ssao_tolerance(own, slope), per_width = 2.0 / ssao_width(own);
    vec4 expected = 1.0 + slope.x * vec4(0.0, 1.0, 1.0, 0.0) + slope.y * vec4(1.0, 1.0, 0.0, 0.0);
    vec4 above_00 = packed_00 * per_own - (expected - 2.0 * (slope.x + slope.y));
    vec4 above_10 = packed_10 * per_own - (expected - 2.0 * slope.y);
    vec4 above_01 = packed_01 * per_own - (expected - 2.0 * slope.x);
    vec4 above_11 = packed_11 * per_own - expected;
    vec4 weight_00 = ssao_weight(above_00, tolerance) * ssao_beside(above_00, at - 2, per_turn, per_width);
    vec4 weight_10 = ssao_weight(above_10, tolerance) * ssao_beside(above_10, at - ivec2(0, 2), per_turn, per_width);
    vec4 weight_01 = ssao_weight(above_01, tolerance) * ssao_beside(above_01, at - ivec2(2, 0), per_turn, per_width);
    vec4 weight_11 = ssao_weight(above_11, tolerance) * ssao_beside(above_11, at, per_turn, per_width);
    float sum = dot(ssao_visibility(packed_00), weight_00) + dot(ssao_visibility(packed_10), weight_10) +
                dot(ssao_visibility(packed_01), weight_01) + dot(ssao_visibility(packed_11), weight_11);
    // Its own weight is one.
    float covered = dot(weight_00 + weight_10 + weight_01 + weight_11, vec4(1.0));
    return vec4(ssao_with(own, sum / covered), ssao_pack_slope(slope, covered), 0.0, 0.0);
}

#part widen
// The mean over this tile and the four beside it (after Holger Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform",
// 2010), of those pixels that lie in the surface here; each counts as far as its mean is of a whole tile (Hans Knutsson and
// Carl-Fredrik Westin, "Normalized and Differential Convolution", 1993). Of two that lie opposite each other both count
// nearly alike: what rises steadily, toward a corner of a room, stays as it is up to the corner. Where the mean here is of
// few pixels, before an edge and on thin parts, its noise is worse than what the rise loses, and one of the two will do.

const float ssao_alike = 0.85;

vec4 shade(Pixel pixel) {
    ivec2 at = pixel.texel, left = at - ivec2(4, 0), right = at + ivec2(4, 0), above = at - ivec2(0, 4), below = at + ivec2(0, 4);
    vec2 own = load(ssao_tile, at).rg;
    vec2 a = load_clamped(ssao_tile, left).rg, b = load_clamped(ssao_tile, right).rg;
    vec2 c = load_clamped(ssao_tile, above).rg, d = load_clamped(ssao_tile, below).rg;
    vec4 sides = vec4(a.r, b.r, c.r, d.r);
    vec2 slope = 4.0 * ssao_slope_of(own.g);
    vec4 like = ssao_weight(sides * (1.0 / own.r) - 1.0 - vec4(-slope.x, slope.x, -slope.y, slope.y), ssao_tolerance(own.r, slope));
    like *= ssao_turned(load_clamped(ssao_normals, left).xyz, load_clamped(ssao_normals, right).xyz,
                        load_clamped(ssao_normals, above).xyz, load_clamped(ssao_normals, below).xyz,
                        load(ssao_normals, at).xyz * ssao_per_turn);
    float covered = ssao_covered(own.gggg).r;
    vec4 weight = mix(like, min(like, like.yxwz), ssao_alike / 64.0 * covered) * ssao_covered(vec4(a.g, b.g, c.g, d.g));
    float sum = dot(ssao_visibility(sides), weight) + ssao_visibility(own.rrrr).r * covered;
    return vec4(ssao_with(own.r, sum / (dot(weight, vec4(1.0)) + covered)), own.g, 0.0, 0.0);
}

#part upsample upsample_by_normals
#include "shared/planar_distance.glsl"

// Visibility of the four full-size pixels of every half-size one. Of the four half-size pixels around, those count whose
// surface goes on to the full-size pixel (after Kopf et al., "Joint Bilateral Upsampling", 2007). ssao_depth: the host's;
// custom[0] and [1].x: the constants of planar_distance(); [1].yz: how wide a pixel is, by the distance and beside it.

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

#part upsample
// By depth alone, where the frame has no normals.

vec4 shade(Pixel pixel) { return ssao_upsampled(pixel, mat4(vec4(1.0), vec4(1.0), vec4(1.0), vec4(1.0))); }

#part upsample_by_normals
// By depth and by the frame's normals, which part the sides of an edge that both go on to a full-size pixel.

vec4 shade(Pixel pixel) {
    ivec2 first = pixel.texel * 2, next = min(pixel.texel + 1, pixel.size - 1) * 2;
    // Half-size pixel i holds full-size pixel 2i.
    vec3 own = load(ssao_frame_normals, first).xyz, right = load(ssao_frame_normals, ivec2(next.x, first.y)).xyz;
    vec3 below = load(ssao_frame_normals, ivec2(first.x, next.y)).xyz, far = load(ssao_frame_normals, next).xyz;
    vec3 at_01 = load_clamped(ssao_frame_normals, first + ivec2(0, 1)).xyz * ssao_per_turn;
    vec3 at_11 = load_clamped(ssao_frame_normals, first + 1).xyz * ssao_per_turn;
    vec3 at_10 = load_clamped(ssao_frame_normals, first + ivec2(1, 0)).xyz * ssao_per_turn;
    return ssao_upsampled(pixel, mat4(ssao_turned(below, far, right, own, at_01), ssao_turned(below, far, right, own, at_11),
                                      ssao_turned(below, far, right, own, at_10),
                                      ssao_turned(below, far, right, own, own * ssao_per_turn)));
}

#part end
// Brings the visibility to the picture: half-size pixels hold that of four pixels.

vec4 ssao(vec4 color, Pixel pixel, Ssao parameters) {
    float visibility;
    if (parameters.resolution == Ssao_resolution_half) {
        // The last of an odd number of pixels takes its neighbour's.
        ivec2 base = min(pixel.texel >> 1, size(ssao_half) - 1);
        bvec2 is_second = greaterThan(pixel.texel, base << 1);
        vec4 four = load(ssao_half, base);
        vec2 pair = is_second.x ? four.zy : four.wx;
        visibility = is_second.y ? pair.y : pair.x;
    } else {
        visibility = float(floatBitsToInt(load_clamped(ssao_full, pixel.texel).r) & 1023) / 1023.0;
    }
    float luma = clamp(dot(color.rgb, vec3(0.299, 0.587, 0.114)), 0.0, 1.0);
    visibility = parameters.merge == Ssao_merge_luminance ? mix(visibility, 1.0, luma * 0.5) : visibility;
    return vec4(color.rgb * visibility, color.a);
}
