// SPDX-License-Identifier: MIT
// Light that the haze before the surface scatters toward the camera, of one light; alpha, of the first light: planar
// distance. Everything that is linear in the texel and in the planar distance comes ready from the CPU: on the software
// driver a number read from a uniform buffer costs as much as thirty operations. custom[0] = (samples, max distance, what a
// step leaves, density times intensity), custom[1] = (x per texel, x at texel 0, y per texel, y at texel 0) of the ray where
// its planar distance is 1, custom[2] = (cosine to the light times the ray's length: at texel 0, per texel x, y; is first),
// custom[3] = (color, is perspective), and of cascade c custom[4 + 4c] = (its u, v and depth at distance 0; far distance),
// custom[5 + 4c] = (the same per distance at texel 0; of the first cascade: how many there are), custom[6 + 4c] and
// custom[7 + 4c]: per texel x and y, and distance where the camera is perspective.

// Henyey and Greenstein, "Diffuse radiation in the galaxy", 1941, g = 0.8: forward scattering.
float volumetric_phase(float cosine) {
    const float g = 0.8;
    float x = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * 3.14159265 * x * sqrt(x));
}

vec4 shade(Pixel pixel) {
    float planar = load(volumetric_distance, pixel.texel).r;
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
    float sum = 0.0, transmittance = 1.0, i = 0.0;
    float count = custom[5].w, perspective = custom[3].w;
    [[dont_unroll]] for (float cascade = 0.0; cascade < count && i < samples; ++cascade) {
        int first = 4 + 4 * int(cascade);
        vec4 start = custom[first];
        vec3 turn = custom[first + 2].xyz * texel.x + custom[first + 3].xyz * texel.y;
        vec3 slope = (custom[first + 1].xyz + turn * perspective) * step_length;
        vec3 place = start.xyz + turn * (1.0 - perspective) + slope * (jitter + i);
        float end = start.w / max(step_length, 1e-20) - jitter;
        [[dont_unroll]] for (; i < min(end, samples); ++i) {
            sum += texture(volumetric_shadow, vec4(place.xy, cascade, min(place.z, 1.0))) * transmittance;
            transmittance *= march.z;
            place += slope;
        }
    }
    [[dont_unroll]] for (; i < samples; ++i) {
        sum += transmittance;
        transmittance *= march.z;
    }
    float cosine = (custom[2].x + custom[2].y * texel.x + custom[2].z * texel.y) / true_of_planar;
    float scattered = sum * step_length * true_of_planar * march.w * volumetric_phase(cosine);
    // Four lights must not add up to more than half precision holds.
    return vec4(min(custom[3].rgb * scattered, vec3(16000.0)), custom[2].w * planar);
}
