// What shaders of fragments get from mesh_vertex.glsl; mesh_varyings_out.glsl is the other end.
layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;   // not normalised
layout(location = 2) in vec4 world_tangent;  // w: handedness; xyz 0: none given
layout(location = 3) in vec4 uv;             // sets 0 and 1
layout(location = 4) in vec4 vertex_color;
layout(location = 5) in vec4 clip_position;
layout(location = 6) in vec4 previous_clip_position;
layout(location = 7) flat in uint material_index;
