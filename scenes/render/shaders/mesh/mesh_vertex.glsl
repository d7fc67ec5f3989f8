// Vertices of meshes, for the picture.
#include "mesh/mesh_place.glsl"
#include "mesh/mesh_varyings_out.glsl"

invariant gl_Position;

void main() {
    Instance instance = instances[gl_InstanceIndex];
    PlacedVertex placed = place_vertex(instance, uint(gl_VertexIndex));
    clip_position = frame.view_projection * placed.position;
    gl_Position = clip_position;
    previous_clip_position = frame.previous_view_projection * placed.previous_position;
    world_position = placed.position.xyz;
    world_normal = placed.normal;
    world_tangent = placed.tangent;
    uv = vec4(vertex_uv0, vertex_uv1);
    vertex_color = vertex_tint;
    material_index = instance.links.x;
}
