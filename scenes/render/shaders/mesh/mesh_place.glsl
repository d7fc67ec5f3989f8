// Where a vertex of a mesh is, now and a moment ago: morphed, then skinned, then placed by its instance. Every shader
// of mesh vertices goes through place_vertex(), so that all passes agree to the last bit.
#include "frame.glsl"

layout(constant_id = 10) const bool is_skinned = false;
layout(constant_id = 11) const bool is_morphed = false;

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 vertex_tangent;
layout(location = 3) in vec2 vertex_uv0;
layout(location = 4) in vec2 vertex_uv1;
layout(location = 5) in vec4 vertex_tint;
layout(location = 6) in uvec4 vertex_joints;
layout(location = 7) in vec4 vertex_joint_weights;

struct PlacedVertex {
    vec4 position;  // world space
    vec4 previous_position;
    vec3 normal;   // world space, not normalised
    vec4 tangent;  // w: handedness
};

mat4 skin_matrix(uint first_joint, uint moment) {
    mat4 sum = joints[2u * (first_joint + vertex_joints.x) + moment] * vertex_joint_weights.x;
    sum += joints[2u * (first_joint + vertex_joints.y) + moment] * vertex_joint_weights.y;
    sum += joints[2u * (first_joint + vertex_joints.z) + moment] * vertex_joint_weights.z;
    sum += joints[2u * (first_joint + vertex_joints.w) + moment] * vertex_joint_weights.w;
    return sum;
}

/// Cofactors turn normals as the inverse transpose does, for singular matrices too (Lengyel, "Foundations of Game
/// Engine Development 1", 2016, section 3.2.2); the sign keeps them outside in mirrored instances.
mat3 normal_matrix(mat3 m) {
    mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return dot(m[0], cofactors[0]) < 0.0 ? -cofactors : cofactors;
}

/// `vertex`: number within the mesh's own vertices.
PlacedVertex place_vertex(Instance instance, uint vertex) {
    vec3 position = vertex_position;
    vec3 previous_position = vertex_position;
    vec3 normal = vertex_normal;
    if (is_morphed) {
        for (uint target = 0u; target < instance.links.w; ++target) {
            vec2 weight = weights[instance.links.z + target];
            uint delta = instance.morph.x + 2u * (target * instance.morph.y + vertex);
            position += weight.x * morph_deltas[delta].xyz;
            previous_position += weight.y * morph_deltas[delta].xyz;
            normal += weight.x * morph_deltas[delta + 1u].xyz;
        }
    }
    mat4 world = instance.world;
    mat4 previous_world = instance.previous_world;
    if (is_skinned) {
        world = skin_matrix(instance.links.y, 0u);
        previous_world = skin_matrix(instance.links.y, 1u);
    }
    PlacedVertex placed;
    placed.position = world * vec4(position, 1);
    placed.previous_position = previous_world * vec4(previous_position, 1);
    placed.normal = normal_matrix(mat3(world)) * normal;
    float side = determinant(mat3(world)) < 0.0 ? -1.0 : 1.0;
    placed.tangent = vec4(mat3(world) * vertex_tangent.xyz, vertex_tangent.w * side);
    return placed;
}
