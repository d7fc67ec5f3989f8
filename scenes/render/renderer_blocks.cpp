// SPDX-License-Identifier: MIT
#include "render/renderer_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace darkroom::render {

namespace {

using scene::LightType;
using scene::mat4;
using scene::uvec4;
using scene::vec3;
using scene::vec4;

/// The hemisphere where a scene says nothing.
constexpr vec3 default_sky(0.12F, 0.13F, 0.18F), default_ground(0.06F, 0.05F, 0.04F);

/// Bits of Material.flags.x, as shaders/frame.glsl numbers them.
/// KHR_materials_ior: Fresnel's equation head-on, from air; an index of 0 stands for an endless one.
float dielectric_f0(float index_of_refraction) {
    const float root = (index_of_refraction - 1) / (index_of_refraction + 1);
    return root * root;
}

constexpr std::uint32_t unlit_bit = 1, masked_bit = 2, double_sided_bit = 4, alpha_only_bit = 8;

std::vector<const scene::LightState*> lights_of(const scene::Snapshot& snapshot, LightType type, std::size_t most) {
    std::vector<const scene::LightState*> out;
    for (const scene::LightState& state : snapshot.lights)
        if (state.light.type == type && out.size() < most) out.push_back(&state);
    return out;
}

vec4 radiance(const scene::Light& light, float last) { return {light.color * light.intensity, last}; }

std::array<float, 3> array_of(vec3 v) { return {v.x, v.y, v.z}; }

}  // namespace

Matrix matrix_of(const mat4& matrix) {
    Matrix out{};
    std::copy_n(glm::value_ptr(matrix), out.size(), out.begin());
    return out;
}

std::vector<const scene::LightState*> directional_lights(const scene::Snapshot& snapshot) {
    return lights_of(snapshot, LightType::Directional, max_directional_lights);
}

bool is_caster(const scene::LightState* state) { return state->light.casts_shadow && state->light.intensity > 0; }

blocks::Frame frame_block(const scene::Snapshot& snapshot, const FrameSettings& settings) {
    const scene::CameraState& camera = snapshot.camera;
    const auto width = static_cast<float>(settings.extent.width), height = static_cast<float>(settings.extent.height);
    const scene::Environment& environment = settings.environment;
    blocks::Frame block;
    // Both alike, so that no jitter is left in motion.
    const mat4 jitter = jitter_matrix(settings.jitter, settings.extent);
    block.view = camera.view;
    block.projection = jitter * camera.projection;
    block.view_projection = block.projection * camera.view;
    block.previous_view_projection = jitter * camera.previous_projection * camera.previous_view;
    block.inverse_view_projection = glm::inverse(block.view_projection);
    block.camera_position = vec4(camera.position, camera.kind == scene::Projection::Perspective ? 1 : 0);
    block.camera_forward =
        vec4(-camera.view[0].z, -camera.view[1].z, -camera.view[2].z, std::exp2(settings.mip_bias) - 1);
    block.target_size = vec4(width, height, 1 / width, 1 / height);
    // The view of depth, which alone reads the far distance, is drawn to somewhere.
    const float far_distance = std::isinf(camera.far_distance) ? camera.near_distance * 1e4F : camera.far_distance;
    block.planes = vec4(camera.near_distance, far_distance, static_cast<float>(snapshot.time), settings.exposure);
    block.light_counts =
        uvec4(directional_lights(snapshot).size(), lights_of(snapshot, LightType::Point, max_point_lights).size(),
              lights_of(snapshot, LightType::Spot, max_spot_lights).size(), 0);
    block.modes = uvec4(static_cast<std::uint32_t>(settings.output), settings.is_tone_mapped ? 1 : 0,
                        static_cast<std::uint32_t>(settings.debug), 0);
    block.ambient_sky = vec4(environment.ambient_color.value_or(default_sky) * environment.ambient_intensity, 0);
    block.ambient_ground = vec4(environment.ambient_color.value_or(default_ground) * environment.ambient_intensity, 0);
    block.background = vec4(environment.background, 1);
    block.environment_settings =
        vec4(environment.skybox_intensity, static_cast<float>(std::max(settings.environment_levels, 1U) - 1), 0, 0);
    for (std::size_t i = 0; i < settings.irradiance.size(); ++i) block.irradiance[i] = vec4(settings.irradiance[i], 0);
    return block;
}

mat4 jitter_matrix(const std::array<float, 2>& jitter, VkExtent2D extent) {
    mat4 out(1);
    out[3] =
        vec4(2 * jitter[0] / static_cast<float>(extent.width), 2 * jitter[1] / static_cast<float>(extent.height), 0, 1);
    return out;
}

blocks::Frame moved_block(const blocks::Frame& frame, scene::vec2 pixels) {
    blocks::Frame moved = frame;
    const scene::vec2 clip = 2.0F * pixels * scene::vec2(frame.target_size.z, frame.target_size.w);
    // Both alike, so that none of it is left in motion.
    for (mat4* const matrix : {&moved.projection, &moved.previous_view_projection})
        for (int column = 0; column < 4; ++column) (*matrix)[column] -= (*matrix)[column].w * vec4(clip, 0, 0);
    moved.view_projection = moved.projection * frame.view;
    moved.inverse_view_projection = glm::inverse(moved.view_projection);
    return moved;
}

