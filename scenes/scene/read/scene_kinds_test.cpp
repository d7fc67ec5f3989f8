// SPDX-License-Identifier: MIT
// Every key of a scene with values of every wrong kind: one problem each, at the place of the value.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace darkroom::scene {
namespace {

// What a key takes, by the letters of the literals below; a table that lacks what it needs counts as taken.
constexpr std::string_view text = "t", number = "if", whole = "i", flag = "b", text_or_whole = "ti";
constexpr std::string_view none;

struct Literal {
    char kind;
    std::string_view text;
};
constexpr Literal literals[] = {{'t', "\"word\""},     {'i', "3"},          {'f', "1.5"},
                                {'b', "true"},         {'a', "[true]"},     {'o', "{ zz = 1 }"},
                                {'p', "[{ zz = 1 }]"}, {'d', "1979-05-27"}, {'e', "[]"}};

struct Key {
    std::string_view table, name, takes;
    std::string_view rest = {};  ///< what the table needs besides
};

constexpr Key keys[] = {
    {"", "scene", none},
    {"", "camera", none},
    {"", "environment", none},
    {"", "entities", none},
    {"", "prefabs", none},
    {"", "templates", "o"},
    {"", "archetypes", none},
    {"scene", "name", text},
    {"scene", "description", text},
    {"scene", "time", number},
    {"scene", "grid", flag},
    {"scene", "alpha_layer", flag},
    {"scene", "skins", none},
    {"camera", "projection", none},
    {"camera", "ortho_height", number},
    {"camera", "position", none},
    {"camera", "target", none},
    {"camera", "fov", number},
    {"camera", "near", number},
    {"camera", "far", number, "near = 0.5"},
    {"camera", "aperture", number},
    {"camera", "focus", number},
    {"camera", "sensor_height", number},
    {"camera", "path", "pe"},
    {"environment", "skybox", text},
    {"environment", "skybox_intensity", number},
    {"environment", "ambient_color", none},
    {"environment", "ambient_intensity", number},
    {"environment", "background", none},
    {"archetypes", "floor", "o"},
    {"templates", "t", "o", "[prefabs.p]\ntemplate = \"t\""},
    {"prefabs", "p", "o"},
    {"prefabs.p", "template", none},
    {"prefabs.p", "prefix", text, "template = \"t\"\n[templates.t.entities.a]"},
    {"prefabs.p", "overrides", none, "template = \"t\"\n[templates.t.entities.a]"},
    {"entities", "a", none},
    {"entities.a", "archetype", text},
    {"entities.a", "parent", none},
    {"entities.a", "transform", none},
    {"entities.a", "bounds", "o"},
    {"entities.a", "material", none},
    {"entities.a", "model", "o"},
    {"entities.a", "light", none},
    {"entities.a", "sprite", none},
    {"entities.a", "particle_emitter", none},
    {"entities.a.transform", "position", none},
    {"entities.a.transform", "rotation", none},
    {"entities.a.transform", "rotation_quat", none},
    {"entities.a.transform", "scale", none},
    {"entities.a.transform", "path", "pe"},
    {"entities.a.bounds", "min", none, "max = [-1, -1, -1]"},
    {"entities.a.bounds", "max", none, "min = [1, 1, 1]"},
    {"entities.a.material", "texture", text},
    {"entities.a.material", "base_color", none},
    {"entities.a.material", "color", none},
    {"entities.a.material", "metallic", number},
    {"entities.a.material", "roughness", number},
    {"entities.a.material", "opacity", number},
    {"entities.a.material", "blend_mode", none},
    {"entities.a.material", "emissive", none},
    {"entities.a.material", "emissive_strength", number},
    {"entities.a.material", "alpha_cutoff", number},
    {"entities.a.material", "write_mask", none},
    {"entities.a.material", "base_color_r", number},
    {"entities.a.material", "base_color_a", number},
    {"entities.a.model", "asset", text},
    {"entities.a.model", "animation", text_or_whole, "asset = \"a\""},
    {"entities.a.model", "animated", flag, "asset = \"a\""},
    {"entities.a.model", "animation_speed", number, "asset = \"a\""},
    {"entities.a.model", "variant", text, "asset = \"a\""},
    {"entities.a.model", "light_scale", number, "asset = \"a\""},
    {"entities.a.light", "type", none},
    {"entities.a.light", "color", none},
    {"entities.a.light", "intensity", number},
    {"entities.a.light", "direction", none},
    {"entities.a.light", "radius", number},
    {"entities.a.light", "range", number},
    {"entities.a.light", "inner_angle", number, "outer_angle = 0.01"},
    {"entities.a.light", "outer_angle", number, "inner_angle = 1.5"},
    {"entities.a.light", "casts_shadow", flag},
    {"entities.a.light", "volumetric_intensity", number},
    {"entities.a.light", "volumetric_color", none},
    {"entities.a.sprite", "texture", text},
    {"entities.a.sprite", "width", number},
    {"entities.a.sprite", "height", number},
    {"entities.a.sprite", "frames_x", whole, "frame = 3"},
    {"entities.a.sprite", "frames_y", whole, "frame = 3"},
    {"entities.a.sprite", "frame", whole},
    {"entities.a.sprite", "anchor_y", number},
    {"entities.a.sprite", "visible", flag},
    {"entities.a.particle_emitter", "emission_rate", number},
    {"entities.a.particle_emitter", "burst_count", whole},
    {"entities.a.particle_emitter", "max_particles", whole},
    {"entities.a.particle_emitter", "lifetime_min", number, "lifetime_max = 0"},
    {"entities.a.particle_emitter", "lifetime_max", number, "lifetime_min = 1000"},
    {"entities.a.particle_emitter", "speed_min", number, "speed_max = -1"},
    {"entities.a.particle_emitter", "speed_max", number, "speed_min = 1000"},
    {"entities.a.particle_emitter", "direction", none},
    {"entities.a.particle_emitter", "spread", number},
    {"entities.a.particle_emitter", "gravity", none},
    {"entities.a.particle_emitter", "damping", number},
    {"entities.a.particle_emitter", "size_start", number},
    {"entities.a.particle_emitter", "size_end", number},
    {"entities.a.particle_emitter", "color_start", none},
    {"entities.a.particle_emitter", "color_end", none},
    {"entities.a.particle_emitter", "texture", text},
    {"entities.a.particle_emitter", "frames_x", whole},
    {"entities.a.particle_emitter", "frames_y", whole},
    {"entities.a.particle_emitter", "animate_frames", flag},
    {"entities.a.particle_emitter", "blend_mode", none},
    {"entities.a.particle_emitter", "shape", none},
    {"entities.a.particle_emitter", "shape_radius", number},
    {"entities.a.particle_emitter", "shape_angle", number},
    {"entities.a.particle_emitter", "shape_extents", none},
    {"entities.a.particle_emitter", "world_space", flag},
    {"entities.a.particle_emitter", "duration", number},
    {"entities.a.particle_emitter", "looping", flag},
    {"entities.a.particle_emitter", "playing", flag},
    {"entities.a.particle_emitter", "autoplay", flag},
};

// Errors and warnings together, one a line.
std::vector<std::string> problems_of(const std::string& scene_text) {
    std::vector<std::string> out;
    const Result<Scene> scene = parse_scene(scene_text, "a.toml", {.warnings = &out});
    if (scene) return out;
    const std::string& errors = scene.error().text;
    for (std::size_t at = 0; at != std::string::npos;) {
        const std::size_t next = errors.find("; a.toml:", at);
        out.push_back(errors.substr(at, next == std::string::npos ? next : next - at));
        at = next == std::string::npos ? next : next + 2;
    }
    return out;
}

TEST(SceneKinds, AWrongKindIsOneProblemAtItsPlace) {
    std::size_t count = 0;
    for (const Key& key : keys)
        for (const Literal& literal : literals) {
            if (key.takes.find(literal.kind) != std::string_view::npos) continue;
            const std::string header = key.table.empty() ? "" : fmt::format("[{}]\n", key.table);
            const std::string line = fmt::format("{} = {}\n", key.name, literal.text);
            const std::string whole_text = header + line + std::string(key.rest) + "\n";
            const std::vector<std::string> problems = problems_of(whole_text);
            EXPECT_EQ(problems.size(), 1U) << whole_text << fmt::format("{}", fmt::join(problems, "\n"));
            ++count;
            if (problems.empty()) continue;
            EXPECT_TRUE(problems[0].starts_with(fmt::format("a.toml:{}:", key.table.empty() ? 1 : 2)))
                << whole_text << problems[0];
            EXPECT_NE(problems[0].find(key.name), std::string::npos) << whole_text << problems[0];
        }
    EXPECT_GT(count, 700U);
}

}  // namespace
}  // namespace darkroom::scene
