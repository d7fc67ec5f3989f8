// From the light that reaches the camera to what is written. Needs frame.glsl before it.
#include "srgb.glsl"

// The largest finite half float.
const float brightest = 65504.0;

// A comparison with NaN is false; what min and max make of it is not defined.
vec3 finite_light(vec3 light) {
    return mix(vec3(0.0), min(light, vec3(brightest)), greaterThan(light, vec3(0.0)));
}

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016; the same as the effect's, so that a picture without
// effects looks like one with all of them neutral.
vec3 tone_map(vec3 light) {
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
}

// What is stored for light: linear HDR, or the finished picture.
vec4 finish(vec3 scene_linear, float alpha, uint output_mode, bool is_tone_mapped) {
    vec3 light = finite_light(scene_linear);
    float opacity = alpha > 0.0 ? min(alpha, 1.0) : 0.0;
    if (output_mode == Output_hdr) return vec4(light, opacity);
    light = finite_light(light * frame.planes.w);
    vec3 display = mix(light, tone_map(light), bvec3(is_tone_mapped));
    return vec4(srgb_encode(clamp(display, 0.0, 1.0)), opacity);
}

// By the frame's own modes, for passes without constants of their own.
vec4 finish(vec3 scene_linear, float alpha) {
    return finish(scene_linear, alpha, frame.modes.x, frame.modes.y != 0u);
}
