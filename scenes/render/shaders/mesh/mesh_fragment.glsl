// Meshes of every kind: lit, unlit, masked, transparent, and the debug views. What a pipeline never needs is switched
// off by its constants, so that it costs nothing.
layout(constant_id = 0) const bool has_textures = true;
layout(constant_id = 1) const bool has_shadows = true;
layout(constant_id = 2) const bool has_environment = true;
layout(constant_id = 3) const bool is_masked = false;
layout(constant_id = 4) const uint output_mode = 0u;
layout(constant_id = 5) const bool is_debug_view = false;  // which one says the frame: all have the same pipelines
layout(constant_id = 6) const bool is_tone_mapped = true;
layout(constant_id = 7) const bool is_transparent = false;  // alpha is the material's, for blending or as all there is
const bool has_mip_bias = true;

#include "frame.glsl"
#include "mesh/mesh_varyings_in.glsl"
#include "light/microfacets.glsl"
#include "light/layers.glsl"
#include "light/brdf.glsl"
#include "light/environment.glsl"
#include "light/shadow.glsl"
#include "light/lights.glsl"
#include "mesh/surface.glsl"
#include "mesh/layers.glsl"
#include "output.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec2 out_velocity;

// Along the camera's axis, metres.
float view_distance() { return dot(world_position - frame.camera_position.xyz, frame.camera_forward.xyz); }

vec3 toward_camera() {
    if (frame.camera_position.w == 0.0) return -frame.camera_forward.xyz;
    return normalize(frame.camera_position.xyz - world_position);
}

// All of the light from everywhere that meets a coat, what bounces between its microfacets too.
vec3 mirrored_by_coat(Clearcoat coat, vec3 v) {
    if (!has_environment) return hemisphere(coat.normal, frame.ambient_sky.rgb, frame.ambient_ground.rgb);
    vec2 scale_and_bias = environment_brdf(clamp(dot(coat.normal, v), 0.0, 1.0), coat.roughness);
    return mix(environment_irradiance(coat.normal),
               environment_reflection(reflect(-v, coat.normal), coat.roughness), scale_and_bias.x + scale_and_bias.y);
}

// Light from everywhere. The hemisphere has no mirror images, so base colour stands for all that leaves, of metals too.
vec3 surroundings(Surface surface, Reflectance material, vec3 v) {
    vec3 leaves = vec3(0.0);
    if (has_environment) {
        float n_dot_v = clamp(dot(surface.normal, v), 0.0, 1.0);
        leaves = reflected_surroundings(material, environment_irradiance(surface.normal),
                                        environment_reflection(reflect(-v, surface.normal), material.roughness),
                                        environment_brdf(n_dot_v, material.roughness));
    } else {
        leaves = hemisphere(surface.normal, frame.ambient_sky.rgb, frame.ambient_ground.rgb) * surface.base_color;
    }
    if (has_sheen) {
        vec3 arrives = has_environment ? environment_irradiance(surface.normal)
                                       : hemisphere(surface.normal, frame.ambient_sky.rgb, frame.ambient_ground.rgb);
        leaves = leaves * kept_by_sheen(material.sheen, material.sheen.albedo) +
                 material.sheen.color * material.sheen.albedo * arrives;
    }
    if (has_clearcoat) leaves = mix(leaves, mirrored_by_coat(material.coat, v), material.coat.part);
    return leaves;
}

vec3 leaving_light(Surface surface) {
    if (has_flag(Material_unlit)) return surface.base_color;
    vec3 v = toward_camera();
    Reflectance material = material_at_fragment(surface, v);
    vec3 emissive = surface.emissive;
    if (has_clearcoat) emissive *= 1.0 - material.coat.part;
    return reflected_lights(material, world_position, surface.normal, surface.geometry_normal, v, view_distance(),
                            has_shadows) +
           surroundings(surface, material, v) * surface.occlusion + emissive;
}

// Display values. Depth is logarithmic, so that it shows something at every scale: white at the near distance, black at
// the far one.
vec3 debug_color(Surface surface, uint debug_view) {
    if (debug_view == Debug_normals) return surface.normal * 0.5 + 0.5;
    if (debug_view == Debug_depth) {
        float near_distance = max(frame.planes.x, 1e-3);
        float far_distance = max(frame.planes.y, 2.0 * near_distance);
        float distance = clamp(view_distance(), near_distance, far_distance);
        return vec3(log(far_distance / distance) / log(far_distance / near_distance));
    }
    if (debug_view == Debug_uv) return vec3(fract(uv.xy), 0.0);
    if (debug_view == Debug_unlit) return srgb_encode(clamp(surface.base_color, 0.0, 1.0));
    if (debug_view == Debug_metal_rough) return vec3(surface.metallic, surface.roughness, 0.0);
    return vec3(1.0);
}

void main() {
    Surface surface = surface_at_fragment();
    if (is_masked && surface.alpha < materials[material_index].emissive.w) discard;
    float alpha = is_transparent ? surface.alpha : 1.0;
    if (is_debug_view) {
        out_color = vec4(debug_color(surface, frame.modes.z), alpha);
    } else {
        out_color = finish(leaving_light(surface), alpha, output_mode, is_tone_mapped);
    }
    out_normal = vec4(surface.normal, 1.0);
    out_velocity = motion(clip_position, previous_clip_position);
}
