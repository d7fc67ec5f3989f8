// SPDX-License-Identifier: MIT
#pragma once
// What scene-aware effects read beside the colour: a street of columns that ends in a wall, under a low sun, as a
// renderer would hand it over while the camera walks and looks about. It is traced on the CPU, once, and has nothing to
// do with the colours of the bed.

#include <darkroom/frame.hpp>
#include <vector>

#include "gpu/resource/resources.hpp"

namespace darkroom::bench {

/// What the camera sees of the street, row-major, top row first. Depth is reversed; distance is planar, 1e10 for sky.
struct StreetView {
    Camera camera;
    std::vector<float> depth, distance;
    std::vector<float> normals;   ///< x, y, z of the world; 0 for sky
    std::vector<float> velocity;  ///< x, y: previous minus current place, in pixels
};
[[nodiscard]] StreetView view_street(VkExtent2D extent);

struct World {
    [[nodiscard]] static Result<World> create(gpu::Context& context, VkExtent2D extent);

    gpu::Image depth;     ///< D32, reversed
    gpu::Image distance;  ///< R32F, planar
    gpu::Image normals;   ///< RGBA16F, of the world
    gpu::Image velocity;  ///< RG16F, in pixels
    gpu::Image ui;        ///< RGBA8, premultiplied: panes of an interface
    gpu::Image cascades;  ///< D32, four layers of 2048 x 2048
    Camera camera;        ///< of `depth`
    Light light;
};

/// What a frame tells of it.
enum class WorldUse : std::uint8_t {
    None,
    Full,            ///< device depth, normals, velocity, shadows
    WithoutNormals,  ///< device depth, shadows: what every engine has
    Interface,       ///< no more than a UI image
    Planar,          ///< planar distance, normals, velocity, shadows: the cheapest input
};

}  // namespace darkroom::bench
