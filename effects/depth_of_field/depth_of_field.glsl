// SPDX-License-Identifier: MIT
#part half clean gather end
// What is left to blur of a circle where the passes blur by themselves, as one whose radius has the square `own` does, in
// texels: variances are subtracted where they are large enough, in a smooth way. Up to half a pixel nothing is, so that what
// is sharp covers nothing beside itself.
float depth_of_field_left(float radius, float own, float pixels_a_texel) {
    float rest = radius * radius - own, beyond = clamp(2.0 * radius * pixels_a_texel - 1.0, 0.0, 1.0);
    return beyond * sqrt(0.5 * (rest + sqrt(rest * rest + own * own)));
}

// How much of what is blurred so is laid over the sharp picture: from a radius at which a circle is sharp to one at which it
// is not, ever more slowly. ends = (the latter times slope, slope).
float depth_of_field_weight(float left, vec2 ends) {
    float missing = clamp(ends.x - left * ends.y, 0.0, 1.0);
    return 1.0 - missing * missing;
}

// The same for circles of the far field, by their radius in pixels: smaller ones are made of the pixels around.
float depth_of_field_large(float radius) {
    return clamp((radius - 2.5) * 1.2, 0.0, 1.0);
}

#part half clean
// The circle that a point is seen as, as its radius in texels of the blurred picture: negative before the distance that is
// sharp. custom[0] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y), custom[1] = (radius at infinity, that times
// the distance that is sharp, largest radius, depth of the sky), custom[2] = (pixels a texel, what depth_of_field_left()
// takes, and what depth_of_field_weight() does).

float depth_of_field_circle(float depth) {
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    return clamp(custom[1].x - custom[1].y * inverse, -custom[1].z, custom[1].z);
}

// The same with what is left to blur.
float depth_of_field_to_blur(float circle) {
    if (circle < 0.0) return -depth_of_field_left(-circle, custom[2].y, custom[2].x);
    return circle * custom[2].x < 2.0 ? 0.0 : sqrt(max(circle * circle - custom[2].y, 0.001));
}

#part half
// Half size: colour and circle of a surface under every two by two pixels. Of their circles it is the second smallest;
// where that is of the near field, in every other texel of a chessboard the third, so that edges neither grow nor shrink.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    ivec2 a = pixel.texel * 2, d = min(a + 1, size(depth_of_field_picture) - 1);
    ivec2 b = ivec2(d.x, a.y), c = ivec2(a.x, d.y);
    vec4 circles = vec4(depth_of_field_circle(load(depth_of_field_depth, a).r),
                        depth_of_field_circle(load(depth_of_field_depth, b).r),
                        depth_of_field_circle(load(depth_of_field_depth, c).r),
                        depth_of_field_circle(load(depth_of_field_depth, d).r));
    float low = max(min(circles.x, circles.y), min(circles.z, circles.w));
    float high = min(max(circles.x, circles.y), max(circles.z, circles.w));
    float own = min(low, high);
    if (own < 0.0 && ((pixel.texel.x + pixel.texel.y) & 1) == 1) own = max(low, high);
    // Of one surface are circles that differ by less than about a pixel, or a quarter.
    vec4 weight = clamp(1.5 + 0.25 * abs(own * custom[2].x) - abs(circles - own) * custom[2].x, 0.0, 1.0);
    vec4 sum = load(depth_of_field_picture, a) * weight.x + load(depth_of_field_picture, b) * weight.y;
    sum += load(depth_of_field_picture, c) * weight.z + load(depth_of_field_picture, d) * weight.w;
    return vec4(sanitize(sum / dot(weight, vec4(1.0))).rgb, depth_of_field_to_blur(own));
}

#part clean
// Full size: colour, in numbers that may be spread, and circle of every pixel.
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    return vec4(sanitize(load(depth_of_field_picture, pixel.texel)).rgb,
                depth_of_field_to_blur(depth_of_field_circle(load(depth_of_field_depth, pixel.texel).r)));
}

