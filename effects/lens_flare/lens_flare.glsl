// SPDX-License-Identifier: MIT
#part aperture
// Ghosts are out of focus: each light as the aperture shows it, so that neither windows nor texels have edges in them.
// custom[i] = two places each, in parts of the picture, which count as much as the middle does.

vec4 shade(Pixel pixel) {
    const int vectors = 40;
    vec3 sum = sample_linear(lens_flare_bright, pixel.uv).rgb;
    for (int i = 0; i < vectors; ++i)
        sum += sample_linear(lens_flare_bright, pixel.uv + custom[i].xy).rgb +
               sample_linear(lens_flare_bright, pixel.uv + custom[i].zw).rgb;
    return vec4(sum / float(2 * vectors + 1), 1.0);
}

#part parts
// Ghosts and halo: John Chapman, "Pseudo Lens Flare", 2013, and "Screen Space Lens Flare", 2017. custom[0] = (width /
// height, ghosts, rays, how far red and blue are apart), custom[1] = (radius and strength of the halo, starburst),
// custom[2 + i] = (what the place is multiplied by for ghost i, its colour).

// The light at a place, in heights and widths of the picture from its middle; none outside, to which it fades.
float lens_flare_inside(vec2 place) {
    vec2 edge = clamp((0.5 - abs(place)) * 8.0, 0.0, 1.0);
    return edge.x * edge.y;
}

vec3 lens_flare_at(vec2 red, vec2 green, vec2 blue) {
    return vec3(sample_linear(lens_flare_light, red + 0.5).r * lens_flare_inside(red),
                sample_linear(lens_flare_light, green + 0.5).g * lens_flare_inside(green),
                sample_linear(lens_flare_light, blue + 0.5).b * lens_flare_inside(blue));
}

vec4 shade(Pixel pixel) {
    LensFlare parameters = lens_flare_parameters();
    vec2 place = pixel.uv - 0.5, aspect = vec2(custom[0].x, 1.0);
    float apart = custom[0].w;
    vec3 sum = vec3(0.0);
    int ghosts = int(custom[0].y);
    for (int i = 0; i < ghosts; ++i) {
        vec4 ghost = custom[2 + i];
        vec2 from = place * ghost.x;
        sum += ghost.yzw * lens_flare_at(from * (1.0 - apart), from, from * (1.0 + apart));
    }
    vec2 way = place * aspect;
    float far = length(way);
    way = far > 1e-5 ? way / far : vec2(1.0, 0.0);
    vec2 round = way * custom[1].x / aspect;
    sum += custom[1].y * lens_flare_at(round * (1.0 + apart) - place, round - place, round * (1.0 - apart) - place);

    // cos(x)^8 has a mean of 70/256, so the rays take as much from between them as they have.
    float wave = cos(0.5 * custom[0].z * atan(way.y, way.x));
    float ray = wave * wave;
    ray *= ray;
    float burst = mix(1.0, ray * ray * (256.0 / 70.0), custom[1].z);
    return vec4(min(sum * burst * parameters.tint, vec3(65504.0)), 1.0);
}

#part end
// scene_linear -> scene_linear.

vec4 lens_flare(vec4 color, Pixel pixel, LensFlare parameters) {
    return vec4(color.rgb + parameters.intensity * sample_linear(lens_flare_flare, pixel.uv).rgb, color.a);
}
