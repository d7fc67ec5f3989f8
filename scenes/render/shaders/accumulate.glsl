// Body of the accumulating kernels (render/pass/accumulate.cpp), which add a shade() that calls one of these. Light is
// averaged as c / (1 + max c), so that the edge of a bright surface is as smooth as its picture will be, and turned back
// at the end: Brian Karis, "High Quality Temporal Supersampling", 2014. Alpha is a plain mean.
// custom[0].x: 1 / the number of positions; y: 1, or 0 for the plain mean of light.

const float brightest = 65504.0;  // of half floats

float greatest(vec3 light) { return max(max(light.r, light.g), light.b); }

/// What one position adds to the mean.
vec4 weighed(vec4 drawn) {
    // A comparison with NaN is false.
    vec3 light = mix(vec3(0.0), min(drawn.rgb, brightest), greaterThan(drawn.rgb, vec3(0.0)));
    return vec4(light / (1.0 + greatest(light) * custom[0].y), drawn.a) * custom[0].x;
}

/// Light of the mean, which is below 1 in all channels where it is weighed.
vec4 unweighed(vec4 mean) {
    float rest = max(1.0 - greatest(mean.rgb) * custom[0].y, 1.0 / (1.0 + brightest));
    return vec4(mean.rgb / rest, mean.a);
}
