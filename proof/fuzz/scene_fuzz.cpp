// SPDX-License-Identifier: MIT
// Scenes: what is read holds together, and strictness turns warnings into
// errors.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fuzz/target.hpp"
#include "scene/scene.hpp"

namespace darkroom::fuzz::scene_fuzz {
namespace {

using namespace scene;

bool is_finite(vec3 value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

std::string wrong_entity(const Scene& scene, std::size_t number) {
    const Entity& entity = scene.entities[number];
    if (entity.parent != Entity::none && entity.parent >= scene.entities.size()) return "a parent is out of range";
    // To the top: a cycle is longer than there are entities.
    std::size_t steps = 0;
    for (std::uint32_t up = entity.parent; up != Entity::none; up = scene.entities[up].parent)
        if (++steps > scene.entities.size()) return "an entity is above itself";
    const auto is_ordered = [](const TransformKey& a, const TransformKey& b) { return a.time < b.time; };
    if (!std::ranges::is_sorted(entity.path, is_ordered)) return "keys of a path are out of order";
    if (entity.light && !(is_finite(entity.light->color) && is_finite(entity.light->direction) &&
                          std::isfinite(entity.light->intensity)))
        return "a light is not finite";
    return {};
}

std::string run(std::string_view input) {
    std::vector<std::string> warnings;
    const std::filesystem::path file = "/nowhere/a.scene.toml";
    const Result<Scene> scene = parse_scene(input, file, {.warnings = &warnings, .named_files = NamedFiles::Own});
    for (const std::string& warning : warnings)
        if (std::string wrong = wrong_line(warning); !wrong.empty()) return wrong;
    const Result<Scene> strict = parse_scene(input, file, {.is_strict = true, .named_files = NamedFiles::Own});
    if (strict.has_value() != (scene.has_value() && warnings.empty()))
        return fmt::format("{} when read strictly, with {} warnings else", strict ? "accepted" : strict.error().text,
                           warnings.size());
    if (!scene)
        return scene.error().text.starts_with(file.string() + ":") ? wrong_error(scene.error())
                                                                   : "an error names no place: " + scene.error().text;
    if (!is_finite(scene->camera.position) || !is_finite(scene->camera.target) || !std::isfinite(scene->time))
        return "the camera, or the time, is not finite";
    for (std::size_t i = 0; i < scene->entities.size(); ++i)
        if (std::string wrong = wrong_entity(*scene, i); !wrong.empty()) return wrong;
    return {};
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("scenes/*.scene.toml");
    std::ranges::move(files("data/hostile/*.toml"), std::back_inserter(out));
    out.emplace_back(
        "[scene]\nname = \"a\"\ntime = 2\nsamples = 4\ngrid = false\nalpha_layer "
        "= true\n[camera]\nposition = [0, 1, 5]\n"
        "target = [0, 0, 0]\nfov = 50\n[[camera.path]]\ntime = 0\nposition = [1, "
        "1, 1]\n[environment]\n"
        "background = [0, 0, 0]\n[entities.a.transform]\nposition = [0, 0, "
        "0]\nscale = 2\n[entities.a.bounds]\n"
        "min = [0, 0, 0]\nmax = [1, 1, 1]\n[entities.a.material]\ncolor = [1, 0, "
        "0, 0.5]\n[entities.b]\nparent = \"a\"\n"
        "[entities.b.light]\ntype = \"spot\"\nintensity = "
        "3\n[entities.c.particle_emitter]\nmax_particles = 4\n"
        "[entities.d.sprite]\ntexture = \"x.png\"\n[entities.e.model]\nasset = "
        "\"fox\"\n");
    out.emplace_back(
        "[templates.t.entities.x.bounds]\nmin = [0, 0, 0]\nmax = "
        "[1, 1, 1]\n[prefabs.p]\ntemplate = \"t\"\n"
        "position = [1, 0, "
        "0]\n[prefabs.p.overrides.x.material]\ncolor = [1, 1, 1]\n");
    return out;
}

const Registration scene({.name = "scene", .run = run, .seeds = seeds, .longest = 16384});

}  // namespace
}  // namespace darkroom::fuzz::scene_fuzz
