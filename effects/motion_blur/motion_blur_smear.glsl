// SPDX-License-Identifier: MIT
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
