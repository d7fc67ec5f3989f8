// SPDX-License-Identifier: MIT
#include "render/upload/scene_on_device.hpp"

namespace darkroom::render {

Result<std::shared_ptr<SceneOnDevice>> SceneOnDevice::create(gpu::Context& context, const scene::Scene& scene,
                                                             const scene::Assets& assets) {
    const auto out = std::make_shared<SceneOnDevice>();
    DARKROOM_TRY_VALUE(out->frame_layout, create_frame_layout(context));
    out->first = scene::snapshot(scene, assets, {});
    DARKROOM_TRY_VALUE(out->meshes, GpuScene::create(context, assets, out->first.materials));
    DARKROOM_TRY_VALUE(out->environment, GpuEnvironment::create(context, assets.skybox));
    out->surroundings = scene.environment;
    out->has_alpha_layer = scene.has_alpha_layer;
    return out;
}

}  // namespace darkroom::render
