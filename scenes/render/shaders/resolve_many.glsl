// Several samples. Colour is weighted so that bright edges are smooth once tone-mapped (Karis, "Tone Mapping", 2013);
// everything else is that of the nearest sample, for an average of two surfaces is none.
void shade(Pixel pixel, out vec4 result[4]) {
    const vec3 luminance_weights = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    vec3 color = vec3(0);
    float total = 0.0, alpha = 0.0, nearest_depth = -1.0;
    int nearest = 0;
    for (int i = 0; i < samples; ++i) {
        vec4 drawn = min(texelFetch(drawn_color, pixel.texel, i), 65504.0);
        float weight = 1.0 / (1.0 + max(dot(drawn.rgb, luminance_weights), 0.0));
        color += drawn.rgb * weight;
        total += weight;
        alpha += drawn.a;
        float depth = texelFetch(drawn_depth, pixel.texel, i).r;
        if (depth > nearest_depth) {
            nearest_depth = depth;
            nearest = i;
        }
    }
    result[0] = vec4(color / total, alpha / float(samples));
    result[1] = texelFetch(drawn_normals, pixel.texel, nearest);
    result[2] = texelFetch(drawn_velocity, pixel.texel, nearest);
    result[3] = vec4(planar_distance(nearest_depth));
}