#part first_tiles
// The largest circle of the near field among the texels under one of a smaller picture.
vec4 shade(Pixel pixel) {
    ivec2 from = size(depth_of_field_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    float smallest = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) smallest = min(smallest, load(depth_of_field_from, ivec2(x, y)).a);
    return vec4(-smallest);
}

#part tiles
// The same among small tiles.
vec4 shade(Pixel pixel) {
    ivec2 from = size(depth_of_field_from);
    ivec2 first = pixel.texel * from / pixel.size, last = ((pixel.texel + 1) * from - 1) / pixel.size;
    float largest = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) largest = max(largest, load(depth_of_field_from, ivec2(x, y)).r);
    return vec4(largest);
}

#part around
// The largest of a tile and its eight neighbours: nothing farther away reaches a pixel of the tile.
vec4 shade(Pixel pixel) {
    float largest = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            largest = max(largest, load_clamped(depth_of_field_from, pixel.texel + ivec2(x, y)).r);
    return vec4(largest);
}

#part focus
// One group: the middle one of 5 by 5 distances about a place, and how far the lens has come toward it by now.
// depth_of_field_focus holds the distance that is sharp, in metres, the same in dioptres, and the dioptres that the lens
// moves toward; zeros before the first frame and after a cut. custom[0] = (x, y, z, w) with 1 / distance =
// (d z + w) / (d x + y), custom[1] = (depth of the sky, dioptres of way since the frame before, the farthest and the
// nearest that there may be in dioptres).
shared float depth_of_field_seen[25];

float depth_of_field_dioptres(float depth) {
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].x && inverse > 0.0 ? inverse : 0.0;
    return clamp(inverse, custom[1].z, custom[1].w);
}

// At constant speed while more than a tenth of a dioptre is left, then in proportion to what is left. Two steps leave
// what one does that is as long as both.
float depth_of_field_moved(float dioptres, float target) {
    const float slow = 0.1;
    float left = abs(target - dioptres), way = custom[1].y, steady = clamp(left - slow, 0.0, way);
    left = (left - steady) * exp((steady - way) / slow);
    return target < dioptres ? target + left : target - left;
}

void run() {
    int own = int(gl_LocalInvocationIndex);
    ivec2 extent = size(depth_of_field_depth);
    float seen = 0.0;
    if (own < 25) {
        // A hundredth of the height to each side.
        int apart = max((extent.y + 100) / 200, 1);
        ivec2 place = ivec2(depth_of_field_parameters().autofocus_place * vec2(extent));
        ivec2 texel = clamp(place + (ivec2(own % 5, own / 5) - 2) * apart, ivec2(0), extent - 1);
        seen = depth_of_field_dioptres(load(depth_of_field_depth, texel).r);
        depth_of_field_seen[own] = seen;
    }
    barrier();
    if (own >= 25) return;
    int before = 0;
    for (int i = 0; i < 25; ++i) {
        float other = depth_of_field_seen[i];
        before += other < seen || (other == seen && i < own) ? 1 : 0;
    }
    if (before != 12) return;
    // From the frame before on it moved toward what that frame showed.
    bool is_first = depth_of_field_focus[0] <= 0.0;
    float dioptres = is_first ? seen : depth_of_field_moved(depth_of_field_focus[1], depth_of_field_focus[2]);
    depth_of_field_focus[0] = 1.0 / dioptres;
    depth_of_field_focus[1] = dioptres;
    depth_of_field_focus[2] = seen;
}

#part focused
// By how many pixels the circle that a point is seen as lies below the largest, where the lens focuses by itself: what
// depth_of_field_circle() then takes for the depth. custom[0] = (x, y, z, w) with 1 / distance = (d z + w) / (d x + y),
// custom[1] = (radius of a circle by the dioptres between it and what is sharp, focal length, largest radius, depth of the
// sky), custom[2].x = dioptres of the nearest distance that the lens can make sharp.
vec4 shade(Pixel pixel) {
    float depth = load(depth_of_field_depth, pixel.texel).r;
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    float dioptres = min(depth_of_field_focus[1], custom[2].x), largest = custom[1].z;
    float circle = custom[1].x / (1.0 - custom[1].y * dioptres) * (dioptres - inverse);
    return vec4(largest - clamp(circle, -largest, largest));
}

