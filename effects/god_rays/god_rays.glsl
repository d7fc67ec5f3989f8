// SPDX-License-Identifier: MIT
#part mask
// The light that streams, at a quarter of the size: sky above the threshold, weaker with its distance from the light.
// custom[0] = (place of the light, width / height, radius), custom[1] = (threshold, ceiling).
#include "shared/sanitize.glsl"

vec4 shade(Pixel pixel) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 texel = pixel.texel * 4 + ivec2(i & 3, i >> 2);
        vec3 color = sanitize_light(load_clamped(god_rays_source, texel).rgb);
        // ITU-R BT.709.
        float luminance = dot(color, vec3(0.2126, 0.7152, 0.0722));
        float kept = clamp(luminance - custom[1].x, 0.0, custom[1].y);
        bool is_sky = !(load_clamped(god_rays_distance, texel).r < 1e9);
        sum += is_sky ? color * (kept / max(luminance, 1e-6)) : vec3(0.0);
    }
    float near = clamp(1.0 - length((pixel.uv - custom[0].xy) * vec2(custom[0].z, 1.0)) / custom[0].w, 0.0, 1.0);
    // Nothing is known of what lies outside the picture, so the edge, which is repeated there, is black.
    ivec2 inside = min(pixel.texel, pixel.size - 1 - pixel.texel);
    float edge = min(0.5 * float(min(inside.x, inside.y)), 1.0);
    return vec4(sum * (near * near * edge / 16.0), 0.0);
}

#part march
// Gathers on the way to the light. Kenny Mitchell, "Volumetric Light Scattering as a Post-Process", GPU Gems 3, 2007.
// custom[0] = (place of the light, density / samples, samples), custom[1] = (what a sum is multiplied by, what a step
// leaves).

vec4 shade(Pixel pixel) {
    vec2 step_uv = (custom[0].xy - pixel.uv) * custom[0].z;
    vec3 sum = vec3(0.0);
    float weight = 1.0;
    int samples = int(custom[0].w);
    [[dont_unroll]] for (int i = 0; i < samples; ++i) {
        sum += sample_linear(god_rays_mask, pixel.uv + step_uv * float(i)).rgb * weight;
        weight *= custom[1].w;
    }
    return vec4(min(sum * custom[1].rgb, vec3(65504.0)), 0.0);
}

#part end
// scene_linear -> scene_linear.

vec4 god_rays(vec4 color, Pixel pixel, GodRays parameters) {
    return vec4(color.rgb + sample_linear(god_rays_streaks, pixel.uv).rgb, color.a);
}
