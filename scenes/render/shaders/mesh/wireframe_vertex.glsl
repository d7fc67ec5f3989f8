// Edges of meshes: in the material's colour for rooms, which are nothing but edges, and for the view of all edges;
// white over the picture.
#include "mesh/mesh_place.glsl"
#include "srgb.glsl"

layout(constant_id = 0) const bool is_overlay = false;
layout(constant_id = 1) const bool encodes = false;
layout(constant_id = 2) const bool is_view = false;  // of all edges, on black: what is dark is lifted until it is seen

layout(location = 0) flat out vec4 line_color;

invariant gl_Position;

void main() {
    Instance instance = instances[gl_InstanceIndex];
    gl_Position = frame.view_projection * place_vertex(instance, uint(gl_VertexIndex)).position;
    line_color = is_overlay ? vec4(1, 1, 1, 0.6) : materials[instance.links.x].base_color;
    float luminance = clamp(dot(line_color.rgb, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0);
    const float least = 0.35;
    if (is_view && luminance < least)
        line_color.rgb = mix(line_color.rgb, vec3(1.0), (least - luminance) / (1.0 - luminance));
    if (encodes) line_color.rgb = srgb_encode(clamp(line_color.rgb, 0.0, 1.0));
}
