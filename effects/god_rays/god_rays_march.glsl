// SPDX-License-Identifier: MIT
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
