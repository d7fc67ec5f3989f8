// Vertices of meshes for shadow maps: where they are, and what shaders/mesh/masked_depth_fragment.glsl needs of them.
#include "mesh/mesh_place.glsl"

layout(location = 3) out vec4 uv;
layout(location = 4) out vec4 vertex_color;
layout(location = 7) flat out uint material_index;

layout(push_constant) uniform Push { uint map; };  // number in ShadowBlock

void main() {
    Instance instance = instances[gl_InstanceIndex];
    gl_Position = shadows.world_to_map[map] * place_vertex(instance, uint(gl_VertexIndex)).position;
    uv = vec4(vertex_uv0, vertex_uv1);
    vertex_color = vertex_tint;
    material_index = instance.links.x;
}
