// SPDX-License-Identifier: MIT
// Level i+1 onto level i, added: the 3x3 tent (1 2 1 / 2 4 2 / 1 2 1) / 16 of bilinear taps one source texel apart.
// custom[0] = (size of level i+1, 1 / size), custom[1].x = gain.
//
// Along one axis, three bilinear taps at fraction f between the texels a b c d weigh them by
//     (1-f)(1,2,1,0)/4 + f(0,1,2,1)/4 = (1-f, 2-f, 1+f, f)/4,
// and two bilinear taps do the same: between a and b at (2-f)/(3-2f) with weight (3-2f)/4, between c and d at f/(1+2f)
// with weight (1+2f)/4. So four taps give exactly what nine would.

vec3 bloom_by_taps(vec2 b, vec2 f) {
    vec2 near = (b - 0.5 + (2.0 - f) / (3.0 - 2.0 * f)) * custom[0].zw;
    vec2 far = (b + 1.5 + f / (1.0 + 2.0 * f)) * custom[0].zw;
    vec2 far_weight = 0.25 + 0.5 * f;
    vec2 near_weight = 1.0 - far_weight;
    vec3 top = sample_linear(bloom_below, near).rgb * near_weight.x +
               sample_linear(bloom_below, vec2(far.x, near.y)).rgb * far_weight.x;
    vec3 bottom = sample_linear(bloom_below, vec2(near.x, far.y)).rgb * near_weight.x +
                  sample_linear(bloom_below, far).rgb * far_weight.x;
    return top * near_weight.y + bottom * far_weight.y;
}

vec4 shade(Pixel pixel) {
    vec2 position = pixel.uv * custom[0].xy - 0.5;
    vec2 b = floor(position);
    return vec4(bloom_by_taps(b, position - b) * custom[1].x, 0.0);
}
