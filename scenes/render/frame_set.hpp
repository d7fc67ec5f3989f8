// SPDX-License-Identifier: MIT
#pragma once
// What every pass of the scene is given: descriptor set 0 (shaders/frame.glsl), formats of the targets, and the blocks
// in it as C++ structs made from the very lines that the shaders include.

#include <vulkan/vulkan.h>

#include <array>
#include <vector>

#include "draw/pipeline.hpp"
#include "scene/math.hpp"

namespace darkroom::render {

namespace blocks {
using namespace glm;
struct Frame {
#include "render/shaders/frame_block.glsl"
};
struct Lights {
#include "render/shaders/light/light_block.glsl"
};
struct Shadows {
#include "render/shaders/light/shadow_block.glsl"
};
struct Instance {
#include "render/shaders/mesh/instance_block.glsl"
};
struct Material {
#include "render/shaders/mesh/material_block.glsl"
};
}  // namespace blocks

inline constexpr std::uint32_t max_directional_lights = 4, max_point_lights = 16, max_spot_lights = 8;
inline constexpr std::uint32_t max_cascades = 4;
/// Images of binding 8: the maps of directional lights, then the tiles of lamps.
inline constexpr std::uint32_t shadow_images = max_directional_lights + 1;
/// In ShadowBlock::world_to_map.
inline constexpr std::uint32_t first_tile = max_directional_lights * max_cascades;
inline constexpr std::uint32_t frame_bindings = 12;

/// Bindings 0 .. 11 of set 0, in order.
[[nodiscard]] Result<gpu::SetLayout> create_frame_layout(gpu::Context& context);

/// Where the picture goes: linear HDR for effects, or the finished display picture by the scene's own shaders.
enum class Output : std::uint32_t { Hdr, Display };
enum class DebugView : std::uint32_t { None, Wireframe, Normals, Depth, Uv, Unlit, MetalRough };

/// Where within the pixel a frame is drawn, and the one before: Camera::jitter and Camera::previous_jitter.
struct FrameJitter {
    std::array<float, 2> now{}, before{};
};

/// What draws leave of a colour target whose alpha is a layer of its own.
inline constexpr VkColorComponentFlags color_without_alpha =
    VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;

/// Normals: world space, -1..1, 0 where there is no surface. Velocity: previous minus current, pixels, y down.
struct TargetFormats {
    VkFormat color = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkFormat normals = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkFormat velocity = VK_FORMAT_R16G16_SFLOAT;
    VkFormat depth = VK_FORMAT_D32_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    bool has_layers = true;        ///< normals and velocity (shader outputs 1 and 2); false for Output::Display
    bool has_alpha_layer = false;  ///< ordinary draws leave the colour target's alpha alone

    enum class Layers : std::uint8_t { Written, Kept };
    /// The colour targets of a pipeline: colour with this blending, and the layers, which transparent draws keep.
    [[nodiscard]] std::vector<gpu::ColorTarget> colors(const gpu::ColorTarget& color_blend, Layers layers) const;
};

/// What a pass's pipelines are made for. They draw inside the renderer's own rendering instance, with viewport and
/// scissor set and set 0 to be bound by the pass with its layout.
struct PassSetup {
    VkDescriptorSetLayout frame_layout = VK_NULL_HANDLE;
    TargetFormats formats;
    Output output = Output::Hdr;
    bool is_tone_mapped = true;  ///< Output::Display
    std::uint32_t shadow_maps = 0;
    bool has_soft_shadows = false;
    bool has_lamp_shadows = false;
    bool has_environment = false;
};

}  // namespace darkroom::render
