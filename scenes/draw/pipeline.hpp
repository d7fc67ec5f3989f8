// SPDX-License-Identifier: MIT
#pragma once
// Graphics pipelines for geometry: vertices in, several targets out, by dynamic rendering. Full-screen work is not for
// these but for kernels (gpu/kernel/kernel.hpp). Viewport and scissor are dynamic, nothing else is.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/try.hpp"

namespace darkroom::gpu {

class Context;

/// A descriptor set layout with bindings 0, 1, ... in order.
class SetLayout {
  public:
    struct Binding {
        VkDescriptorType type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        VkShaderStageFlags stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
        std::uint32_t count = 1;
    };
    SetLayout() = default;
    [[nodiscard]] static Result<SetLayout> create(Context&, std::span<const Binding> bindings);
    SetLayout(SetLayout&&) noexcept;
    SetLayout& operator=(SetLayout&&) noexcept;
    ~SetLayout();
    VkDescriptorSetLayout handle = VK_NULL_HANDLE;
    Context* context = nullptr;
};

/// A target's blend state; the default replaces what is there.
struct ColorTarget {
    VkFormat format = VK_FORMAT_UNDEFINED;
    bool is_blended = false;
    VkBlendFactor source = VK_BLEND_FACTOR_ONE, destination = VK_BLEND_FACTOR_ZERO;
    VkBlendFactor source_alpha = VK_BLEND_FACTOR_ONE, destination_alpha = VK_BLEND_FACTOR_ZERO;
    VkColorComponentFlags writes =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
};

struct PipelineDesc {
    std::string name;
    std::string vertex;    ///< GLSL
    std::string fragment;  ///< GLSL; empty: depth alone
    std::vector<VkVertexInputBindingDescription> bindings;
    std::vector<VkVertexInputAttributeDescription> attributes;
    std::vector<VkDescriptorSetLayout> sets;
    std::uint32_t push_constant_size = 0;       ///< bytes, both stages
    std::vector<std::uint32_t> specialization;  ///< constant_id 0, 1, ... of both stages, as 32-bit words
    std::vector<ColorTarget> colors;
    VkFormat depth = VK_FORMAT_UNDEFINED;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPolygonMode polygon_mode = VK_POLYGON_MODE_FILL;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkFrontFace front = VK_FRONT_FACE_COUNTER_CLOCKWISE;  ///< as seen in the picture, y down
    bool tests_depth = true;
    bool writes_depth = true;
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;  ///< depth is reversed
    bool clamps_depth = false;                                   ///< needs Traits::has_depth_clamp
    float depth_bias = 0, depth_bias_slope = 0;                  ///< both 0: no bias
};

class Pipeline {
  public:
    Pipeline() = default;
    /// Errors: GLSL that does not compile (with its place), VkResult.
    [[nodiscard]] static Result<Pipeline> create(Context&, const PipelineDesc& desc);
    Pipeline(Pipeline&&) noexcept;
    Pipeline& operator=(Pipeline&&) noexcept;
    ~Pipeline();
    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    Context* context = nullptr;
};

}  // namespace darkroom::gpu
