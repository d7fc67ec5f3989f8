// SPDX-License-Identifier: MIT
#pragma once
// The images that a scene is drawn into and those that it is handed on in, and the barriers around them. With one
// sample colour, normals and velocity are the same ones; depth always becomes planar distance by
// render/pass/resolve.hpp.

#include <darkroom/frame.hpp>

#include "gpu/kernel/kernel.hpp"
#include "gpu/resource/resources.hpp"
#include "render/frame_set.hpp"

namespace darkroom::render {

struct TargetsDesc {
    VkExtent2D extent{};
    TargetFormats formats;  ///< without layers: a display picture
    bool has_transparency = false;
};

/// How a kernel of the renderer uses its images.
struct ResolveUse {
    VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;  ///< that reads
    VkPipelineStageFlags2 write_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkAccessFlags2 write_access = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    VkImageLayout write_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
};

[[nodiscard]] ResolveUse use_of(const gpu::Kernel& kernel);

class Targets {
  public:
    [[nodiscard]] static Result<Targets> create(gpu::Context& context, const TargetsDesc& desc);

    /// Final ones, in the order of the resolve's outputs.
    gpu::Image color, normals, velocity, planar_depth;
    gpu::Image depth;
    gpu::Image transparency;  ///< where it is wanted, and there is one sample
    /// Only with more than one sample.
    gpu::Image many_color, many_normals, many_velocity;

    [[nodiscard]] bool is_multi_sampled() const { return many_color.handle != VK_NULL_HANDLE; }
    [[nodiscard]] bool has_layers() const { return normals.handle != VK_NULL_HANDLE; }

    /// Begins the rendering instance, with everything cleared: colour to `background`, the rest to 0; sets viewport and
    /// scissor.
    void begin(VkCommandBuffer commands, const std::array<float, 4>& background, const ResolveUse& resolve) const;
    /// Between begin() and the end: copies the colour as it is into `transparency`, and goes on.
    void copy_before_transparency(VkCommandBuffer commands) const;
    /// Ends it, and brings every image to where the resolve wants it.
    void end_for_resolve(VkCommandBuffer commands, const ResolveUse& resolve) const;
    /// Ends it, and leaves the picture to be copied from.
    void end_for_copy(VkCommandBuffer commands) const;

    /// The images as end_for_resolve() and the resolve leave them.
    [[nodiscard]] ImageRef drawn(const gpu::Image& image, const ResolveUse& resolve) const;
    /// One that a kernel wrote behind the resolve.
    [[nodiscard]] ImageRef written(const gpu::Image& image, const ResolveUse& writer) const;
    [[nodiscard]] ImageRef copied_picture() const;
    /// As copy_before_transparency() leaves it; not given: there is none.
    [[nodiscard]] ImageRef copied_transparency() const;

  private:
    void begin_rendering(VkCommandBuffer commands, VkAttachmentLoadOp load,
                         const std::array<float, 4>& background) const;
    [[nodiscard]] ImageRef drawn(const gpu::Image& image, const ResolveUse& resolve, bool is_resolved) const;

    gpu::Context* context_ = nullptr;
    TargetsDesc desc_;
};

}  // namespace darkroom::render