#part gather fill
// What is gathered about a texel: the radius, in texels, and the distance between rings.
struct DepthOfFieldRings {
    float circle;   // the texel's own
    float near;     // the largest of the near field around
    float radius;   // of the farthest ring
    int count;
    float rings_a_texel;
    float spacing;  // of rings, in texels
};

DepthOfFieldRings depth_of_field_rings(Pixel pixel) {
    float circle = load(depth_of_field_color, pixel.texel).a;
    ivec2 tile = pixel.texel * size(depth_of_field_near_tiles) / pixel.size;
    float near = load(depth_of_field_near_tiles, tile).r, radius = max(near, circle);
    int count = clamp(int(ceil(radius)), 2, depth_of_field_parameters().rings);
    // Rings of whole weight, and the last of half of it, spread as a disc of this radius does.
    float square = float(count * count), spread = sqrt((1.0 + 4.0 * square) / (4.0 * square * (square + 1.0)));
    radius = max(radius, 1e-3);
    return DepthOfFieldRings(circle, near, radius, count, float(count) / radius, radius * spread);
}

#part gather
// What reaches a texel: see the page. result[0]: what is seen behind the near field, where that is no sharp pixel;
// result[1]: the near field. Both premultiplied. custom[0] = (smallest radius that is a blur, 0, shift of the barrel's circle
// from edge to edge of the picture in radii), custom[1] = (what depth_of_field_weight() takes, 0, 0), custom[2] ...: two
// samples each, rings of radius 1, 2, 3 ... about the centre.

const float depth_of_field_pi = 3.14159265;

// A quarter of how many samples lie in a circle whose radius is given in rings; one that its edge cuts counts in part.
float depth_of_field_quarter(float radius) {
    float part = fract(radius + 0.5);
    return radius * radius + (part - part * part);
}

ivec4 depth_of_field_texels(Pixel pixel, vec4 places, float spacing) {
    return ivec4(clamp(places * spacing + (vec4(pixel.texel.xyxy) + 0.5), vec4(0.0), vec4(pixel.size.xyxy) - 0.5));
}

// All that has no blurred circle of the near field around: the far one alone.
vec4 depth_of_field_far(Pixel pixel, DepthOfFieldRings rings) {
    vec4 behind = vec4(load(depth_of_field_color, pixel.texel).rgb, 1.0) /
                  depth_of_field_quarter(rings.circle * rings.rings_a_texel);
    int next = 2;
    for (int ring = 1; ring <= rings.count; ++ring)
        for (int i = 0; i < 4 * ring; ++i) {
            ivec4 texels = depth_of_field_texels(pixel, custom[next++], rings.spacing);
            vec4 one = load(depth_of_field_color, texels.xy), other = load(depth_of_field_color, texels.zw);
            vec2 radius = min(vec2(one.a, other.a), rings.circle) * rings.rings_a_texel;
            vec2 covers = clamp(radius - (float(ring) - 0.5), 0.0, 1.0);
            behind += vec4(one.rgb, 1.0) * (covers.x / depth_of_field_quarter(radius.x));
            behind += vec4(other.rgb, 1.0) * (covers.y / depth_of_field_quarter(radius.y));
        }
    return vec4(behind.rgb / behind.a, 1.0);
}

struct DepthOfFieldSums {
    vec4 behind, near;  // four times
};

// `place` is the sample's, `ring` its distance, both in rings; `barrel` is where the barrel's circle lies beside that of
// the aperture, in radii, and counts where `has_barrel`, a literal.
void depth_of_field_add(inout DepthOfFieldSums sums, vec4 color, float own, vec2 place, float ring, float rings_a_texel,
                        vec2 barrel, bool has_barrel, float fill) {
    // What lies farther away than the texel's own surface is seen beside it no farther than that is blurred.
    float radius = abs(min(color.a, max(own, 0.0))) * rings_a_texel;
    float away = has_barrel ? max(ring, length(place + barrel * radius)) : ring;
    float covers = ring == 0.0 ? 1.0 : clamp(radius - (away - 0.5), 0.0, 1.0);
    covers /= depth_of_field_quarter(radius);
    // Of what is not near, nothing.
    sums.near += vec4(color.rgb, 1.0) * (covers * depth_of_field_weight(-color.a, custom[1].xy));
    sums.behind += vec4(color.rgb, 1.0) * (color.a < 0.0 ? 0.0 : own > 0.0 ? covers : fill);
}

