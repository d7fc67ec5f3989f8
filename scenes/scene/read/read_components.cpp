// SPDX-License-Identifier: MIT
#include "scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/text/param_text.hpp"

namespace darkroom::scene::reading {

namespace {

constexpr std::array blend_names{
    std::pair{std::string_view("opaque"), SurfaceBlend::Opaque},
    std::pair{std::string_view("mask"), SurfaceBlend::Mask},
    std::pair{std::string_view("alpha"), SurfaceBlend::Alpha},
    std::pair{std::string_view("additive"), SurfaceBlend::Additive},
    std::pair{std::string_view("multiply"), SurfaceBlend::Multiply},
};
constexpr std::array particle_blend_names{std::pair{std::string_view("alpha"), SurfaceBlend::Alpha},
                                          std::pair{std::string_view("additive"), SurfaceBlend::Additive}};
constexpr std::array write_names{std::pair{std::string_view("all"), Writes::All},
                                 std::pair{std::string_view("alpha"), Writes::Alpha}};
constexpr std::array light_names{std::pair{std::string_view("directional"), LightType::Directional},
                                 std::pair{std::string_view("point"), LightType::Point},
                                 std::pair{std::string_view("spot"), LightType::Spot}};
constexpr std::array shape_names{std::pair{std::string_view("point"), EmitterShape::Point},
                                 std::pair{std::string_view("sphere"), EmitterShape::Sphere},
                                 std::pair{std::string_view("cone"), EmitterShape::Cone},
                                 std::pair{std::string_view("box"), EmitterShape::Box}};

constexpr Interval scales{.low = -1e6, .high = 1e6};
constexpr Interval half_angle_degrees{.low = 0, .high = 180, .unit = "degrees"};
constexpr Interval cone_radians{.low = 0, .high = std::numbers::pi / 2, .unit = "radians"};
constexpr std::uint32_t max_frames = 4096;

// Intrinsic rotations about z, then y, then x: a point is turned about x first.
quat rotation_of(vec3 degrees) {
    const vec3 angles = glm::radians(degrees);
    return glm::angleAxis(angles.z, vec3(0, 0, 1)) * glm::angleAxis(angles.y, vec3(0, 1, 0)) *
           glm::angleAxis(angles.x, vec3(1, 0, 0));
}

void read_placement(TableReader& table, Transform& out) {
    table.vector("position", out.position);
    vec3 degrees(0);
    const bool has_angles = table.vector("rotation", degrees);
    const bool has_quaternion = table.rotation_quaternion("rotation_quat", out.rotation);
    if (has_angles && !has_quaternion) out.rotation = rotation_of(degrees);
    table.vector("scale", out.scale, scales);
}

// Paths go forward in time: keys that do not are put in order.
template <class Key>
void order_keys(TableReader& table, std::vector<Key>& keys) {
    const auto is_earlier = [](const Key& a, const Key& b) { return a.time < b.time; };
    if (std::is_sorted(keys.begin(), keys.end(), is_earlier)) return;
    table.slip("path", "times go back, the keys are put in order");
    std::stable_sort(keys.begin(), keys.end(), is_earlier);
}

template <class Key, class ReadKey>
void read_path(TableReader& table, std::vector<Key>& keys, const Key& rest, ReadKey read_key) {
    std::size_t index = 0;
    for (const Value& value : table.tables("path")) {
        const Where place{.up = &table.where(), .name = "path", .index = index++};
        TableReader reader(table.reader(), value, place);
        Key key = rest;
        if (!reader.has("time"))
            reader.report().error(value.place, [&] { return fmt::format("{}: a key needs a time", place.text()); });
        reader.number("time", key.time);
        read_key(reader, key);
        reader.finish();
        keys.push_back(key);
    }
    order_keys(table, keys);
}

void read_transform(TableReader& table, EntityDraft& draft) {
    Entity& entity = draft.entity;
    read_placement(table, entity.transform);
    read_path(table, entity.path, TransformKey{.transform = entity.transform},
              [](TableReader& reader, TransformKey& key) { read_placement(reader, key.transform); });
}

void read_bounds(TableReader& table, EntityDraft& draft) {
    Box box{.low = vec3(0), .high = vec3(0)};
    for (const std::string_view key : {"min", "max"})
        if (!table.has(key))
            table.report().slip(table.place(), [&] {
                return fmt::format("{} is missing, a box needs min and max; [0, 0, 0] is used", table.name(key));
            });
    table.vector("min", box.low);
    table.vector("max", box.high);
    if (glm::any(glm::greaterThan(box.low, box.high))) {
        table.slip("min", "is above max, the two are swapped there");
        const vec3 low = glm::min(box.low, box.high);
        box.high = glm::max(box.low, box.high);
        box.low = low;
    }
    draft.entity.bounds = box;
}

void read_material(TableReader& table, EntityDraft& draft) {
    Material material;
    table.path("texture", material.texture);
    for (const std::string_view key : {"base_color", "color"}) {
        vec3 color(1);
        if (table.color(key, color, &material.alpha)) material.color = color;
    }
    table.number("metallic", material.metallic, fraction);
    table.number("roughness", material.roughness, fraction);
    table.number("opacity", material.opacity, fraction);
    table.choice("blend_mode", material.blend, blend_names);
    vec3 emissive(0);
    if (table.color("emissive", emissive)) material.emissive = emissive;
    table.number("emissive_strength", material.emissive_strength, light_values);
    table.number("alpha_cutoff", material.alpha_cutoff, fraction);
    table.choice("write_mask", material.writes, write_names);
    constexpr std::array<std::string_view, 4> channels{"base_color_r", "base_color_g", "base_color_b", "base_color_a"};
    for (std::size_t i = 0; i < channels.size(); ++i)
        table.number(channels[i], draft.base_color.channels[i], i == 3 ? fraction : light_values);
    draft.entity.material = std::move(material);
}

void read_model(TableReader& table, EntityDraft& draft) {
    ModelReference model;
    table.text("asset", model.asset);
    if (!table.has("asset"))
        table.report().error(table.place(), [&] { return fmt::format("{} is missing", table.name("asset")); });
    std::uint32_t clip = 0;
    if (table.is_number("animation")) {
        if (table.count("animation", clip, 0, 65535)) model.animation = fmt::format("{}", clip);
    } else {
        table.text("animation", model.animation);
    }
    table.flag("animated", model.is_animated);
    table.number("animation_speed", model.animation_speed, {.low = -1e3, .high = 1e3});
    table.text("variant", model.variant);
    table.number("light_scale", model.light_scale, {.low = 0, .high = 1e6});
    draft.entity.model = std::move(model);
}

void read_direction(TableReader& table, vec3& out) {
    const vec3 usual = out;
    table.vector("direction", out, scales);
    if (glm::length(out) >= 1e-6F) return;
    table.slip("direction",
               fmt::format("a direction needs a length above 0; [{}, {}, {}] is used", usual.x, usual.y, usual.z));
    out = usual;
}

void read_light(TableReader& table, EntityDraft& draft) {
    Light light;
    table.choice("type", light.type, light_names);
    table.color("color", light.color);
    table.number("intensity", light.intensity, light_values);
    read_direction(table, light.direction);
    table.number("radius", light.range, positive);
    table.number("range", light.range, positive);
    table.number("inner_angle", light.inner_angle, cone_radians);
    table.number("outer_angle", light.outer_angle, cone_radians);
    if (light.inner_angle > light.outer_angle) {
        table.slip("inner_angle", fmt::format("is above outer_angle; {} is used", light.outer_angle));
        light.inner_angle = light.outer_angle;
    }
    table.flag("casts_shadow", light.casts_shadow);
    table.number("volumetric_intensity", light.volumetric_intensity, light_values);
    vec3 color(1);
    if (table.color("volumetric_color", color)) light.volumetric_color = color;
    draft.entity.light = light;
}

void read_frames(TableReader& table, std::uint32_t& frames_x, std::uint32_t& frames_y) {
    table.count("frames_x", frames_x, 1, max_frames);
    table.count("frames_y", frames_y, 1, max_frames);
}

void read_sprite(TableReader& table, EntityDraft& draft) {
    Sprite sprite;
    table.path("texture", sprite.texture);
    table.number("width", sprite.width, positive);
    table.number("height", sprite.height, positive);
    read_frames(table, sprite.frames_x, sprite.frames_y);
    table.count("frame", sprite.frame, 0, max_frames * max_frames);
    if (sprite.frame >= sprite.frames_x * sprite.frames_y) {
        table.slip("frame", fmt::format("the texture has {} x {} frames; 0 is used", sprite.frames_x, sprite.frames_y));
        sprite.frame = 0;
    }
    table.number("anchor_y", sprite.anchor_y);
    table.number("intensity", sprite.intensity, light_values);
    table.flag("visible", sprite.is_visible);
    table.pass_over("fullbright");  // sprites are never lit
    draft.entity.sprite = std::move(sprite);
}

void order_pair(TableReader& table, std::string_view low_key, std::string_view high_key, float& low, float& high) {
    if (low <= high) return;
    table.slip(table.has(low_key) ? low_key : high_key,
               fmt::format("{} is above {}, the two are swapped", low_key, high_key));
    std::swap(low, high);
}

void read_emitter(TableReader& table, EntityDraft& draft) {
    ParticleEmitter emitter;
    table.number("emission_rate", emitter.emission_rate, {.low = 0, .high = 10000});
    table.count("burst_count", emitter.burst_count, 0, 10000);
    table.count("max_particles", emitter.max_particles, 0, 10000);
    table.number("lifetime_min", emitter.lifetime_min, {.low = 0, .high = 1e6, .unit = "s"});
    table.number("lifetime_max", emitter.lifetime_max, {.low = 0, .high = 1e6, .unit = "s"});
    order_pair(table, "lifetime_min", "lifetime_max", emitter.lifetime_min, emitter.lifetime_max);
    table.number("speed_min", emitter.speed_min, scales);
    table.number("speed_max", emitter.speed_max, scales);
    order_pair(table, "speed_min", "speed_max", emitter.speed_min, emitter.speed_max);
    read_direction(table, emitter.direction);
    table.number("spread", emitter.spread, half_angle_degrees);
    table.vector("gravity", emitter.gravity, scales);
    table.number("damping", emitter.damping, {.low = 0, .high = 1e4});
    table.number("size_start", emitter.size_start, {.low = 0, .high = 1e6});
    table.number("size_end", emitter.size_end, {.low = 0, .high = 1e6});
    table.color("color_start", emitter.color_start);
    table.color("color_end", emitter.color_end);
    table.path("texture", emitter.texture);
    read_frames(table, emitter.frames_x, emitter.frames_y);
    table.flag("animate_frames", emitter.animates_frames);
    table.choice("blend_mode", emitter.blend, particle_blend_names);
    table.choice("shape", emitter.shape, shape_names);
    table.number("shape_radius", emitter.shape_radius, {.low = 0, .high = 1e6});
    table.number("shape_angle", emitter.shape_angle, half_angle_degrees);
    table.vector("shape_extents", emitter.shape_extents, {.low = 0, .high = 1e6});
    table.flag("world_space", emitter.is_world_space);
    table.number("duration", emitter.duration, {.low = 0, .high = 1e6, .unit = "s"});
    table.flag("looping", emitter.is_looping);
    table.flag("playing", emitter.is_playing);
    table.flag("autoplay", emitter.autoplay);
    draft.entity.emitter = std::move(emitter);
}

constexpr std::array<ComponentReader, 7> components{{{"transform", read_transform},
                                                     {"bounds", read_bounds},
                                                     {"material", read_material},
                                                     {"model", read_model},
                                                     {"light", read_light},
                                                     {"sprite", read_sprite},
                                                     {"particle_emitter", read_emitter}}};

}  // namespace

std::span<const ComponentReader> all_components() { return components; }

const ComponentReader* find_component(std::string_view name) {
    const auto found = std::find_if(components.begin(), components.end(),
                                    [&](const ComponentReader& component) { return component.name == name; });
    return found == components.end() ? nullptr : &*found;
}

void read_camera(TableReader& table, Camera& camera) {
    constexpr std::array projection_names{std::pair{std::string_view("perspective"), Projection::Perspective},
                                          std::pair{std::string_view("orthographic"), Projection::Orthographic}};
    constexpr Interval views{.low = 0, .high = 180, .is_open = true, .unit = "degrees"};
    camera.is_given = true;
    table.choice("projection", camera.projection, projection_names);
    // Files of the engine that this format comes from write 0 where the view is a perspective.
    float height = 0;
    if (table.number("ortho_height", height, not_negative) && height > 0) camera.ortho_height = height;
    table.vector("position", camera.position);
    table.vector("target", camera.target);
    if (camera.position == camera.target) {
        table.slip("target", "is where the camera is; it looks along -z");
        camera.target = camera.position - vec3(0, 0, 1);
    }
    table.number("fov", camera.field_of_view, views);
    table.number("near", camera.near_distance, positive);
    table.number("far", camera.far_distance, positive);
    if (camera.far_distance <= camera.near_distance) {
        const Camera usual;
        table.slip("far", fmt::format("is not beyond near = {}; {} to {} is used", camera.near_distance,
                                      usual.near_distance, usual.far_distance));
        camera.near_distance = usual.near_distance;
        camera.far_distance = usual.far_distance;
    }
    // Those that `render` and depth of field take.
    table.number("aperture", camera.lens.aperture, {.low = 0.5, .high = 64});
    table.number("focus", camera.lens.focus, {.low = 0.01, .high = 1e5, .unit = "m"});
    table.number("sensor_height", camera.lens.sensor_height, {.low = 1, .high = 1000, .unit = "mm"});
    const CameraKey rest{.position = camera.position, .target = camera.target, .field_of_view = camera.field_of_view};
    read_path(table, camera.path, rest, [&](TableReader& reader, CameraKey& key) {
        reader.vector("position", key.position);
        reader.vector("target", key.target);
        reader.number("fov", key.field_of_view, views);
    });
}

void read_environment(TableReader& table, Environment& environment) {
    table.path("skybox", environment.skybox);
    table.number("skybox_intensity", environment.skybox_intensity, light_values);
    vec3 ambient(0);
    if (table.color("ambient_color", ambient)) environment.ambient_color = ambient;
    table.number("ambient_intensity", environment.ambient_intensity, light_values);
    table.color("background", environment.background);
    std::string fog;
    Place place;
    for (const Member& member : table.table().members) {
        if (!member.key.starts_with("fog_")) continue;
        if (fog.empty()) place = member.place;
        fog += fmt::format("{}{}", fog.empty() ? "" : ", ", member.key);
        table.pass_over(member.key);
    }
    if (!fog.empty())
        table.report().slip(
            place, [&] { return fmt::format("environment has {}: fog is set in [post_process]", printable(fog)); });
}

}  // namespace darkroom::scene::reading
