// SPDX-License-Identifier: MIT
#include "scene/walk/walk.hpp"

#include <array>
#include <cmath>

namespace darkroom::scene {

namespace {

constexpr vec3 down(0, -1, 0), up(0, 1, 0);
constexpr float longest_step = 1.0F / 60, longest_pause = 0.25F;
constexpr float agility = 12;         ///< 1/s, toward the speed that is wished for
constexpr float eye_agility = 15;     ///< 1/s, toward the feet after a step
constexpr float depth_of_world = 20;  ///< metres below the scene
constexpr float waist = 0.9F;

vec3 level(vec3 v) { return {v.x, 0, v.z}; }

/// What stops a movement: how much of it is free, and along which plane the rest may go.
struct Wall {
    float free = 0;
    vec3 normal{0};
};

std::optional<Wall> wall_ahead(const Ground& ground, vec3 feet, vec3 direction, float length) {
    constexpr std::array heights{Walk::step_height, 0.7F, waist, 1.3F, Walk::body_height - 0.1F};
    const vec3 side = glm::cross(direction, up), shoulder = 0.9F * Walk::body_radius * side;
    struct Probe {
        vec3 offset{0}, direction{0};
    };
    // Those to the sides find what is passed at a small angle.
    const std::array probes{Probe{vec3(0), direction}, Probe{shoulder, direction}, Probe{-shoulder, direction},
                            Probe{vec3(0), side}, Probe{vec3(0), -side}};
    std::optional<Wall> out;
    for (const float height : heights) {
        for (const Probe& probe : probes) {
            const std::optional<RayHit> hit =
                ground.cast(feet + height * up + probe.offset, probe.direction, length + 3 * Walk::body_radius);
            if (!hit) continue;
            const float steepness = glm::length(level(hit->normal));
            const vec3 normal = steepness > 0.1F ? level(hit->normal) / steepness : -direction;
            const float facing = -glm::dot(normal, direction);
            if (facing <= 0) continue;
            // The middle of the body keeps its distance, measured across the wall.
            const float apart = -glm::dot(normal, probe.offset + hit->distance * probe.direction);
            const float free = std::max((apart - Walk::body_radius) / facing, 0.0F);
            if (free < length && (!out || free < out->free)) out = Wall{free, normal};
        }
    }
    return out;
}

/// Goes as far as walls let it, and along them.
void move_level(Walk& walk, const Ground& ground, vec3 moved) {
    for (int walls = 0; walls < 3; ++walls) {
        const float length = glm::length(moved);
        if (length < 1e-6F) return;
        const vec3 direction = moved / length;
        const std::optional<Wall> wall = wall_ahead(ground, walk.feet, direction, length);
        if (!wall) {
            walk.feet += moved;
            return;
        }
        walk.feet += wall->free * direction;
        moved -= wall->free * direction;
        moved -= std::min(glm::dot(moved, wall->normal), 0.0F) * wall->normal;
        walk.velocity -= std::min(glm::dot(walk.velocity, wall->normal), 0.0F) * wall->normal;
    }
}

/// Height of what is below the feet or a step above them, no deeper than `reach` below. It looks from a little higher
/// than walls are looked for, so that nothing is in between.
std::optional<float> height_below(const Walk& walk, const Ground& ground, float reach) {
    constexpr float height = Walk::step_height + 0.01F;
    const vec3 from = walk.feet + height * up;
    const std::optional<RayHit> hit = ground.cast(from, down, height + reach);
    const float lowest = walk.feet.y - reach;
    if (!hit) return walk.floor >= lowest ? std::optional(walk.floor) : std::nullopt;
    return std::max(from.y - hit->distance, walk.floor);
}

void step_on_ground(Walk& walk, const Ground& ground) {
    const std::optional<float> height = height_below(walk, ground, Walk::step_height);
    if (!height) {
        walk.is_on_ground = false;
        return;
    }
    walk.eye_offset += walk.feet.y - *height;
    walk.feet.y = *height;
}

void step_in_air(Walk& walk, const Ground& ground, float seconds) {
    float rise = (walk.velocity.y - Walk::gravity * seconds / 2) * seconds;
    walk.velocity.y -= Walk::gravity * seconds;
    if (rise > 0) {
        const float room = Walk::body_height - waist;
        const std::optional<RayHit> ceiling = ground.cast(walk.feet + waist * up, up, room + rise);
        if (ceiling) {
            rise = std::max(ceiling->distance - room, 0.0F);
            walk.velocity.y = std::min(walk.velocity.y, 0.0F);
        }
    }
    const std::optional<float> height = height_below(walk, ground, std::max(-rise, 0.0F));
    walk.feet.y += rise;
    if (walk.velocity.y > 0 || !height || walk.feet.y > *height) return;
    walk.feet.y = *height;
    walk.velocity.y = 0;
    walk.is_on_ground = true;
}

void step(Walk& walk, const Ground& ground, const WalkInput& input, float seconds) {
    const float angle = glm::radians(input.yaw);
    const vec3 right(std::cos(angle), 0, -std::sin(angle)), forward(-std::sin(angle), 0, -std::cos(angle));
    const vec2 move = input.move / std::max(glm::length(input.move), 1.0F);
    const vec3 wish =
        (move.x * right + move.y * forward) * (input.is_running ? Walk::running_speed : Walk::walking_speed);
    // The velocity approaches the wish exponentially; the way is the integral of that.
    const float kept = std::exp(-agility * seconds);
    const vec3 excess = level(walk.velocity) - wish;
    const vec3 moved = wish * seconds + excess * ((1 - kept) / agility);
    const vec3 next = wish + excess * kept;
    walk.velocity = {next.x, walk.velocity.y, next.z};
    if (walk.is_on_ground && input.jumps) {
        walk.is_on_ground = false;
        walk.velocity.y = Walk::jump_speed;
    }
    move_level(walk, ground, moved);
    if (walk.is_on_ground)
        step_on_ground(walk, ground);
    else
        step_in_air(walk, ground, seconds);
    walk.eye_offset *= std::exp(-eye_agility * seconds);
    const float bottom = ground.bounds().is_empty() ? walk.start.y : ground.bounds().low.y;
    if (!(walk.feet.y > std::min(bottom, walk.start.y) - depth_of_world))
        walk = {.feet = walk.start, .start = walk.start, .floor = walk.floor};
}

}  // namespace

Walk stand(const Ground& ground, vec3 eye) {
    Walk walk;
    const bool is_empty = ground.bounds().is_empty();
    const float bottom = is_empty ? eye.y - Walk::eye_height : ground.bounds().low.y;
    const std::optional<RayHit> below = ground.cast(eye, down, std::max(eye.y - bottom, 0.0F) + 1e-3F);
    if (!below) walk.floor = std::min(bottom, eye.y - Walk::eye_height);
    walk.feet = {eye.x, below ? eye.y - below->distance : walk.floor, eye.z};
    walk.start = walk.feet;
    return walk;
}

void advance(Walk& walk, const Ground& ground, const WalkInput& input, float seconds) {
    if (!(seconds > 0)) return;
    const float all = std::min(seconds, longest_pause);
    const int steps = std::max(static_cast<int>(std::ceil(all / longest_step - 1e-3F)), 1);
    for (int i = 0; i < steps; ++i) step(walk, ground, input, all / static_cast<float>(steps));
}

}  // namespace darkroom::scene
