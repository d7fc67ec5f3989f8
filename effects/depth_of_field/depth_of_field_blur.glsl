// SPDX-License-Identifier: MIT
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
