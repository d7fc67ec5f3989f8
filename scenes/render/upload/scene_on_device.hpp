// SPDX-License-Identifier: MIT
#pragma once
// What renderers of one scene share: its assets on the device, and what of the scene itself they are made by.

#include <memory>

#include "render/light/environment.hpp"
#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

struct SceneOnDevice {
    [[nodiscard]] static Result<std::shared_ptr<SceneOnDevice>> create(gpu::Context& context, const scene::Scene& scene,
                                                                       const scene::Assets& assets);

    gpu::SetLayout frame_layout;
    GpuScene meshes;
    GpuEnvironment environment;
    scene::Environment surroundings;
    bool has_alpha_layer = false;
    /// What the scene is like at its start says how many shadow maps and which pipelines it needs.
    scene::Snapshot first;
};

}  // namespace darkroom::render