DepthOfFieldSums depth_of_field_both(Pixel pixel, DepthOfFieldRings rings, vec2 barrel, bool has_barrel) {
    DepthOfFieldSums sums = DepthOfFieldSums(vec4(0.0), vec4(0.0));
    depth_of_field_add(sums, load(depth_of_field_color, pixel.texel), rings.circle, vec2(0.0), 0.0, rings.rings_a_texel,
                       barrel, has_barrel, 1.0);
    int next = 2;
    for (int ring = 1; ring <= rings.count; ++ring) {
        // Behind a near thing what is close by counts most.
        float nearness = 1.0 - float(ring) / float(rings.count + 1), fill = nearness * nearness;
        for (int i = 0; i < 4 * ring; ++i) {
            vec4 places = custom[next++];
            ivec4 texels = depth_of_field_texels(pixel, places, rings.spacing);
            depth_of_field_add(sums, load(depth_of_field_color, texels.xy), rings.circle, places.xy, float(ring),
                               rings.rings_a_texel, barrel, has_barrel, fill);
            depth_of_field_add(sums, load(depth_of_field_color, texels.zw), rings.circle, places.zw, float(ring),
                               rings.rings_a_texel, barrel, has_barrel, fill);
        }
    }
    return sums;
}

void shade(Pixel pixel, out vec4 result[2]) {
    DepthOfFieldRings rings = depth_of_field_rings(pixel);
    bool is_blurred = abs(rings.circle) > custom[0].x;
    vec2 barrel = (pixel.uv - 0.5) * custom[0].zw;
    bool has_barrel = custom[0].zw != vec2(0.0);
    result[0] = result[1] = vec4(0.0);
    if (rings.radius <= custom[0].x) return;
    if (rings.near <= custom[0].x && !has_barrel) {
        result[0] = depth_of_field_far(pixel, rings);
        return;
    }
    DepthOfFieldSums sums;
    if (has_barrel)
        sums = depth_of_field_both(pixel, rings, barrel, true);
    else
        sums = depth_of_field_both(pixel, rings, barrel, false);
    // The part of a circle that the barrel leaves.
    float cut = length(barrel), left = (2.0 * acos(cut * 0.5) - cut * 0.5 * sqrt(4.0 - cut * cut)) / depth_of_field_pi;
    sums.near /= max(4.0 * left, sums.near.a);
    result[1] = sums.near;
    if (!is_blurred) return;
    // A near thing that hides all around is seen through itself; one that is hardly a blur is not seen at all.
    vec4 behind = sums.behind.a > 0.0 ? sums.behind : sums.near;
    result[0] = behind / max(behind.a, 1e-6);
}

#part fill
// Where rings lie farther apart than texels, what falls between them: the mean of the texels around.

void shade(Pixel pixel, out vec4 result[2]) {
    DepthOfFieldRings rings = depth_of_field_rings(pixel);
    float side = 0.5 * clamp(rings.spacing - 1.0, 0.0, 1.0);
    result[0] = load(depth_of_field_behind, pixel.texel);
    result[1] = load(depth_of_field_near, pixel.texel);
    if (side == 0.0) return;
    result[0] = result[1] = vec4(0.0);
    float whole = 1.0 / ((1.0 + 2.0 * side) * (1.0 + 2.0 * side));
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            float weight = whole * (x == 0 ? 1.0 : side) * (y == 0 ? 1.0 : side);
            result[0] += load_clamped(depth_of_field_behind, pixel.texel + ivec2(x, y)) * weight;
            result[1] += load_clamped(depth_of_field_near, pixel.texel + ivec2(x, y)) * weight;
        }
}

#part end
// scene_linear -> scene_linear. Lays what is blurred over the sharp picture, and the near field over both. A pixel that is
// sharp, and that nothing covers, keeps its bits.
#include "shared/sanitize.glsl"

