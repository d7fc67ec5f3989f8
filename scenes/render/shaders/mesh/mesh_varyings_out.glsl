// What shaders/mesh/mesh_vertex.glsl gives to shaders of fragments; mesh_varyings_in.glsl is the other end.
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;   // not normalised
layout(location = 2) out vec4 world_tangent;  // w: handedness; xyz 0: none given
layout(location = 3) out vec4 uv;             // sets 0 and 1
layout(location = 4) out vec4 vertex_color;
layout(location = 5) out vec4 clip_position;
layout(location = 6) out vec4 previous_clip_position;
layout(location = 7) flat out uint material_index;
