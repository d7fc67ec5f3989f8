// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <cmath>

#include "scene/pose/snapshot_parts.hpp"
#include "scene/walk/free_camera.hpp"

namespace darkroom::scene {

namespace {

/// A camera before matrices. `up` needs only not to be parallel to `forward`.
struct View {
    vec3 position{0}, forward{0, 0, -1}, up{0, 1, 0};
    vec3 target{0};  ///< what an orbit goes around
    Projection kind = Projection::Perspective;
    float field_of_view = 45, ortho_height = 10;
    float near_distance = 0.1F, far_distance = 1000;
};

constexpr float least_horizontal = 1e-6F;  // below it a direction is vertical

/// y up; straight down and up the top of the picture is -z and z, which is where an orbit of yaw 0 arrives.
vec3 up_for(vec3 forward) {
    if (glm::length(vec2(forward.x, forward.z)) > least_horizontal) return {0, 1, 0};
    return forward.y < 0 ? vec3(0, 0, -1) : vec3(0, 0, 1);
}

void look_at(View& view, vec3 position, vec3 target) {
    const vec3 way = target - position;
    const float distance = glm::length(way);
    view.position = position;
    view.target = target;
    view.forward = distance > 0 ? way / distance : vec3(0, 0, -1);
    view.up = up_for(view.forward);
}

void place_on_orbit(View& view, vec3 target, float distance, float yaw, float pitch) {
    const double yaw_angle = glm::radians(static_cast<double>(yaw));
    const double pitch_angle = glm::radians(static_cast<double>(pitch));
    const double level = std::cos(pitch_angle);
    const vec3 outward(static_cast<float>(level * std::sin(yaw_angle)), static_cast<float>(std::sin(pitch_angle)),
                       static_cast<float>(level * std::cos(yaw_angle)));
    view.position = target + distance * outward;
    view.target = target;
    view.forward = distance < 0 ? outward : -outward;
    view.up = vec3(0, 1, 0);
    if (std::abs(level) > static_cast<double>(least_horizontal)) return;
    const double side = view.forward.y < 0 ? -1 : 1;
    view.up = vec3(static_cast<float>(side * std::sin(yaw_angle)), 0, static_cast<float>(side * std::cos(yaw_angle)));
}

void apply_orbit(View& view, const OrbitOverride& orbit) {
    if (!orbit.distance && !orbit.yaw && !orbit.pitch && !orbit.target) return;
    const vec3 outward = -view.forward;
    const float distance = glm::length(view.position - view.target);
    const float pitch = glm::degrees(std::asin(glm::clamp(outward.y, -1.0F, 1.0F)));
    // Vertical views have no yaw of their own but that of the top of their picture.
    const bool is_vertical = glm::length(vec2(outward.x, outward.z)) <= least_horizontal;
    const vec3 heading = is_vertical ? -view.up * (outward.y < 0 ? -1.0F : 1.0F) : outward;
    const float yaw = glm::degrees(std::atan2(heading.x, heading.z));
    place_on_orbit(view, orbit.target.value_or(view.target), orbit.distance.value_or(distance), orbit.yaw.value_or(yaw),
                   orbit.pitch.value_or(pitch));
}

View scene_view(const Camera& camera, double time) {
    View view{.kind = camera.projection,
              .field_of_view = camera.field_of_view,
              .ortho_height = camera.ortho_height,
              .near_distance = camera.near_distance,
              .far_distance = camera.far_distance};
    const std::vector<CameraKey>& path = camera.path;
    if (path.empty()) {
        look_at(view, camera.position, camera.target);
        return view;
    }
    const auto later = std::upper_bound(path.begin(), path.end(), time,
                                        [](double value, const CameraKey& key) { return value < key.time; });
    const CameraKey& from = later == path.begin() ? path.front() : *(later - 1);
    const CameraKey& to = later == path.end() ? path.back() : *later;
    const auto fraction = to.time > from.time ? static_cast<float>((time - from.time) / (to.time - from.time)) : 0.0F;
    look_at(view, glm::mix(from.position, to.position, fraction), glm::mix(from.target, to.target, fraction));
    view.field_of_view = glm::mix(from.field_of_view, to.field_of_view, fraction);
    return view;
}

bool is_bare_model(const Scene& scene) { return !scene.camera.is_given && is_model_path(scene.file); }

/// The node of a bare model that holds its first camera.
struct CameraNode {
    std::uint32_t entity = no_index, node = no_index;
};

CameraNode model_camera(const Scene& scene, const Assets& assets) {
    if (!is_bare_model(scene)) return {};
    for (std::uint32_t entity = 0; entity < scene.entities.size(); ++entity) {
        const std::uint32_t number = assets_of(assets, entity).model;
        if (number == no_index) continue;
        const Model& model = assets.models[number];
        for (std::uint32_t node = 0; node < model.nodes.size(); ++node)
            if (model.nodes[node].camera < model.cameras.size()) return {entity, node};
    }
    return {};
}

/// `now`: the time of the picture, which `time` is before or is.
View view_of_node(const Scene& scene, const Assets& assets, const CameraNode& place, double time, double now,
                  const Box& bounds, PoseCache& poses) {
    const std::uint32_t number = assets_of(assets, place.entity).model;
    const Model& model = assets.models[number];
    const ModelCamera& camera = model.cameras[model.nodes[place.node].camera];
    const std::optional<ModelReference>& reference = scene.entities[place.entity].model;
    const double speed = reference ? static_cast<double>(reference->animation_speed) : 1;
    const std::uint32_t clip = clip_of(scene, place.entity, model, nullptr);
    const Pose& pose = poses.get(number, clip, motion_start(model, clip, now * speed, time * speed));
    const mat4 world = entity_world(scene, place.entity, time) * pose.nodes[place.node];
    View view{.position = vec3(world[3]),
              .forward = turned(world, vec3(0, 0, -1), vec3(0, 0, -1)),
              .up = turned(world, vec3(0, 1, 0), vec3(0, 1, 0)),
              .kind = camera.projection,
              .field_of_view = camera.field_of_view,
              .ortho_height = camera.ortho_height,
              .near_distance = camera.near_distance,
              .far_distance = camera.far_distance};
    const vec3 center = bounds.is_empty() ? vec3(0) : bounds.center();
    const float ahead = glm::dot(center - view.position, view.forward);
    view.target = view.position + view.forward * (ahead > 0 ? ahead : 1.0F);
    return view;
}

/// All of the bounding sphere is in view with a margin of 10 %. Without anything to see: the reference's view.
View fitted_view(const Scene& scene, const Box& bounds, float field_of_view, float aspect) {
    View view{.field_of_view = field_of_view,
              .near_distance = scene.camera.near_distance,
              .far_distance = scene.camera.far_distance};
    const bool is_bare = is_bare_model(scene);
    const float yaw = is_bare ? 30.0F : 45.0F, pitch = is_bare ? 15.0F : 30.0F;
    if (bounds.is_empty()) {
        place_on_orbit(view, vec3(0), 15, yaw, pitch);
        return view;
    }
    const float distance = fitting_distance(radius_of(bounds), field_of_view, aspect);
    place_on_orbit(view, bounds.center(), distance, yaw, pitch);
    return view;
}

/// The planes of a fitted view: those of the scene unless they would cut it; a bare model's hug it, so that depth reads
/// well.
void fit_planes(const Scene& scene, const Box& bounds, View& view) {
    if (bounds.is_empty()) return;
    const float radius = radius_of(bounds);
    const float distance = glm::length(view.position - bounds.center());
    const float least = radius * 0.001F;
    const float near_distance = std::max(least, (distance - radius) * 0.5F);
    const float far_distance = (distance + radius) * 2;
    const bool is_bare = is_bare_model(scene);
    view.near_distance = is_bare ? near_distance : std::min(view.near_distance, near_distance);
    view.far_distance = is_bare ? far_distance : std::max(view.far_distance, far_distance);
}

mat4 view_matrix(const View& view) {
    const vec3 forward = view.forward;
    const vec3 right = glm::normalize(glm::cross(forward, view.up));
    const vec3 up = glm::cross(right, forward);
    mat4 out(1);
    for (int axis = 0; axis < 3; ++axis) out[axis] = vec4(right[axis], up[axis], -forward[axis], 0);
    out[3] = vec4(-glm::dot(right, view.position), -glm::dot(up, view.position), glm::dot(forward, view.position), 1);
    return out;
}

mat4 projection_matrix(const View& view, float aspect) {
    if (view.kind == Projection::Orthographic)
        return orthographic(view.ortho_height, aspect, view.near_distance, view.far_distance);
    return perspective(view.field_of_view, aspect, view.near_distance, view.far_distance);
}

/// Numbers no projection exists for are replaced, and told.
void mend(const Scene& scene, View& view, std::vector<std::string>& warnings) {
    const auto warn = [&](const char* thing, float value, const char* allowed, float used) {
        warnings.push_back(
            fmt::format("{}: camera: {} {} must be {}; {} is used", scene.file.string(), thing, value, allowed, used));
    };
    if (!(view.field_of_view > 0 && view.field_of_view < 180)) {
        warn("fov", view.field_of_view, "above 0 and below 180", 45);
        view.field_of_view = 45;
    }
    const bool is_flat = view.kind == Projection::Orthographic;
    if (is_flat && !(view.ortho_height > 0)) {
        warn("ortho_height", view.ortho_height, "above 0", 10);
        view.ortho_height = 10;
    }
    if (is_flat ? !std::isfinite(view.near_distance) : !(view.near_distance > 0)) {
        warn("near", view.near_distance, "above 0", 0.1F);
        view.near_distance = 0.1F;
    }
    if (!(view.far_distance > view.near_distance) || (is_flat && std::isinf(view.far_distance))) {
        const float used = view.near_distance + 1000;
        warn("far", view.far_distance, "above near", used);
        view.far_distance = used;
    }
}

}  // namespace

mat4 perspective(float field_of_view, float aspect, float near_distance, float far_distance) {
    const double scale = 1 / std::tan(glm::radians(static_cast<double>(field_of_view)) * 0.5);
    const double n = static_cast<double>(near_distance), f = static_cast<double>(far_distance);
    const bool is_endless = std::isinf(far_distance);
    mat4 out(0);
    out[0][0] = static_cast<float>(scale / static_cast<double>(aspect));
    out[1][1] = static_cast<float>(-scale);
    out[2][2] = is_endless ? 0.0F : static_cast<float>(n / (f - n));
    out[2][3] = -1;
    out[3][2] = is_endless ? near_distance : static_cast<float>(n * f / (f - n));
    return out;
}

mat4 orthographic(float height, float aspect, float near_distance, float far_distance) {
    const float depth = far_distance - near_distance;
    mat4 out(1);
    out[0][0] = 2 / (height * aspect);
    out[1][1] = -2 / height;
    out[2][2] = 1 / depth;
    out[3][2] = far_distance / depth;
    return out;
}

void add_camera(const Scene& scene, const Assets& assets, const SnapshotOptions& options, const Box& fitted,
                PoseCache& poses, Snapshot& out) {
    const float aspect = options.aspect > 0 && std::isfinite(options.aspect) ? options.aspect : 1.0F;
    const CameraNode node = model_camera(scene, assets);
    const auto view_at = [&](double time, const OrbitOverride& orbit, std::vector<std::string>& warnings) {
        View view;
        if (scene.camera.is_given)
            view = scene_view(scene.camera, time);
        else if (node.entity != no_index)
            view = view_of_node(scene, assets, node, time, options.time, fitted, poses);
        const bool is_fitted = !scene.camera.is_given && node.entity == no_index;
        if (is_fitted) view.field_of_view = scene.camera.field_of_view;
        view.field_of_view = orbit.field_of_view.value_or(view.field_of_view);
        view.ortho_height = orbit.ortho_height.value_or(view.ortho_height);
        view.far_distance = std::max(view.far_distance, orbit.least_far_distance);
        mend(scene, view, warnings);
        if (is_fitted) view = fitted_view(scene, fitted, view.field_of_view, aspect);
        apply_orbit(view, orbit);
        if (is_fitted) fit_planes(scene, fitted, view);
        return view;
    };
    const View now = view_at(options.time, options.orbit, out.warnings);
    std::vector<std::string> unheard;
    const bool is_still = options.previous_time == options.time && !options.previous_orbit;
    const View before =
        is_still ? now : view_at(options.previous_time, options.previous_orbit.value_or(options.orbit), unheard);
    out.camera = {.view = view_matrix(now),
                  .previous_view = view_matrix(before),
                  .projection = projection_matrix(now, aspect),
                  .previous_projection = projection_matrix(before, aspect),
                  .position = now.position,
                  .target = now.target,
                  .kind = now.kind,
                  .field_of_view = now.field_of_view,
                  .ortho_height = now.ortho_height,
                  .near_distance = now.near_distance,
                  .far_distance = now.far_distance};
}

}  // namespace darkroom::scene
