// SPDX-License-Identifier: MIT
#pragma once
// For tests only: scenes of boxes.

#include <vector>

#include "scene/walk/ground.hpp"

namespace darkroom::scene::test {

inline Entity box(vec3 low, vec3 high) { return {.name = "box", .archetype = "wall", .bounds = Box{low, high}}; }

inline Ground ground_of(std::vector<Entity> entities) {
    Scene scene;
    scene.entities = std::move(entities);
    Assets assets;
    assets.entities.resize(scene.entities.size());
    return {scene, assets};
}

inline const Entity floor = box({-50, -1, -50}, {50, 0, 50});

}  // namespace darkroom::scene::test
