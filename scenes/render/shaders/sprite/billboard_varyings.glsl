// Between billboard_vertex.glsl and the shaders of its fragments.
struct Varyings {
    vec4 tint;
    vec4 uv_frame;
    vec2 uv;
    vec2 disc;  // -1..1 across a disc; 0: none
    float covers;
    vec4 clip;
    vec4 previous_clip;
};
