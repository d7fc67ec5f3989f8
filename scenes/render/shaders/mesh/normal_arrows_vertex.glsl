// A line of two vertices along the normal of every vertex of a mesh: here mesh vertices are instances, and the instance
// is pushed.
#include "mesh/mesh_place.glsl"

layout(push_constant) uniform Push { uint instance_index; };
layout(location = 0) flat out vec4 line_color;

const float half_heights = 0.05;  // length, in halves of the picture's height

void main() {
    PlacedVertex placed = place_vertex(instances[instance_index], uint(gl_InstanceIndex));
    vec4 clip = frame.view_projection * placed.position;
    float length_m = half_heights * clip.w / abs(frame.projection[1][1]);
    vec3 normal = normalize(placed.normal + vec3(0, 1e-30, 0));
    vec4 tip = placed.position + vec4(normal * length_m * float(gl_VertexIndex), 0);
    gl_Position = frame.view_projection * tip;
    line_color = vec4(normal * 0.5 + 0.5, 1);
}
