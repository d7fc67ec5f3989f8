// One sample: colour and layers are where they belong already.
vec4 shade(Pixel pixel) { return vec4(planar_distance(texelFetch(drawn_depth, pixel.texel, 0).r)); }