blocks::Frame seen_from(const blocks::Frame& frame, scene::vec2 place, float focus_distance) {
    blocks::Frame moved = frame;
    const scene::mat3 to_world = glm::transpose(scene::mat3(frame.view));
    moved.camera_position += vec4(to_world * vec3(place, 0), 0);
    moved.view[3] -= vec4(place, 0, 0);
    // A shear: points at the focus distance, where z is its negative, come back to where they were.
    moved.projection[2] -= (frame.projection[0] * place.x + frame.projection[1] * place.y) / focus_distance;
    moved.view_projection = moved.projection * moved.view;
    moved.inverse_view_projection = glm::inverse(moved.view_projection);
    return moved;
}

blocks::Lights light_block(const scene::Snapshot& snapshot, std::uint32_t shadow_maps,
                           std::span<const LampTiles> lamps) {
    const auto tiles_of_light = [&](const scene::LightState* state) -> vec4 {
        const auto found =
            std::ranges::find(lamps, static_cast<std::uint32_t>(state - snapshot.lights.data()), &LampTiles::light);
        if (found == lamps.end()) return {-1, 0, 0, 0};
        return {static_cast<float>(found->first), static_cast<float>(found->count), 0, 0};
    };
    blocks::Lights block;
    std::size_t i = 0;
    std::uint32_t map = 0;
    for (const scene::LightState* state : directional_lights(snapshot)) {
        const bool has_map = is_caster(state) && map < shadow_maps;
        block.directional_direction[i] = vec4(state->direction, has_map ? static_cast<float>(map++) : -1.0F);
        block.directional_color[i++] = radiance(state->light, 0);
    }
    i = 0;
    for (const scene::LightState* state : lights_of(snapshot, LightType::Point, max_point_lights)) {
        block.point_position[i] = vec4(state->position, state->light.range);
        block.point_color[i++] = radiance(state->light, tiles_of_light(state).x);
    }
    i = 0;
    for (const scene::LightState* state : lights_of(snapshot, LightType::Spot, max_spot_lights)) {
        block.spot_position[i] = vec4(state->position, state->light.range);
        block.spot_direction[i] = vec4(state->direction, std::cos(state->light.outer_angle));
        block.spot_tiles[i] = tiles_of_light(state);
        block.spot_color[i++] = radiance(state->light, std::cos(state->light.inner_angle));
    }
    return block;
}

blocks::Material material_block(const scene::SnapshotMaterial& material) {
    const scene::ModelMaterial& surface = material.surface;
    const auto textures = scene::textures_of(surface);
    blocks::Material block;
    block.base_color = surface.base_color * vec4(1, 1, 1, material.opacity);
    block.emissive = vec4(surface.emissive, surface.alpha_cutoff);
    block.factors = vec4(surface.metallic, surface.roughness, surface.normal_scale, surface.occlusion_strength);
    block.specular =
        vec4(surface.specular.color * dielectric_f0(surface.specular.index_of_refraction), surface.specular.weight);
    block.clearcoat = vec4(surface.clearcoat.weight, surface.clearcoat.roughness, surface.clearcoat.normal_scale, 0);
    block.sheen = vec4(surface.sheen.color, surface.sheen.roughness);
    block.flags.x = (surface.is_unlit ? unlit_bit : 0) | (surface.blend == scene::SurfaceBlend::Mask ? masked_bit : 0) |
                    (surface.is_double_sided ? double_sided_bit : 0) |
                    (material.writes == scene::Writes::Alpha ? alpha_only_bit : 0);
    for (std::uint32_t i = 0; i < textures.size(); ++i) {
        const scene::Texture& texture = *textures[i].texture;
        if (texture.is_given() || (i == 0 && material.entity_texture != scene::no_index)) block.flags.y |= 1U << i;
        if (texture.uv_set == 1) block.flags.z |= 1U << i;
        const scene::mat3 rows = glm::transpose(texture.uv_transform);
        block.uv_rows[2 * i] = vec4(rows[0], 0);
        block.uv_rows[2 * i + 1] = vec4(rows[1], 0);
    }
    return block;
}

blocks::Instance instance_block(const scene::Instance& instance, const GpuMesh& mesh) {
    blocks::Instance block;
    block.world = instance.world;
    block.previous_world = instance.previous_world;
    const bool has_weights = instance.first_weight != scene::no_index;
    block.links = uvec4(instance.material, instance.first_joint, has_weights ? instance.first_weight : 0,
                        has_weights ? std::min(instance.weight_count, mesh.morph_targets) : 0);
    block.morph = uvec4(mesh.first_morph_delta, mesh.vertex_count, instance.is_mirrored ? 1 : 0, 0);
    return block;
}

Camera frame_camera(const scene::CameraState& camera, VkExtent2D extent, const FrameJitter& jitter) {
    return {.view = matrix_of(camera.view),
            .projection = jittered(matrix_of(camera.projection), jitter.now, extent),
            .previous_view = matrix_of(camera.previous_view),
            .previous_projection = jittered(matrix_of(camera.previous_projection), jitter.before, extent),
            .near_distance = camera.near_distance,
            .far_distance = camera.far_distance,
            .depth = DepthKind::Planar,
            .is_y_down = true,
            .jitter = jitter.now,
            .previous_jitter = jitter.before};
}

Light frame_light(const scene::LightState& state) {
    const scene::Light& light = state.light;
    return {.direction = array_of(state.direction),
            .color = array_of(light.color * light.intensity),
            .volumetric_intensity = light.volumetric_intensity,
            .volumetric_color = array_of(light.volumetric_color.value_or(light.color)),
            .cascades = {}};
}

}  // namespace darkroom::render
