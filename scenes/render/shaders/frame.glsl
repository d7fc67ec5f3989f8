// Set 0, that every pass of the scene has: render/frame_set.hpp.
const uint Output_hdr = 0u;
const uint Output_display = 1u;
const uint Debug_none = 0u;
const uint Debug_wireframe = 1u;
const uint Debug_normals = 2u;
const uint Debug_depth = 3u;
const uint Debug_uv = 4u;
const uint Debug_unlit = 5u;
const uint Debug_metal_rough = 6u;
const uint Material_unlit = 1u;
const uint Material_masked = 2u;
const uint Material_double_sided = 4u;
const uint Material_writes_alpha_only = 8u;
const uint no_index = 0xFFFFFFFFu;

layout(set = 0, binding = 0, std140) uniform FrameBlock {
#include "frame_block.glsl"
} frame;
layout(set = 0, binding = 1, std140) uniform LightBlock {
#include "light/light_block.glsl"
} lights;
layout(set = 0, binding = 2, std140) uniform ShadowBlock {
#include "light/shadow_block.glsl"
} shadows;
struct Instance {
#include "mesh/instance_block.glsl"
};
layout(set = 0, binding = 3, std430) readonly buffer Instances { Instance instances[]; };
struct Material {
#include "mesh/material_block.glsl"
};
layout(set = 0, binding = 4, std430) readonly buffer Materials { Material materials[]; };
// Two matrices a joint: now, a moment ago.
layout(set = 0, binding = 5, std430) readonly buffer Joints { mat4 joints[]; };
// Two numbers a weight: now, a moment ago.
layout(set = 0, binding = 6, std430) readonly buffer Weights { vec2 weights[]; };
// Two vectors a vertex of a target: position, normal.
layout(set = 0, binding = 7, std430) readonly buffer MorphDeltas { vec4 morph_deltas[]; };
layout(set = 0, binding = 8) uniform sampler2DArray shadow_maps[5];  // depth; the last is of tiles, of lamps
layout(set = 0, binding = 9) uniform sampler2D prefiltered_environment;  // equirectangular, a roughness a mip level
layout(set = 0, binding = 10) uniform sampler2D skybox;                  // equirectangular
layout(set = 0, binding = 11) uniform sampler2D split_sum;  // x: n.v, y: roughness; scale and bias of F0

/// Motion from a clip-space position to the previous one: previous minus current, pixels, y down.
vec2 motion(vec4 clip, vec4 previous_clip) {
    if (previous_clip.w <= 0.0) return vec2(0);
    return (previous_clip.xy / previous_clip.w - clip.xy / clip.w) * 0.5 * frame.target_size.xy;
}