// In pixels, negative before what is sharp: as in depth_of_field.glsl.
float depth_of_field_radius(ivec2 texel) {
    vec4 distances = depth_of_field_custom(0), radii = depth_of_field_custom(1);
    float depth = load_clamped(depth_of_field_depth, texel).r;
    float inverse = (depth * distances.z + distances.w) / (depth * distances.x + distances.y);
    inverse = depth != radii.w && inverse > 0.0 ? min(inverse, 1e4) : 0.0;
    return clamp(radii.x - radii.y * inverse, -radii.z, radii.z) * depth_of_field_custom(2).x;
}

// Colour and weight of a pixel that lies `away`: as far as its circle, in pixels, covers this one. What lies farther away
// counts with this pixel's own, as in the gathering; what is near lies over it later.
vec4 depth_of_field_tap(ivec2 texel, ivec2 away, float radius, float narrower, bool cleans) {
    vec4 distances = depth_of_field_custom(0), radii = depth_of_field_custom(1) * depth_of_field_custom(2).x;
    vec2 circle = radii.x * distances.xy - radii.y * distances.zw;
    vec4 color = load_clamped(depth_of_field_picture, texel + away);
    float depth = load_clamped(depth_of_field_depth, texel + away).r;
    float around = min((depth * circle.x + circle.y) / (depth * distances.x + distances.y), radius);
    float distance = sqrt(float(away.x * away.x) * (narrower * narrower) + float(away.y * away.y));
    return vec4(cleans ? sanitize(color).rgb : color.rgb, 1.0) * clamp(around - (distance - 0.5), 0.0, 1.0);
}

// A circle of a few pixels: the mean of 3 x 3 or 5 x 5, which have its variance.
vec3 depth_of_field_small(ivec2 texel, float radius, float narrower) {
    radius = radius < 1.5 ? 0.5 + (radius - 0.5) * (radius - 0.5) : radius;
    vec4 sum = vec4(0.0);
    [[unroll]] for (int i = 0; i < 9; ++i)
        sum += depth_of_field_tap(texel, ivec2(i % 3, i / 3) - 1, radius, narrower, false);
    [[dont_flatten]] if (radius > 1.5)
        [[unroll]] for (int i = 0; i < 25; ++i)
            if (i % 5 % 4 == 0 || i / 5 % 4 == 0)
                sum += depth_of_field_tap(texel, ivec2(i % 5, i / 5) - 2, radius, narrower, false);
    [[dont_flatten]] if (!is_finite(sum.rgb)) {
        sum = vec4(0.0);
        [[dont_unroll]] for (int i = 0; i < 25; ++i)
            sum += depth_of_field_tap(texel, ivec2(i % 5, i / 5) - 2, radius, narrower, true);
    }
    return sum.rgb / sum.a;
}

vec4 depth_of_field(vec4 color, Pixel pixel, DepthOfField parameters) {
    vec4 blur = depth_of_field_custom(2);
    vec2 place = (vec2(pixel.texel) + 0.5) / blur.x;
    vec4 near = sample_linear(depth_of_field_near, place / vec2(size(depth_of_field_near)));
    vec4 behind = sample_linear(depth_of_field_behind, place / vec2(size(depth_of_field_behind)));
    float radius = depth_of_field_radius(pixel.texel), left = depth_of_field_left(-radius / blur.x, blur.y, blur.x);
    float blurred = radius < 0.0 ? depth_of_field_weight(left, blur.zw) : depth_of_field_large(radius);
    if (behind.a == 0.0) blurred = 0.0;
    bool is_small = radius > 0.5 && blurred < 1.0;
    if (blurred == 0.0 && near.a == 0.0 && !is_small) return color;
    vec3 seen = is_small ? depth_of_field_small(pixel.texel, radius, parameters.anamorphic_ratio) : sanitize(color).rgb;
    seen = seen * (1.0 - blurred) + behind.rgb * (blurred / max(behind.a, 1e-6));
    return vec4(seen * (1.0 - near.a) + near.rgb, color.a);
}
