// SPDX-License-Identifier: MIT
// What reaches a texel: see the page. result[0]: what is seen behind the near field, where that is no sharp pixel;
// result[1]: the near field. Both premultiplied. custom[0] = (smallest radius that is a blur, 0, shift of the barrel's circle
// from edge to edge of the picture in radii), custom[1] = (what depth_of_field_weight() takes, 0, 0), custom[2] ...: two
// samples each, rings of radius 1, 2, 3 ... about the centre.
#include "depth_of_field_blur.glsl"
#include "depth_of_field_rings.glsl"

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
