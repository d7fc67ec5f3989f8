// SPDX-License-Identifier: MIT
#include "render/upload/scene_on_device.hpp"

namespace darkroom::render {

Result<std::shared_ptr<SceneOnDevice>> SceneOnDevice::create(gpu::Context& context, const scene::Scene& scene,
                                                             const scene::Assets& assets) {
    const auto out = std::make_shared<SceneOnDevice>();
    Result<gpu::SetLayout> layout = create_frame_layout(context);
    if (!layout) return failure(std::move(layout));
    out->frame_layout = std::move(*layout);
    Result<GpuScene> meshes = GpuScene::create(context, assets);
    if (!meshes) return failure(std::move(meshes));
    out->meshes = std::move(*meshes);
    Result<GpuEnvironment> environment = GpuEnvironment::create(context, assets.skybox);
    if (!environment) return failure(std::move(environment));
    out->environment = std::move(*environment);
    out->surroundings = scene.environment;
    out->has_alpha_layer = scene.has_alpha_layer;
    out->first = scene::snapshot(scene, assets, {});
    return out;
}

}  // namespace darkroom::render
